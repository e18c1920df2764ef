// A turning certificate of which the coefficients are written down.
#pragma once

#include "kds/motion.hpp"
#include "kds/turning/turning_certificate.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace kds::tests {

/// The polynomials are about their own starts; what is not set is zero.
template <int Degree>
struct WrittenSum {
  static constexpr int degree = Degree;
  std::array<Spin, 2> spin{};
  std::array<std::array<Motion<Degree>, 3>, 3> p{};

  std::array<Spin, 2> spins() const { return spin; }

  template <class Number, int Order>
  TurningSum<Order, Number> turning_sum(double epoch) const {
    TurningSum<Order, Number> f;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        const auto whole = about<Number>(p[i][j], epoch);
        for (std::size_t k = 0; k <= Order; ++k) f.p[i][j].c[k] = whole.c[k];
      }
    }
    return f;
  }

  /// The value at t, rounded, by the functions of the C library.
  long double value(long double t) const {
    std::array<std::array<long double, 3>, 2> factors;
    for (std::size_t s = 0; s < 2; ++s) {
      const auto [x, y, z] = spin[s].velocity;
      const long double rate = std::sqrt(static_cast<long double>(x) * x + static_cast<long double>(y) * y +
                                         static_cast<long double>(z) * z);
      const long double angle = rate * (t - spin[s].start);
      factors[s] = {1, std::cos(angle), rate * std::sin(angle)};
    }
    long double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        long double part = 0;
        for (std::size_t k = Degree + 1; k-- > 0;) part = part * (t - p[i][j].start) + p[i][j].position.c[k];
        sum += part * factors[0][i] * factors[1][j];
      }
    }
    return sum;
  }
};

}  // namespace kds::tests
