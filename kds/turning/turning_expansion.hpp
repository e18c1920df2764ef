// Taylor's series of sums of sines and cosines about a time, in doubles.
#pragma once

#include "kds/turning/taylor_model.hpp"
#include "kds/turning/turning_certificate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace kds::detail {

/// At least the rate of a spin, rad/s, whatever its size. Roundings: of a sum of squares of numbers up to 1, its root
/// and a product, less than 2^-50; the last step is for rates that are not normal numbers.
inline double rate_bound(const Spin& spin) {
  const auto [x, y, z] = spin.velocity;
  const double greatest = std::max({std::abs(x), std::abs(y), std::abs(z)});
  if (greatest == 0) return 0;
  const double a = x / greatest, b = y / greatest, c = z / greatest;
  return std::nextafter(greatest * std::sqrt(a * a + b * b + c * c) * (1 + 0x1p-48),
                        std::numeric_limits<double>::infinity());
}

/// f in doubles: its polynomials about an epoch, from which it is expanded about other times.
template <int Degree, int Harmonics = 1>
class TurningExpansion {
  static constexpr std::size_t size = 2 * Harmonics + 1;

 public:
  static constexpr int order = 10;
  using Model = TaylorModel<order>;

  /// f is multiplied by `side`, which is 1 or -1.
  template <class C>
  TurningExpansion(const C& certificate, int side, double epoch) : spins_(certificate.spins()), epoch_(epoch) {
    for (std::size_t s = 0; s < 2; ++s) {
      rates_[s] = spins_[s].still() ? Ball<DoubleDouble>() : spins_[s].rate();
      rate_bounds_[s] = rate_bound(spins_[s]);
    }
    const auto f = certificate.template turning_sum<Ball<double>, Degree>(epoch);
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = 0; j < size; ++j) {
        const double w = (is_sine(i) ? rates_[0].middle.high : 1.0) * (is_sine(j) ? rates_[1].middle.high : 1.0);
        const double bound = (is_sine(i) ? rate_bounds_[0] : 1.0) * (is_sine(j) ? rate_bounds_[1] : 1.0);
        for (std::size_t k = 0; k <= Degree; ++k) {
          const Ball<double>& c = f.p[i][j].c[k];
          p_[i][j][k] = side * c.middle * w;
          size_[k] += (std::abs(c.middle) + c.radius) * bound;
          radius_[k] += c.radius * bound + underflow;
        }
      }
    }
    // Of rates out of range nothing is said in doubles.
    for (const Ball<DoubleDouble>& rate : rates_) {
      if (!(rate.radius <= 0x1p-99 * rate.middle.high)) radius_[0] = std::numeric_limits<double>::infinity();
    }
  }

  /// About m, for times up to rho away. Precondition: the sum of the rates times rho and the harmonics is at most 1.
  ///
  /// The factors of p[i][j] are taken as cos and sin, the rates being multiplied to p. p is shifted to m, then turned:
  /// cos(a + w h) = cos a cos(w h) - sin a sin(w h), sin(a + w h) = sin a cos(w h) + cos a sin(w h), and so for
  /// multiples of a. What is left are products of polynomials with the series of cos(k w h) and sin(k w h).
  ///
  /// Error bound, with u = 2^-53. Written out, coefficient n is a sum of terms of which the magnitudes add up to that
  /// of S(|m - epoch| + rho x) exp(theta x) at most, S being made of the sums of the magnitudes of p's coefficients. A
  /// term has two rates (4 u), the shift (6 u), a cosine or sine of each spin (4 u, besides their own errors, which
  /// grow by 4 with the second harmonic, and 8 u for that), two series' coefficients, each with up to ten times an
  /// angle and a divisor (50 u each), a power of rho (4 u) and the sums of two convolutions (26 u; 44 u with two
  /// harmonics): less than 190 u, and 2^-45 = 256 u is charged.
  Model about(double m, double rho) const {
    static_assert(Harmonics <= 2);
    double unsure = roundings;
    using Turned = std::array<std::array<double, 2>, std::size_t{Harmonics}>;  // cosine and sine, by harmonics
    std::array<Turned, 2> turn;
    std::array<std::array<std::array<double, order + 1>, std::size_t{Harmonics}>, 2> series;
    for (std::size_t s = 0; s < 2; ++s) {
      SineCosine<Ball<double>> a{};
      a.cosine = Ball<double>(1.0);
      if (!spins_[s].still()) a = sine_cosine<Ball<double>>(spins_[s].angle(rates_[s], m));
      const double cosine = a.cosine.middle, sine = a.sine.middle;
      turn[s][0] = {cosine, sine};
      if constexpr (Harmonics == 2) turn[s][1] = {2 * cosine * cosine - 1, 2 * cosine * sine};
      unsure += error_growth * std::max(a.cosine.radius, a.sine.radius);
      // The coefficients of cos at even, of sin at odd places.
      for (std::size_t h = 0; h < Harmonics; ++h) {
        const double angle = static_cast<double>(h + 1) * rates_[s].middle.high * rho;
        double power = 1;
        for (std::size_t k = 0; k <= order; ++k) {
          series[s][h][k] = k % 4 < 2 ? power : -power;
          power *= angle * reciprocals[k + 1];
        }
      }
    }
    Parts q = shifted(m - epoch_, rho);
    const auto rotate = [](Coefficients& even, Coefficients& odd, const std::array<double, 2>& a) {
      for (std::size_t k = 0; k <= Degree; ++k) {
        const double x = even[k] * a[0] + odd[k] * a[1];
        odd[k] = odd[k] * a[0] - even[k] * a[1];
        even[k] = x;
      }
    };
    for (std::size_t h = 0; h < Harmonics; ++h) {
      for (std::size_t j = 0; j < size; ++j) rotate(q[2 * h + 1][j], q[2 * h + 2][j], turn[0][h]);
      for (std::size_t i = 0; i < size; ++i) rotate(q[i][2 * h + 1], q[i][2 * h + 2], turn[1][h]);
    }
    std::array<std::array<double, order + 1>, size> rows{};
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = 0; j <= Degree; ++j) {
        rows[i][j] += q[i][0][j];
        for (std::size_t h = 0; h < Harmonics; ++h) {
          for (std::size_t k = j; k <= order; ++k) {
            rows[i][k] += q[i][2 * h + 1 + (k - j) % 2][j] * series[1][h][k - j];
          }
        }
      }
    }
    Model model;
    for (std::size_t k = 0; k <= order; ++k) {
      double sum = rows[0][k];
      for (std::size_t h = 0; h < Harmonics; ++h) {
        for (std::size_t l = 0; l <= k; ++l) sum += series[0][h][l] * rows[2 * h + 1 + l % 2][k - l];
      }
      model.c[k] = sum;
    }
    bound(model, m, rho, unsure);
    return model;
  }

  /// Whether f is certainly positive at all times up to rho from m, however far it turns: p[0][0] exceeds what all the
  /// others can make. Of four coefficients of cos a cos b, cos a sin b ... no more is made than the root of the sum of
  /// their squares, of two of them likewise.
  bool outweighs(double m, double rho) const {
    const Parts q = shifted(m - epoch_, rho);
    const auto square = [&q](std::size_t i, std::size_t j) {
      double sum = 0;
      for (const double c : q[i][j]) sum += std::abs(c);
      return sum * sum;
    };
    double turning = 0;
    for (std::size_t i = 0; i < size; i += i == 0 ? 1 : 2) {
      for (std::size_t j = i == 0 ? 1 : 0; j < size; j += j == 0 ? 1 : 2) {
        double squares = square(i, j);
        if (i > 0) squares += square(i + 1, j);
        if (j > 0) squares += square(i, j + 1);
        if (i > 0 && j > 0) squares += square(i + 1, j + 1);
        turning += std::sqrt(squares);
      }
    }
    double still = 0;
    for (const double c : q[0][0]) still += std::abs(c);
    const double span = std::abs(m - epoch_) + rho;
    double unsure = 0;
    for (std::size_t k = Degree + 1; k-- > 0;) unsure = unsure * span + roundings * size_[k] + radius_[k];
    return 2 * q[0][0][0] - still - turning > unsure * Ball<double>::slack;
  }

 private:
  using Coefficients = std::array<double, std::size_t{Degree} + 1>;
  using Parts = std::array<std::array<Coefficients, size>, size>;

  static constexpr double roundings = 0x1p-45;
  /// Of the cosine and the sine of twice an angle that are made of those of the angle.
  static constexpr double error_growth = Harmonics == 1 ? 1 : 4;
  static constexpr double underflow = 0x1p-900;  ///< more than all products here lose by it
  static constexpr auto reciprocals = [] {
    std::array<double, order + 2> r{};
    for (std::size_t k = 1; k < r.size(); ++k) r[k] = 1 / static_cast<double>(k);
    return r;
  }();

  /// p(tau + rho x).
  static Coefficients shifted(const Coefficients& p, double tau, double rho) {
    Coefficients q = p;
    for (std::size_t first = 0; first < Degree; ++first) {
      for (std::size_t k = Degree; k-- > first;) q[k] += tau * q[k + 1];
    }
    double power = rho;
    for (std::size_t k = 1; k <= Degree; ++k) {
      q[k] *= power;
      power *= rho;
    }
    return q;
  }
  Parts shifted(double tau, double rho) const {
    Parts q;
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = 0; j < size; ++j) q[i][j] = shifted(p_[i][j], tau, rho);
    }
    return q;
  }

  void bound(Model& model, double m, double rho, double unsure) const {
    const double theta = Harmonics * (rate_bounds_[0] + rate_bounds_[1]) * rho * Ball<double>::slack;
    const double tau = std::abs(m - epoch_) * Ball<double>::slack;
    Coefficients sizes = shifted(size_, tau, rho);
    Coefficients radii = shifted(radius_, tau, rho);
    for (std::size_t k = 0; k <= Degree; ++k) {
      radii[k] += unsure * sizes[k] + underflow;
      sizes[k] += underflow;
    }
    double power = 1;  // theta^i / i!
    for (std::size_t i = 0; i <= order; ++i) {
      for (std::size_t j = 0; j <= Degree && i + j <= order; ++j) model.error[i + j] += radii[j] * power;
      power *= theta * reciprocals[i + 1];
    }
    model.next = theta > 0 ? derivative_bound(sizes, theta, order + 1) : 0;
  }

  std::array<Spin, 2> spins_;
  double epoch_;
  std::array<Ball<DoubleDouble>, 2> rates_;
  std::array<double, 2> rate_bounds_{};
  Parts p_{};              ///< about the epoch, times the rates of their sines
  Coefficients size_{};    ///< sums of the magnitudes of the coefficients, and of their radii
  Coefficients radius_{};  ///< sums of the radii
};

}  // namespace kds::detail
