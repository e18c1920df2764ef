// What a moving value covers in the time to come.
#pragma once

#include "kds/arithmetic/ball.hpp"
#include "kds/bounded.hpp"
#include "kds/motion.hpp"
#include "kds/roots/failure_time.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace kds::structures {

struct Span {
  double min;
  double max;
};

/// An interval whose inside holds the value from now until `ahead` seconds later; all there is where the numbers
/// overflow.
///
/// Written about now each term of the motion is monotone in time, so its ends will do. Roundings: n - 1 of a power, one
/// of the product, n of the sums, 2^-53 of a term each; 2^-48 of all terms covers degrees to 15, and leaves the ends
/// strictly outside; 2^-1000 is for underflow.
template <int Degree>
Span span_ahead(const Motion<Degree>& value, double now, double ahead) {
  static_assert(Degree <= 15);
  const auto f = about<Ball<double>>(value, now);
  Span span{f.c[0].middle - f.c[0].radius, f.c[0].middle + f.c[0].radius};
  double size = std::abs(f.c[0].middle) + f.c[0].radius;
  double power = 1;
  for (std::size_t i = 1; i <= Degree; ++i) {
    power *= ahead;
    const double low = (f.c[i].middle - f.c[i].radius) * power;
    const double high = (f.c[i].middle + f.c[i].radius) * power;
    span.min += std::min(low, 0.0);
    span.max += std::max(high, 0.0);
    size += std::max(std::abs(low), std::abs(high));
  }
  if (!(size < never)) return {-never, never};
  const double margin = 0x1p-48 * size + 0x1p-1000;
  return {span.min - margin, span.max + margin};
}

/// The same of a sampled value, whatever it does.
inline Span span_ahead(const Bounded& value, double now, double ahead) {
  const double reach = value.speed * ((now - value.start) + ahead);
  const double margin = 0x1p-48 * (std::abs(value.position) + reach) + 0x1p-1000;
  if (!(margin < never)) return {-never, never};
  return {value.position - reach - margin, value.position + reach + margin};
}

}  // namespace kds::structures
