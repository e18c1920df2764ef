// Where a polynomial first turns from + to -, isolated in plain doubles with proved error bounds.
#pragma once

#include "kds/ball.hpp"
#include "kds/polynomial.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace kds {

/// What is known of the first x in (0, end] where a polynomial turns from + to -.
struct Crossing {
  enum class Status {
    none,      ///< certified: the polynomial is >= 0 on (0, end]
    isolated,  ///< certified: > 0 on (0, after], and one sign change, from + to -, in (after, before)
    undecided  ///< the doubles do not tell
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
/// Cost: most polynomials of degree 4 are decided by one or two cuts of n (n + 1) / 2 steps each.
template <int Degree>
Crossing first_crossing(const Polynomial<Degree, Ball<double>>& p, double end);

// ---------------------------------------------------------------------------------------------------------------

namespace detail {

/// Binomial coefficients of Degree.
template <int Degree>
constexpr std::array<double, Degree + 1> binomials() {
  std::array<double, Degree + 1> result{};
  result[0] = 1;
  for (std::size_t i = 1; i <= Degree; ++i) {
    result[i] = result[i - 1] * static_cast<double>(Degree + 1 - i) / static_cast<double>(i);
  }
  return result;
}

/// A point of the projective line: y = w / v, with w + v = 1. Both are kept, for neither says enough of the other where
/// it is near 1; they are sums and products of positive numbers, so their relative errors stay small.
struct ProjectivePoint {
  double w;
  double v;
};

/// A polynomial over an interval, by its Bernstein coefficients, each known to +-error.
template <int Degree>
struct BernsteinPiece {
  std::array<double, Degree + 1> b;
  double error;
  ProjectivePoint begin;
  ProjectivePoint end;

  /// The sign pattern: how the coefficients, from the first on, turn.
  enum class Pattern { positive, falls_once, other };

  /// The first coefficient counts as positive where it may be zero, by `begins_positive`.
  Pattern pattern(bool begins_positive) const {
    std::size_t i = 0;
    if (begins_positive && !(b[0] > error)) i = 1;
    while (i <= Degree && b[i] > error) ++i;
    if (i > Degree) return Pattern::positive;
    // From here on: undecided ones, then negative ones to the end.
    if (i == 0) return Pattern::other;
    while (i <= Degree && !(b[i] < -error)) {
      if (b[i] > error) return Pattern::other;
      ++i;
    }
    if (i > Degree) return Pattern::other;
    while (i <= Degree && b[i] < -error) ++i;
    return i > Degree ? Pattern::falls_once : Pattern::other;
  }

  /// Middle of the first stretch where the control polygon is negative, as a fraction of the interval in 2^-10 ... 1 - 2^-10.
  double lowest() const {
    constexpr double n = Degree;
    std::size_t i = 1;
    while (i < Degree && b[i] > 0) ++i;
    const double falls = crossing(i);
    std::size_t j = i + 1;
    while (j <= Degree && b[j] <= 0) ++j;
    const double rises = j > Degree ? n : crossing(j);
    return std::clamp((falls + rises) / (2 * n), 0x1p-10, 1 - 0x1p-10);
  }

  /// Where the control polygon crosses zero between coefficients i - 1 and i, in units of 1 / n.
  double crossing(std::size_t i) const {
    const double step = b[i - 1] / (b[i - 1] - b[i]);
    return static_cast<double>(i - 1) + (step >= 0 && step <= 1 ? step : 0.5);
  }

  ProjectivePoint at(double fraction) const {
    return {(1 - fraction) * begin.w + fraction * end.w, (1 - fraction) * begin.v + fraction * end.v};
  }

  /// Cuts off the part before `fraction` and returns it; what is left is the part after.
  ///
  /// Each of the n stages of de Casteljau's rule is a convex combination, mu a + lambda b with mu + lambda = 1 exactly
  /// (the smaller one is 1 minus the larger one, which is a multiple of 2^-53): it passes on the errors without
  /// enlarging them and adds at most 2 u M, M being the largest coefficient. So the error grows by 2 n u M (1 + 2 n u),
  /// here 2.1 n u M, and not at all with the depth.
  BernsteinPiece cut(double fraction) {
    double lambda = fraction;
    double mu = 1 - fraction;
    if (lambda < mu) lambda = 1 - mu;
    double largest = 0;
    for (const double x : b) largest = std::max(largest, std::abs(x));
    error += 2.1 * Degree * 0x1p-53 * largest;
    BernsteinPiece left{b, error, begin, at(lambda)};
    for (std::size_t k = 1; k <= Degree; ++k) {
      for (std::size_t i = 0; i <= Degree - k; ++i) b[i] = mu * b[i] + lambda * b[i + 1];
      left.b[k] = b[0];
    }
    begin = left.end;
    return left;
  }
};

/// Exponent of a double: floor(log2 |x|) for normal numbers, less for others.
inline int exponent_of(double x) {
  return static_cast<int>((std::bit_cast<std::uint64_t>(x) >> 52) & 0x7ff) - 1023;
}
/// 2^e for -1022 <= e <= 1023.
inline double power_of_two(int e) { return std::bit_cast<double>(static_cast<std::uint64_t>(e + 1023) << 52); }

/// A power of two near the least x at which a negative term comes up to the constant one: the first root is at least
/// about half of that.
template <int Degree>
int scale_exponent(const Polynomial<Degree, Ball<double>>& p, double end) {
  int scale = end < 0x1p200 ? std::max(exponent_of(end) + 1, -200) : 200;
  const int constant = exponent_of(p.c[0].middle);
  for (std::size_t i = 1; i <= Degree; ++i) {
    if (p.c[i].middle < 0) {
      const int reach = static_cast<int>(std::floor((constant - exponent_of(p.c[i].middle)) / static_cast<double>(i)));
      scale = std::min(scale, reach);
    }
  }
  return std::max(scale, -200);
}

template <int Degree>
class CrossingSearch {
 public:
  using Piece = BernsteinPiece<Degree>;

  CrossingSearch(const Polynomial<Degree, Ball<double>>& p, double end) : end_(end) {
    const int exponent = scale_exponent(p, end);
    scale_ = power_of_two(exponent);
    static constexpr auto binomial = binomials<Degree>();
    double power = 1;
    double largest = 0;
    double radius = 0;
    for (std::size_t i = 0; i <= Degree; ++i) {
      // Multiplications by powers of two are exact but for underflow, which is charged below.
      all_.b[i] = p.c[i].middle * power / binomial[i];
      radius = std::max(radius, p.c[i].radius * power / binomial[i]);
      largest = std::max(largest, std::abs(all_.b[i]));
      power *= scale_;
    }
    all_.error = radius * Ball<double>::slack + 0x1p-53 * largest + 0x1p-1060;
    all_.begin = {0, 1};
    all_.end = {1, 0};
    finite_ = largest < 0x1p1000;
  }

  Crossing run() {
    if (!finite_) return {Crossing::Status::undecided};
    Piece rest = all_;
    if (end_ < std::numeric_limits<double>::infinity()) {
      const double y = end_ / scale_ * (1 + 0x1p-48);
      const double fraction = y / (1 + y) * (1 + 0x1p-48);
      if (fraction < 1 - 0x1p-40) rest = all_.cut(fraction);
    }
    return first_in(rest);
  }

 private:
  static constexpr int most_cuts = 12;
  static constexpr int most_pieces = 12;

  Crossing isolated(const Piece& piece) const {
    std::size_t i = 1;
    while (i < Degree && piece.b[i] > 0) ++i;
    const ProjectivePoint guess = piece.at(piece.crossing(i) / Degree);
    return {Crossing::Status::isolated, x(piece.begin), x(piece.end), x(guess)};
  }
  double x(const ProjectivePoint& point) const { return scale_ * (point.w / point.v); }

  /// Earlier pieces first. The pieces on the stack are later than `piece`, the top one first.
  Crossing first_in(Piece piece) {
    std::array<Piece, most_pieces> later;
    int count = 0;
    for (int cuts = 0;; ++cuts) {
      using Pattern = typename Piece::Pattern;
      Pattern pattern;
      while ((pattern = piece.pattern(piece.begin.w == 0)) == Pattern::positive) {
        if (count == 0) return {Crossing::Status::none};
        piece = later[static_cast<std::size_t>(--count)];
      }
      if (pattern == Pattern::falls_once) return isolated(piece);
      if (cuts == most_cuts || count == most_pieces) return {Crossing::Status::undecided};
      const Piece left = piece.cut(piece.lowest());
      later[static_cast<std::size_t>(count++)] = piece;
      piece = left;
    }
  }

  Piece all_;
  double end_;
  double scale_;
  bool finite_;
};

}  // namespace detail

template <int Degree>
Crossing first_crossing(const Polynomial<Degree, Ball<double>>& p, double end) {
  return detail::CrossingSearch<Degree>(p, end).run();
}

}  // namespace kds
