// Four doubles at a time.
#pragma once

#include <cstddef>
#include <cstdint>

namespace kds::certificates {

/// The compiler's own vectors, two of two: one SSE or NEON register each, or two numbers where there are none.
struct Lanes {
  using Pair = double __attribute__((vector_size(16)));
  using PairBits = std::int64_t __attribute__((vector_size(16)));

  Pair low, high;

  Lanes() = default;
  Lanes(Pair l, Pair h) : low(l), high(h) {}
  Lanes(double a, double b, double c, double d) : low{a, b}, high{c, d} {}
  explicit Lanes(double x) : low{x, x}, high{x, x} {}

  double operator[](std::size_t i) const { return i < 2 ? low[i] : high[i - 2]; }

  friend Lanes operator-(Lanes a) { return {-a.low, -a.high}; }
  friend Lanes operator+(Lanes a, Lanes b) { return {a.low + b.low, a.high + b.high}; }
  friend Lanes operator-(Lanes a, Lanes b) { return {a.low - b.low, a.high - b.high}; }
  friend Lanes operator*(Lanes a, Lanes b) { return {a.low * b.low, a.high * b.high}; }
  friend Lanes operator/(Lanes a, Lanes b) { return {a.low / b.low, a.high / b.high}; }
};

inline Lanes absolute(Lanes x) {
  const Lanes::PairBits mask{0x7fffffffffffffff, 0x7fffffffffffffff};
  return {reinterpret_cast<Lanes::Pair>(reinterpret_cast<Lanes::PairBits>(x.low) & mask),
          reinterpret_cast<Lanes::Pair>(reinterpret_cast<Lanes::PairBits>(x.high) & mask)};
}

/// Lane by lane; where one is not a number the second.
inline Lanes::Pair lesser(Lanes::Pair x, Lanes::Pair y) { return x < y ? x : y; }
inline Lanes::Pair greater(Lanes::Pair x, Lanes::Pair y) { return x > y ? x : y; }
inline Lanes lesser(Lanes x, Lanes y) { return {lesser(x.low, y.low), lesser(x.high, y.high)}; }
inline Lanes greater(Lanes x, Lanes y) { return {greater(x.low, y.low), greater(x.high, y.high)}; }

/// x where a > b, else y.
inline Lanes where_greater(Lanes a, Lanes b, Lanes x, Lanes y) {
  return {a.low > b.low ? x.low : y.low, a.high > b.high ? x.high : y.high};
}

/// Lanes 1, 2, 3, 0.
inline Lanes next(Lanes x) {
  return {__builtin_shufflevector(x.low, x.high, 1, 2), __builtin_shufflevector(x.high, x.low, 1, 2)};
}

inline double sum_of(Lanes x) {
  const Lanes::Pair sums = x.low + x.high;
  return sums[0] + sums[1];
}
inline double lowest(Lanes x) {
  const Lanes::Pair m = lesser(x.low, x.high);
  return m[0] < m[1] ? m[0] : m[1];
}
inline double highest(Lanes x) {
  const Lanes::Pair m = greater(x.low, x.high);
  return m[0] > m[1] ? m[0] : m[1];
}

}  // namespace kds::certificates
