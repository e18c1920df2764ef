// Random numbers for tests: the same from a seed on every compiler.
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

namespace kds::testing {

/// Numbers of the kinds that tests of geometry need. Two with one seed give the same.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  std::uint64_t bits() { return engine_(); }

  /// In 0 ... n - 1.
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(engine_() % n); }
  /// In low ... high.
  int integer(int low, int high) { return low + static_cast<int>(below(static_cast<std::size_t>(high - low + 1))); }
  bool one_in(std::size_t n) { return below(n) == 0; }

  /// In [0, 1).
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }

  /// 53 random bits of either sign, between 2^low and 2^(high + 1) in size.
  double scaled(int low, int high) {
    const int exponent = integer(low, high);  // first: compilers differ in the order of arguments
    const double size = std::ldexp(1 + unit(), exponent);
    return one_in(2) ? -size : size;
  }

  /// A few random bits: sums and products of such numbers are often exact and often coincide.
  double coarse() {
    const int mantissa = integer(-8, 8);
    return mantissa * std::ldexp(1.0, integer(-3, 1));
  }

  /// Any finite double, by its bits.
  double any() {
    for (;;) {
      const double x = std::bit_cast<double>(engine_());
      if (std::isfinite(x)) return x;
    }
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace kds::testing
