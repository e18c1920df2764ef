// What kinetic structures must agree with at any time, by brute force over exact numbers.
#pragma once

#include "tests/support/exact_algebra.hpp"

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace oracle {

/// c[0] + c[1] (t - start) + c[2] (t - start)^2 + ..., of any degree.
struct Value {
  std::vector<double> coefficients;
  double start = 0;
};

/// Sign of a - b just after t; 0 only if they are equal for ever.
int compare_after(const Value& a, const Value& b, double t);

/// Indices in rising order of value just after t; those equal for ever by index.
std::vector<std::size_t> order_after(std::span<const Value> values, double t);

/// Index of the greatest just after t; of those equal for ever the lowest. Precondition: not empty.
std::size_t greatest_after(std::span<const Value> values, double t);

/// The first t in [from, until] just after which a < b.
std::optional<Instant> first_below(const Value& a, const Value& b, double from,
                                   double until = std::numeric_limits<double>::infinity());

/// A box whose sides move; an end of each axis need not keep its distance from the other.
struct MovingBox {
  std::array<Value, 3> low, high;
};

/// Whether two boxes overlap just after t. Boxes that touch for ever do not.
bool overlap_after(const MovingBox& a, const MovingBox& b, double t);

/// When two boxes overlap, for begin <= t <= end.
std::vector<Stretch> overlaps(const MovingBox& a, const MovingBox& b, double begin,
                              double end = std::numeric_limits<double>::infinity());

}  // namespace oracle
