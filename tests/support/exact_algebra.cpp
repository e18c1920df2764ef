#include "tests/support/exact_algebra.hpp"

#include "tests/support/integer_polynomials.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace oracle {

using namespace integer;

// --- numbers and polynomials

Polynomial::Polynomial(std::vector<Rational> coefficients) : c_(std::move(coefficients)) {
  while (!c_.empty() && c_.back() == 0) c_.pop_back();
}

Polynomial::Polynomial(const Rational& constant) : Polynomial(std::vector<Rational>{constant}) {}

Polynomial Polynomial::motion(const std::vector<double>& coefficients, double start) {
  const Polynomial since_start(std::vector<Rational>{-rational(start), 1});
  Polynomial result;
  for (std::size_t i = coefficients.size(); i-- > 0;) result = result * since_start + rational(coefficients[i]);
  return result;
}

Rational Polynomial::operator()(const Rational& t) const {
  Rational value = 0;
  for (std::size_t i = c_.size(); i-- > 0;) value = value * t + c_[i];
  return value;
}

Polynomial Polynomial::derivative() const {
  std::vector<Rational> result;
  for (std::size_t i = 1; i < c_.size(); ++i) result.push_back(c_[i] * i);
  return result;
}

int Polynomial::sign_after(const Rational& t) const {
  for (Polynomial p = *this; !p.c_.empty(); p = p.derivative()) {
    const int s = p(t).sign();
    if (s != 0) return s;
  }
  return 0;
}

Polynomial operator+(const Polynomial& a, const Polynomial& b) {
  std::vector<Rational> sum(std::max(a.c_.size(), b.c_.size()));
  for (std::size_t i = 0; i < a.c_.size(); ++i) sum[i] += a.c_[i];
  for (std::size_t i = 0; i < b.c_.size(); ++i) sum[i] += b.c_[i];
  return sum;
}

Polynomial operator-(const Polynomial& a, const Polynomial& b) { return a + b * Rational(-1); }

Polynomial operator*(const Polynomial& a, const Polynomial& b) {
  if (a.c_.empty() || b.c_.empty()) return {};
  std::vector<Rational> product(a.c_.size() + b.c_.size() - 1);
  for (std::size_t i = 0; i < a.c_.size(); ++i) {
    for (std::size_t j = 0; j < b.c_.size(); ++j) product[i + j] += a.c_[i] * b.c_[j];
  }
  return product;
}

// --- instants

Instant::Instant(Rational value) : low_(value), high_(std::move(value)) {}

Instant::Instant(Integers polynomial, Rational low, Rational high)
    : polynomial_(std::move(polynomial)), low_(std::move(low)), high_(std::move(high)) {}

void Instant::halve() const {
  if (is_rational()) return;
  const Rational middle = (low_ + high_) / 2;
  if (middle.odd_denominator() == 1) {
    compare(middle);
    return;
  }
  // Ends with different denominators would multiply them at every step: take a number with none, near the middle.
  const Rational width = high_ - low_;
  const int scale = width.exponent() + static_cast<int>(msb(width.odd_numerator())) -
                    static_cast<int>(msb(width.odd_denominator())) - 3;  // 2^scale <= width / 4
  const int shift = middle.exponent() - scale;
  const Integer& n = middle.odd_numerator();
  const Integer& d = middle.odd_denominator();
  compare(Rational(shift >= 0 ? Integer((n << shift) / d) : Integer(n / (d << -shift))) * power_of_two(scale));
}

int Instant::compare(const Rational& t) const {
  if (is_rational() || t <= low_ || t >= high_) return high_ <= t && low_ < t ? -1 : low_ >= t && high_ > t ? 1 : 0;
  const int at_t = sign_at(polynomial_, t);
  if (at_t == 0) {
    low_ = high_ = t;
  } else if (at_t == sign_at(polynomial_, low_)) {
    low_ = t;
    return 1;
  } else {
    high_ = t;
    return -1;
  }
  return 0;
}

int Instant::compare(const Instant& other) const {
  if (is_rational()) return -other.compare(low_);
  if (other.is_rational()) return compare(other.low_);
  // Narrow both for a while; if that does not part them, ask whether they are one root of both polynomials.
  constexpr int patience = 48;
  for (int round = 0;; ++round) {
    if (high_ <= other.low_) return -1;
    if (other.high_ <= low_) return 1;
    if (is_rational() || other.is_rational()) return compare(other);
    if (round == patience) {
      const Integers common = common_divisor(polynomial_, other.polynomial_);
      if (common.size() > 1) {
        const Sturm chain(common);
        // Neither end is a root of both polynomials, as the ends of an interval are not roots of its own.
        if (chain.changes(std::max(low_, other.low_)) != chain.changes(std::min(high_, other.high_))) return 0;
      }
    }
    (high_ - low_ > other.high_ - other.low_ ? *this : other).halve();
  }
}

const Instant& Instant::narrow(int bits) const {
  const Rational factor = power_of_two(-bits);
  if (low_ < 0 && high_ > 0) compare(Rational(0));  // towards zero alone no width is small enough
  while (!is_rational() && high_ - low_ > factor * std::max(abs(low_), abs(high_))) halve();
  return *this;
}

double Instant::approximate() const {
  narrow();
  return oracle::approximate((low_ + high_) / 2);
}

double Instant::ceiling() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double t = approximate();
  while (std::isfinite(t) && compare(rational(t)) > 0) t = std::nextafter(t, infinity);
  if (t == infinity && compare(rational(std::numeric_limits<double>::max())) > 0) return t;
  for (;;) {
    const double before = std::nextafter(t, -infinity);
    if (!std::isfinite(before) || compare(rational(before)) > 0) return t;
    t = before;
  }
}

std::vector<Instant> roots(const Polynomial& polynomial, const Rational& after, const std::optional<Rational>& upto) {
  std::vector<Instant> found;
  if (polynomial.degree() < 1) return found;
  if (polynomial.degree() == 1) {
    const Rational root = -polynomial.coefficients()[0] / polynomial.coefficients()[1];
    if (root > after && (!upto || root <= *upto)) found.emplace_back(root);
    return found;
  }
  Integers p = integers(polynomial);
  const Rational end = upto ? *upto : std::max(root_bound(p), after + 1);
  if (!(after < end)) return found;

  // Bisection by the rule of Descartes [Collins76]. It ends where all roots are simple; after some halvings in vain the
  // polynomial is made so.
  constexpr int patience = 12;
  bool simple = false;
  struct Part {
    Rational low, high;  // the roots in (low, high]
    int depth;
  };
  std::vector<Part> parts{{after, end, 0}};
  while (!parts.empty()) {
    const Part part = std::move(parts.back());
    parts.pop_back();
    const int inside = sign_changes(p, part.low, part.high);
    const bool at_high = sign_at(p, part.high) == 0;
    if (inside == 0) {
      if (at_high) found.emplace_back(part.high);
    } else if (inside == 1 && !at_high && sign_at(p, part.low) != 0) {
      found.push_back(Instant(p, part.low, part.high));
    } else {
      if (part.depth >= patience && !simple) {
        p = square_free(p);
        simple = true;
      }
      const Rational middle = (part.low + part.high) / 2;
      parts.push_back({middle, part.high, part.depth + 1});
      parts.push_back({part.low, middle, part.depth + 1});  // the earlier half is taken first
    }
  }
  return found;
}

// --- stretches of time

void Watch::note(bool holds, const Instant& since) {
  if (holds && !holds_) stretches_.push_back({since, std::nullopt, !begun_});
  if (!holds && holds_) stretches_.back().end = since;
  holds_ = holds;
  begun_ = true;
}

void Watch::look(const Condition& condition, const Rational& start, const std::optional<Rational>& end, bool last) {
  std::vector<Instant> changes{Instant(start)};
  for (const Polynomial& p : condition.critical) {
    // What holds just after the very end is seen before the first root beyond it.
    for (Instant& root : roots(p, start, last ? std::nullopt : end)) changes.push_back(std::move(root));
  }
  std::sort(changes.begin(), changes.end());
  changes.erase(std::unique(changes.begin(), changes.end()), changes.end());
  if (end && !last) {
    while (changes.back().compare(*end) >= 0) changes.pop_back();
    changes.emplace_back(*end);
  }
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const Instant& here = changes[i];
    if (end && (last ? here.compare(*end) > 0 : here.compare(*end) == 0)) break;
    Rational sample = here.high() + 1;
    if (i + 1 < changes.size()) {
      const Instant& next = changes[i + 1];
      while (!(here.high() < next.low())) {
        (here.high() - here.low() > next.high() - next.low() ? here : next).halve();
      }
      sample = (here.high() + next.low()) / 2;
    }
    note(condition.holds(sample), here);
  }
}

std::vector<Stretch> stretches(const Condition& condition, const Rational& start, const std::optional<Rational>& end) {
  Watch watch;
  watch.look(condition, start, end, true);
  return watch.stretches();
}

std::optional<Instant> first_negative(const Polynomial& p, const Rational& start, const std::optional<Rational>& end) {
  const Condition condition{{p}, [&](const Rational& t) { return p(t) < 0; }};
  const std::vector<Stretch> found = stretches(condition, start, end);
  if (found.empty()) return std::nullopt;
  return found.front().begin;
}

}  // namespace oracle
