#include "tests/benchmarks/roots/truth.hpp"

#include "tests/support/exact_algebra.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace bench_roots {
namespace {

using oracle::Instant;
using oracle::Rational;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Exponents e with 2^low < |x| < 2^high for every root x other than 0. Precondition: first and last coefficient not 0.
struct Range {
  int low, high;
};

/// The least k such that 2^k > 2 max |c[i] / c[n]|^(1 / (n - i)), the bound of [Fujiwara16] on the roots' sizes.
int size_bound(std::span<const double> c, bool reversed) {
  const std::size_t n = c.size() - 1;
  const auto exponent = [&](std::size_t i) { return std::ilogb(c[reversed ? n - i : i]); };
  int bound = std::numeric_limits<int>::min();
  for (std::size_t i = 0; i < n; ++i) {
    if (c[reversed ? n - i : i] == 0) continue;
    const double ratio = exponent(i) + 1 - exponent(n);  // log2 |c[i] / c[n]| is less
    bound = std::max(bound, static_cast<int>(std::ceil(ratio / static_cast<double>(n - i))) + 1);
  }
  return bound;
}

/// Positive roots, rising. Looks at one range of sizes after the other: halving from 2^900 down to 2^-900 takes long.
std::vector<Instant> positive_roots(std::span<const double> c) {
  while (!c.empty() && c.back() == 0) c = c.first(c.size() - 1);
  while (!c.empty() && c.front() == 0) c = c.subspan(1);
  if (c.size() < 2) return {};
  std::vector<Rational> exact;
  for (const double x : c) exact.push_back(oracle::rational(x));
  const oracle::Polynomial p(std::move(exact));
  const Range range{-size_bound(c, true), size_bound(c, false)};
  constexpr int window = 32;
  std::vector<Instant> found;
  for (int low = range.low; low < range.high; low += window) {
    const int high = std::min(low + window, range.high);
    for (Instant& root : oracle::roots(p, oracle::power_of_two(low), oracle::power_of_two(high))) {
      found.push_back(std::move(root));
    }
  }
  return found;
}

/// A number strictly between two roots.
Rational between(const Instant& a, const Instant& b) {
  while (!(a.high() < b.low())) (a.high() - a.low() > b.high() - b.low() ? a : b).halve();
  return (a.high() + b.low()) / 2;
}

ExactRoot as_doubles(const Instant& root) {
  root.narrow(120);
  const Rational middle = (root.low() + root.high()) / 2;
  ExactRoot result;
  result.high = oracle::approximate(middle);
  const int side = root.compare(oracle::rational(result.high));
  result.low = oracle::approximate(middle - oracle::rational(result.high));
  constexpr double least = std::numeric_limits<double>::denorm_min();
  if (side == 0) result.low = 0;
  if (side > 0 && !(result.low > 0)) result.low = least;
  if (side < 0 && !(result.low < 0)) result.low = -least;
  return result;
}

}  // namespace

int ExactRoot::compare(double t) const {
  if (high != t) return high < t ? -1 : 1;  // low is less than the distance of two doubles
  return low < 0 ? -1 : low > 0;
}

double ExactRoot::ceiling() const { return low > 0 ? std::nextafter(high, infinity) : high; }

double ExactRoot::distance_to(double t) const { return (t - high) - low; }

double ExactRoot::spacing() const {
  const double next = std::nextafter(high, low < 0 ? 0 : infinity);
  return next < infinity ? std::abs(next - high) : high - std::nextafter(high, 0);
}

bool Truth::seen(std::size_t i) const {
  const double first = roots[i].ceiling();
  return first < infinity && (i + 1 == roots.size() || roots[i + 1].compare(first) > 0);
}

int Truth::first_failure(double horizon) const {
  if (sign_after_now < 0) return root_at_now;
  for (std::size_t i = 0; i < roots.size() && roots[i].compare(horizon) <= 0; ++i) {
    if (roots[i].falling() && seen(i)) return static_cast<int>(i);
  }
  return -1;
}

Truth exact_truth(std::span<const double> c) {
  if (!std::all_of(c.begin(), c.end(), [](double x) { return std::isfinite(x); })) {
    throw std::invalid_argument("exact_truth: a coefficient is not finite");
  }
  Truth truth;
  const auto first = std::find_if(c.begin(), c.end(), [](double x) { return x != 0; });
  if (first == c.end()) return truth;
  truth.sign_after_now = *first > 0 ? 1 : -1;
  if (first != c.begin()) truth.roots.push_back({0, 0, 0, truth.sign_after_now});

  const std::vector<Instant> roots = positive_roots(c);
  std::vector<Rational> exact;
  for (const double x : c) exact.push_back(oracle::rational(x));
  const oracle::Polynomial p(std::move(exact));
  int sign = truth.sign_after_now;
  for (std::size_t i = 0; i < roots.size(); ++i) {
    ExactRoot root = as_doubles(roots[i]);
    if (!(root.high < infinity)) break;
    root.before = sign;
    sign = i + 1 < roots.size() ? p(between(roots[i], roots[i + 1])).sign() : p.coefficients().back().sign();
    root.after = sign;
    truth.roots.push_back(root);
  }
  return truth;
}

}  // namespace bench_roots
