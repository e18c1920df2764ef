// A turning certificate of which the coefficients are written down.
#pragma once

#include "kds/motion.hpp"
#include "kds/turning/turning_certificate.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace kds::tests {

/// The polynomials are about their own starts; what is not set is zero.
template <int Degree, int Harmonics = 1>
struct WrittenSum {
  static constexpr int degree = Degree;
  static constexpr int harmonics = Harmonics;
  static constexpr std::size_t size = 2 * Harmonics + 1;
  std::array<Spin, 2> spin{};
  std::array<std::array<Motion<Degree>, size>, size> p{};

  std::array<Spin, 2> spins() const { return spin; }

  template <class Number, int Order>
  TurningSum<Order, Number, Harmonics> turning_sum(double epoch) const {
    TurningSum<Order, Number, Harmonics> f;
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = 0; j < size; ++j) {
        const auto whole = about<Number>(p[i][j], epoch);
        for (std::size_t k = 0; k <= Order; ++k) f.p[i][j].c[k] = whole.c[k];
      }
    }
    return f;
  }

  /// The value at t, rounded, by the functions of the C library or of another number type.
  template <class Real>
  Real value(const Real& t) const {
    using std::cos, std::sin, std::sqrt;
    std::array<std::array<Real, size>, 2> factors;
    for (std::size_t s = 0; s < 2; ++s) {
      Real square = 0;
      for (const double v : spin[s].velocity) square += Real(v) * Real(v);
      const Real rate = sqrt(square);
      const Real angle = rate * (t - Real(spin[s].start));
      factors[s][0] = Real(1);
      for (int k = 1; k <= Harmonics; ++k) {
        factors[s][static_cast<std::size_t>(2 * k - 1)] = Real(cos(k * angle));
        factors[s][static_cast<std::size_t>(2 * k)] = Real(rate * sin(k * angle));
      }
    }
    Real sum = 0;
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = 0; j < size; ++j) {
        Real part = 0;
        for (std::size_t k = Degree + 1; k-- > 0;) {
          part = part * (t - Real(p[i][j].start)) + Real(p[i][j].position.c[k]);
        }
        sum += part * factors[0][i] * factors[1][j];
      }
    }
    return sum;
  }
};

}  // namespace kds::tests
