// Where a polynomial first turns from + to -, isolated in plain doubles with proved error bounds.
#pragma once

#include "kds/arithmetic/ball.hpp"
#include "kds/arithmetic/power_of_two.hpp"
#include "kds/arithmetic/unrolled.hpp"
#include "kds/polynomial.hpp"
#include "kds/simd/two_doubles.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace kds {

/// The result of a search for the first x in (0, end] where a polynomial turns from + to -.
struct Crossing {
  /// What has been found.
  enum class Status {
    none,      ///< certified: the polynomial is >= 0 on (0, end]
    isolated,  ///< certified: > 0 on (0, after], and one sign change, from + to -, in (after, before)
    undecided  ///< certified: >= 0 on (0, after]; beyond that doubles do not decide
  };
  Status status;
  double after = 0;   ///< rounded: the ends meant are within 2^-44 of their size
  double before = 0;  ///< infinite if there is no end
  double guess = 0;   ///< of the root, between the two
};

/// Finds the first crossing of p in (0, end], `end` possibly infinite, for every polynomial within the balls at once.
/// Precondition: those polynomials that are meant are >= 0 just after 0.
///
/// Method: the rule of Descartes on intervals [Collins76], in Bernstein form, on the projective line: with x = scale y
/// and y = w / (1 - w), the numbers c_i scale^i / binomial(n, i) are the Bernstein coefficients of (1 - w)^n p over
/// 0 <= w <= 1, that is over all x >= 0, without a transformation. No sign change among them: no root. One: one root.
/// More: the interval is cut by de Casteljau's rule where the control polygon is lowest below zero, or would be.
///
/// Cost: most polynomials of degree 4 are decided by one or two cuts of n (n + 1) / 2 steps each. Degrees above 31 do
/// not compile.
template <int Degree>
Crossing first_crossing(const Polynomial<Degree, Ball<double>>& p, double end);

// ---------------------------------------------------------------------------------------------------------------

namespace detail {

/// 1 / binomial(Degree, i), rounded.
template <int Degree>
constexpr std::array<double, std::size_t{Degree} + 1> inverse_binomials() {
  std::array<double, std::size_t{Degree} + 1> result{};
  double binomial = 1;
  for (std::size_t i = 0; i <= Degree; ++i) {
    result[i] = 1 / binomial;
    binomial = binomial * static_cast<double>(Degree - i) / static_cast<double>(i + 1);
  }
  return result;
}

/// A point of the projective line: y = w / v, with w + v = 1. Both are stored, since the smaller cannot be computed
/// accurately from one that is near 1; they are sums and products of positive numbers, so their relative errors stay
/// small.
struct ProjectivePoint {
  double w;
  double v;
};

enum class Pattern { positive, falls_once, other };

/// The signs of a row of coefficients as bits: branches on signs of random polynomials would be mispredicted.
struct SignMasks {
  unsigned positive = 0;
  unsigned negative = 0;

  void set(std::size_t i, double value, double error) {
    positive |= static_cast<unsigned>(value > error) << i;
    negative |= static_cast<unsigned>(value < -error) << i;
  }

  /// Numbers 0 ... last: all positive; or positive ones, then at most one that is unsure, then negative ones to the
  /// end. Two undecided ones could be negative and positive, and make three changes of sign.
  Pattern pattern(int last) const {
    const unsigned all = (2u << last) - 1;
    if (positive == all) return Pattern::positive;
    const unsigned not_negative = all & ~negative;
    const unsigned unsure = not_negative & ~positive;
    const bool falls_once = (positive & 1u) != 0 && (positive & (positive + 1)) == 0 &&
                            (not_negative & (not_negative + 1)) == 0 && not_negative != all &&
                            (unsure & (unsure - 1)) == 0;
    return falls_once ? Pattern::falls_once : Pattern::other;
  }
};

/// A polynomial over an interval, by its Bernstein coefficients, each known to +-error.
template <int Degree>
struct BernsteinPiece {
  static_assert(Degree <= 31, "failure times are found for certificates of degree 31 at most");

  std::array<double, std::size_t{Degree} + 1> b;
  double error;
  ProjectivePoint begin;
  ProjectivePoint end;

  /// What follows from the signs of the coefficients, in order.
  Pattern pattern() const {
    SignMasks signs;
    unrolled<Degree + 1>([&](auto i) { signs.set(i, b[i], error); });
    // The first one is the value at the beginning: at now, where it may be zero, the function is known not to fall.
    if (begin.w == 0) signs.positive |= 1;
    return signs.pattern(Degree);
  }

  /// Where the control polygon first falls through zero: between this coefficient and the one before.
  std::size_t fall() const {
    return std::min(static_cast<std::size_t>(std::countr_one(positive() | 1u)), std::size_t{Degree});
  }

  /// Whether nothing is left but errors.
  bool drowned() const {
    double largest = 0;
    unrolled<Degree + 1>([&](auto i) { largest = std::max(largest, std::abs(b[i])); });
    return largest <= 4 * error;
  }

  /// Middle of the first stretch where the control polygon is negative, as a fraction of the interval.
  double dip() const {
    const std::size_t i = fall();
    const unsigned later = positive() >> i;
    const double rises = later == 0 ? Degree : crossing(i + static_cast<std::size_t>(std::countr_zero(later)));
    return (crossing(i) + rises) * (0.5 / Degree);
  }

  /// A guess of the root where the polygon falls.
  ProjectivePoint fall_point() const {
    // As in crossing(), with one division less: the numbers w and v may be multiplied by anything.
    const std::size_t i = fall();
    const double step = std::max(b[i - 1], 0.0) + error;
    const double whole = step + std::max(-b[i], 0.0) + error;
    const double along = static_cast<double>(static_cast<int>(i) - 1) * whole + step;
    const double rest = static_cast<double>(static_cast<int>(Degree - i)) * whole + (whole - step);
    return {rest * begin.w + along * end.w, rest * begin.v + along * end.v};
  }

  /// Cuts off the part before `fraction`, which becomes `left`; what is left is the part after.
  ///
  /// Each of the n stages of de Casteljau's rule is a convex combination, mu a + lambda b with mu + lambda = 1 exactly
  /// (the smaller one is 1 minus the larger one, which is a multiple of 2^-53): it passes on the errors without
  /// enlarging them and adds at most 2 u M, M being the largest coefficient. So the error grows by 2 n u M (1 + 2 n u),
  /// here 2.1 n u M, and not at all with the depth.
  void cut(double fraction, BernsteinPiece& left) {
    double lambda = fraction;
    double mu = 1 - fraction;
    if (lambda < mu) lambda = 1 - mu;
    double largest = 0;
    unrolled<Degree + 1>([&](auto i) { largest = std::max(largest, std::abs(b[i])); });
    error += 2.1 * Degree * 0x1p-53 * largest;
    // Two numbers at a time. What a stage computes of the number behind its last one is not used.
    constexpr std::size_t pairs = Degree / 2 + 1;
    std::array<Two, pairs> row;
    unrolled<pairs>([&](auto j) {
      constexpr std::size_t second = 2 * j + 1;
      row[j] = Two{b[2 * j], second <= Degree ? b[std::min<std::size_t>(second, Degree)] : 0};
    });
    const Two near = both(mu);
    const Two far = both(lambda);
    unrolled<Degree>([&](auto k) {
      constexpr std::size_t last = Degree - k;
      left.b[k] = row[0][0];
      b[last] = row[last / 2][last % 2];
      unrolled<(last + 1) / 2>([&](auto j) {
        constexpr std::size_t next = j + 1 < pairs ? j + 1 : j;
        row[j] = near * row[j] + far * __builtin_shufflevector(row[j], row[next], 1, 2);
      });
    });
    left.b[Degree] = b[0] = row[0][0];
    left.error = error;
    left.begin = begin;
    left.end = begin = {mu * begin.w + lambda * end.w, mu * begin.v + lambda * end.v};
  }

 private:
  unsigned positive() const {
    unsigned bits = 0;
    unrolled<Degree + 1>([&](auto i) { bits |= static_cast<unsigned>(b[i] > 0) << i; });
    return bits;
  }

  /// Where the control polygon crosses zero between coefficients i - 1 and i, in units of 1 / Degree.
  double crossing(std::size_t i) const {
    const double step = b[i - 1] / (b[i - 1] - b[i]);
    return static_cast<double>(static_cast<int>(i) - 1) + (step >= 0 && step <= 1 ? step : 0.5);
  }
};

/// Exponent of a double: floor(log2 |x|) for normal numbers, less for others.
inline int exponent_of(double x) { return static_cast<int>((std::bit_cast<std::uint64_t>(x) >> 52) & 0x7ff) - 1023; }

/// A power of two near the least x at which a negative term comes up to the constant one, or near the end if that is
/// earlier. A guess of the scale on which the polynomial changes; correctness does not depend on it. Where the constant
/// term may be zero (two things that have just met) it says nothing about later times, and the linear term takes its
/// place.
template <int Degree>
int scale_exponent(const Polynomial<Degree, Ball<double>>& p, double end) {
  constexpr int most = Degree <= 10 ? 100 : 960 / Degree;  // so that no power up to the last overflows, or underflows
  constexpr double farthest = power_of_two(most);
  int scale = end < farthest ? exponent_of(end) + 1 : most;
  const int met = Degree > 1 && std::abs(p.c[0].middle) <= p.c[0].radius ? 1 : 0;
  const int constant = exponent_of(p.c[static_cast<std::size_t>(met)].middle);
  unrolled<Degree>([&](auto below) {
    constexpr int i = static_cast<int>(below) + 1;
    const int share = met == 1 ? 65536 / std::max(i - 1, 1) : 65536 / i;
    const int ratio = ((constant - exponent_of(p.c[i].middle)) * share) >> 16;
    scale = std::min(scale, p.c[i].middle < 0 && i > met ? ratio : most);
  });
  return scale == most ? 0 : std::max(scale, -most);
}

template <int Degree>
class CrossingSearch {
 public:
  CrossingSearch(const Polynomial<Degree, Ball<double>>& p, double end) {
    scale_ = power_of_two(scale_exponent(p, end));
    constexpr auto factor = inverse_binomials<Degree>();
    auto& b = pieces_[0].b;
    double power = 1;
    double largest = 0;
    double radius = 0;
    double sum = 0;  // not a number if anything is not
    unrolled<Degree + 1>([&](auto i) {
      // Multiplications by powers of two are exact except for underflow, which is charged below.
      const double weight = std::get<i>(factor) * power;
      b[i] = p.c[i].middle * weight;
      const double r = p.c[i].radius * weight;
      radius = std::max(radius, r);
      largest = std::max(largest, std::abs(b[i]));
      sum += std::abs(b[i]) + r;
      power *= scale_;
    });
    // Two roundings, of the factor and of the product; cuts and this may lose 2^-1074 by underflow a hundred times.
    pieces_[0].error = radius * Ball<double>::slack + 0x1p-52 * largest + 0x1p-1060;
    pieces_[0].begin = {0, 1};
    pieces_[0].end = {1, 0};
    finite_ = sum < 0x1p1000;
    if (end < std::numeric_limits<double>::infinity()) {
      const double y = end / scale_ * (1 + 0x1p-48);
      const double fraction = y / (1 + y) * (1 + 0x1p-48) + 0x1p-52;  // 2^-52 pays for its rounding in cut()
      if (fraction < 1 - 0x1p-40) {
        pieces_[0].cut(fraction, pieces_[1]);
        first_ = last_ = 1;
      }
    }
  }

  /// The pieces between first_ and last_ are those not yet decided, later ones first.
  Crossing run() {
    if (!finite_) return {Crossing::Status::undecided};
    for (int cuts = 0;;) {
      BernsteinPiece<Degree>& piece = pieces_[last_];
      const Pattern pattern = piece.pattern();
      if (pattern == Pattern::falls_once) {
        return {Crossing::Status::isolated, x(piece.begin), x(piece.end), x(piece.fall_point())};
      }
      if (pattern == Pattern::positive) {
        if (last_ == first_) return {Crossing::Status::none};
        --last_;
        continue;
      }
      if (++cuts > most_cuts || piece.drowned()) return {Crossing::Status::undecided, x(piece.begin)};
      piece.cut(std::clamp(piece.dip(), nearest_cut, 1 - nearest_cut), pieces_[++last_]);
    }
  }

 private:
  static constexpr int most_cuts = 24;
  static constexpr double nearest_cut = 0x1p-10;  // to an end of the interval, as a fraction of it

  double x(const ProjectivePoint& point) const { return scale_ * (point.w / point.v); }

  std::array<BernsteinPiece<Degree>, most_cuts + 2> pieces_;
  std::size_t first_ = 0;
  std::size_t last_ = 0;
  double scale_;
  bool finite_;
};

}  // namespace detail

template <int Degree>
Crossing first_crossing(const Polynomial<Degree, Ball<double>>& p, double end) {
  return detail::CrossingSearch<Degree>(p, end).run();
}

}  // namespace kds
