#include "tests/support/exact_failure_time.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

namespace oracle {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double largest = std::numeric_limits<double>::max();

/// The double half way from a to b in steps from double to double. Precondition: a < b, finite.
double middle(double a, double b) {
  const auto index = [](double x) {
    const auto bits = std::bit_cast<std::int64_t>(std::abs(x));
    return x < 0 ? -bits : bits;
  };
  const std::int64_t half = (index(a) >> 1) + (index(b) >> 1) + (index(a) & index(b) & 1);
  return half < 0 ? -std::bit_cast<double>(-half) : std::bit_cast<double>(half);
}

/// Coefficients about x of the polynomial whose coefficients about 0 are c.
std::vector<Rational> shifted(std::vector<Rational> c, const Rational& x) {
  for (std::size_t k = 0; k + 1 < c.size(); ++k) {
    for (std::size_t i = c.size() - 1; i-- > k;) c[i] += x * c[i + 1];
  }
  return c;
}

int first_sign(const std::vector<Rational>& c) {
  for (const Rational& x : c) {
    if (x.sign() != 0) return x.sign();
  }
  return 0;
}

class LatticeSearch {
 public:
  LatticeSearch(const std::vector<Rational>& c, const Rational& start) : c_(c), start_(start) {}

  std::vector<Rational> about(double t) const { return shifted(c_, rational(t) - start_); }

  /// The first double in (a, b] just after which the sign is -1. `here` is about a, where the sign is not.
  std::optional<double> first_negative(double a, const std::vector<Rational>& here, double b,
                                       const std::vector<Rational>& there) const {
    if (std::nextafter(a, infinity) < b && may_have_root(here, rational(b) - rational(a))) {
      const double m = middle(a, b);
      const std::vector<Rational> half_way = about(m);
      if (const auto found = first_negative(a, here, m, half_way)) return found;
      return first_negative(m, half_way, b, there);
    }
    return first_sign(there) < 0 ? std::optional(b) : std::nullopt;
  }

 private:
  /// False only if there is no root strictly between 0 and width: no sign changes among the coefficients of
  /// (1 + y)^n p(width / (1 + y)), whose positive roots are those of p in between.
  static bool may_have_root(std::vector<Rational> p, const Rational& width) {
    Rational power = 1;
    for (Rational& x : p) {
      x *= power;
      power *= width;
    }
    std::reverse(p.begin(), p.end());
    p = shifted(std::move(p), 1);
    const bool positive = std::any_of(p.begin(), p.end(), [](const Rational& x) { return x.sign() > 0; });
    const bool negative = std::any_of(p.begin(), p.end(), [](const Rational& x) { return x.sign() < 0; });
    return positive && negative;
  }

  const std::vector<Rational>& c_;
  const Rational& start_;
};

}  // namespace

double failure_time(const std::vector<Rational>& c, const Rational& start, double now, double horizon) {
  if (!(now <= horizon)) return infinity;
  const LatticeSearch search(c, start);
  const std::vector<Rational> here = search.about(now);
  if (first_sign(here) < 0) return now;
  const double end = std::min(horizon, largest);
  return search.first_negative(now, here, end, search.about(end)).value_or(infinity);
}

double failure_time(const Polynomial& p, double now, double horizon) {
  return failure_time(p.coefficients(), 0, now, horizon);
}

int sign_after(const std::vector<Rational>& c, const Rational& start, double t) {
  return first_sign(shifted(c, rational(t) - start));
}

double first_double(const Condition& condition, double now, double horizon) {
  for (const Stretch& stretch : stretches(condition, rational(now), time_end(horizon))) {
    const double t = stretch.begin.ceiling();
    if (!(t <= std::min(horizon, largest))) break;
    if (!stretch.end || stretch.end->compare(rational(t)) > 0) return t;
  }
  return infinity;
}

}  // namespace oracle
