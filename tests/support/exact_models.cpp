#include "tests/support/exact_models.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

namespace oracle {
namespace {

Polynomial polynomial(const Value& value) { return Polynomial::motion(value.coefficients, value.start); }

/// Coefficients about t, constant first: their dictionary order is the order of the values just after t.
std::vector<Rational> expansion(const Value& value, double t, std::size_t terms) {
  std::vector<Rational> result;
  Rational factorial = 1;
  Polynomial p = polynomial(value);
  for (std::size_t i = 0; i < terms; ++i) {
    result.push_back(p(rational(t)) / factorial);
    factorial *= i + 1;
    p = p.derivative();
  }
  return result;
}

std::vector<std::vector<Rational>> expansions(std::span<const Value> values, double t) {
  std::size_t terms = 1;
  for (const Value& value : values) terms = std::max(terms, value.coefficients.size());
  std::vector<std::vector<Rational>> result;
  for (const Value& value : values) result.push_back(expansion(value, t, terms));
  return result;
}

/// The six differences that are all positive while the boxes overlap.
std::vector<Polynomial> overlap_conditions(const MovingBox& a, const MovingBox& b) {
  std::vector<Polynomial> result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.push_back(polynomial(a.high[axis]) - polynomial(b.low[axis]));
    result.push_back(polynomial(b.high[axis]) - polynomial(a.low[axis]));
  }
  return result;
}

}  // namespace

int compare_after(const Value& a, const Value& b, double t) {
  return (polynomial(a) - polynomial(b)).sign_after(rational(t));
}

std::vector<std::size_t> order_after(std::span<const Value> values, double t) {
  const auto keys = expansions(values, t);
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return keys[i] < keys[j]; });
  return order;
}

std::size_t greatest_after(std::span<const Value> values, double t) {
  assert(!values.empty());
  const auto keys = expansions(values, t);
  return static_cast<std::size_t>(std::max_element(keys.begin(), keys.end()) - keys.begin());
}

std::optional<Instant> first_below(const Value& a, const Value& b, double from, double until) {
  return first_negative(polynomial(a) - polynomial(b), rational(from), time_end(until));
}

bool overlap_after(const MovingBox& a, const MovingBox& b, double t) {
  // Up to the first that does not hold: most boxes are apart.
  const Rational now = rational(t);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if ((polynomial(a.high[axis]) - polynomial(b.low[axis])).sign_after(now) <= 0) return false;
    if ((polynomial(b.high[axis]) - polynomial(a.low[axis])).sign_after(now) <= 0) return false;
  }
  return true;
}

std::vector<Stretch> overlaps(const MovingBox& a, const MovingBox& b, double begin, double end) {
  const auto conditions = overlap_conditions(a, b);
  const auto holds = [&](const Rational& t) {
    return std::all_of(conditions.begin(), conditions.end(), [&](const Polynomial& p) { return p(t) > 0; });
  };
  return stretches({conditions, holds}, rational(begin), time_end(end));
}

}  // namespace oracle
