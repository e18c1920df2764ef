// The interval that a moving value covers in the time ahead.
#pragma once

#include "kds/arithmetic/ball.hpp"
#include "kds/motion.hpp"
#include "kds/roots/failure_time.hpp"
#include "kds/uncertain.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace kds::structures {

/// A closed interval, in units of length.
struct Span {
  double min;
  double max;
};

namespace detail {

/// Adds the terms of a polynomial in the time from now on, over [0, ahead]: each is monotone, so its values at the ends
/// suffice.
template <int Degree>
void add_terms(const Polynomial<Degree, Ball<double>>& f, double ahead, Span& span, double& size) {
  span.min += f.c[0].middle - f.c[0].radius;
  span.max += f.c[0].middle + f.c[0].radius;
  size += std::abs(f.c[0].middle) + f.c[0].radius;
  double power = 1;
  for (std::size_t i = 1; i <= Degree; ++i) {
    power *= ahead;
    const double low = (f.c[i].middle - f.c[i].radius) * power;
    const double high = (f.c[i].middle + f.c[i].radius) * power;
    span.min += std::min(low, 0.0);
    span.max += std::max(high, 0.0);
    size += std::max(std::abs(low), std::abs(high));
  }
}

}  // namespace detail

/// An interval whose inside contains the value from now until `ahead` seconds later, and a sampled value however it
/// moves; [-infinity, infinity] where the numbers overflow. Precondition: now is finite, ahead >= 0.
///
/// Roundings: n - 1 of a power, one of the product, n + 2 of the sums, 2^-53 of a term each; 2^-48 of all terms covers
/// degrees to 12, and leaves the ends strictly outside; 2^-1000 is for underflow.
template <class Value>
Span span_ahead(const Value& value, double now, double ahead) {
  static_assert(Value::degree <= 12);
  const auto f = about<Ball<double>>(value, now);
  Span span{0, 0};
  double size = 0;
  if constexpr (requires { f.middle; }) {
    detail::add_terms(f.middle, ahead, span, size);
    Span radius{0, 0};
    detail::add_terms(f.radius, ahead, radius, size);
    span = {span.min - radius.max, span.max + radius.max};
  } else {
    detail::add_terms(f, ahead, span, size);
  }
  if (!(size < never)) return {-never, never};
  const double margin = 0x1p-48 * size + 0x1p-1000;
  return {span.min - margin, span.max + margin};
}

}  // namespace kds::structures
