#include "tests/support/exact_algebra.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace oracle {
namespace {

using Integers = std::vector<Integer>;  // a polynomial, constant first, its last coefficient not zero

void trim(Integers& p) {
  while (!p.empty() && p.back() == 0) p.pop_back();
}

/// Divides by the greatest common divisor of the coefficients, which is positive.
void make_primitive(Integers& p) {
  Integer content = 0;
  for (const Integer& c : p) content = gcd(content, c);
  if (content <= 1) return;
  for (Integer& c : p) c /= content;
}

/// A positive multiple with integer coefficients.
Integers integers(const Polynomial& p) {
  Integer common = 1;
  int exponent = std::numeric_limits<int>::max();
  for (const Rational& c : p.coefficients()) {
    if (c.sign() == 0) continue;
    if (c.odd_denominator() != common) common = lcm(common, c.odd_denominator());
    exponent = std::min(exponent, c.exponent());
  }
  Integers result;
  for (const Rational& c : p.coefficients()) {
    const Integer factor = c.odd_denominator() == common ? Integer(1) : Integer(common / c.odd_denominator());
    result.push_back(c.sign() == 0 ? Integer(0) : Integer((c.odd_numerator() * factor) << (c.exponent() - exponent)));
  }
  return result;
}

/// x = first / second, in integers; second is positive.
std::pair<Integer, Integer> fraction(const Rational& x) {
  if (x.exponent() >= 0) return {x.odd_numerator() << x.exponent(), x.odd_denominator()};
  return {x.odd_numerator(), x.odd_denominator() << -x.exponent()};
}

Integers derivative(const Integers& p) {
  Integers result;
  for (std::size_t i = 1; i < p.size(); ++i) result.push_back(p[i] * i);
  return result;
}

/// A positive multiple of the remainder of a by b.
Integers remainder(Integers a, const Integers& b) {
  const Integer scale = abs(b.back());
  while (a.size() >= b.size()) {
    const std::size_t shift = a.size() - b.size();
    const Integer factor = b.back() > 0 ? a.back() : Integer(-a.back());
    for (Integer& c : a) c *= scale;
    for (std::size_t i = 0; i < b.size(); ++i) a[i + shift] -= factor * b[i];
    assert(a.back() == 0);
    trim(a);
  }
  make_primitive(a);
  return a;
}

/// a / b up to a positive or negative constant. Precondition: b divides a.
Integers quotient(Integers a, const Integers& b) {
  Integers result(a.size() - b.size() + 1);
  const Integer scale = abs(b.back());
  while (a.size() >= b.size()) {
    const std::size_t shift = a.size() - b.size();
    const Integer factor = b.back() > 0 ? a.back() : Integer(-a.back());
    for (Integer& c : a) c *= scale;
    for (Integer& c : result) c *= scale;
    result[shift] += factor;
    for (std::size_t i = 0; i < b.size(); ++i) a[i + shift] -= factor * b[i];
    trim(a);
  }
  assert(a.empty());
  make_primitive(result);
  return result;
}

Integers common_divisor(Integers a, Integers b) {
  while (!b.empty()) a = std::exchange(b, remainder(a, b));
  return a;
}

/// Sign of p at x, without a division.
int sign_at(const Integers& p, const Rational& x) {
  if (p.empty()) return 0;
  const auto [n, d] = fraction(x);
  Integer value = p.back();
  Integer power = 1;
  for (std::size_t i = p.size() - 1; i-- > 0;) {
    power *= d;
    value = value * n + p[i] * power;
  }
  return value.sign();
}

/// The chain of Sturm.
class Sturm {
 public:
  explicit Sturm(const Integers& p) : chain_{p, derivative(p)} {
    make_primitive(chain_.back());
    while (chain_.back().size() > 1) {
      Integers next = remainder(chain_[chain_.size() - 2], chain_.back());
      if (next.empty()) break;
      for (Integer& c : next) c = -c;
      chain_.push_back(std::move(next));
    }
  }

  /// Distinct roots in (a, b] are changes(a) - changes(b), if neither is a multiple root.
  int changes(const Rational& x) const {
    int count = 0;
    int before = 0;
    for (const Integers& p : chain_) {
      const int now = sign_at(p, x);
      if (now != 0 && before != 0 && now != before) ++count;
      if (now != 0) before = now;
    }
    return count;
  }

 private:
  std::vector<Integers> chain_;
};

Integers square_free(const Integers& p) {
  const Integers common = common_divisor(p, derivative(p));
  return common.size() <= 1 ? p : quotient(p, common);
}

Integers product(const Integers& a, const Integers& b) {
  Integers result(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) result[i + j] += a[i] * b[j];
  }
  return result;
}

/// The rule of Descartes for the open interval (low, high): the number of roots, counted with multiplicity, is this or
/// less by an even number. Changes of sign in the coefficients of (1 + x)^n p((low + high x) / (1 + x)).
int sign_changes(const Integers& p, const Rational& low, const Rational& high) {
  const auto [low_n, low_d] = fraction(low);
  const auto [high_n, high_d] = fraction(high);
  const Integers numerator{low_n * high_d, high_n * low_d};
  const Integer common = low_d * high_d;
  const Integers denominator{common, common};
  Integers value{p.back()};
  Integers power{1};
  for (std::size_t i = p.size() - 1; i-- > 0;) {
    power = product(power, denominator);
    value = product(value, numerator);
    for (std::size_t j = 0; j < value.size(); ++j) value[j] += p[i] * power[j];
  }
  int changes = 0;
  int before = 0;
  for (const Integer& c : value) {
    const int now = c.sign();
    changes += now != 0 && before != 0 && now != before;
    if (now != 0) before = now;
  }
  return changes;
}

/// A power of two above the absolute value of every root: Cauchy's bound 1 + max |c_i / c_n|.
Rational root_bound(const Integers& p) {
  Integer largest = 0;
  for (const Integer& c : p) largest = std::max(largest, Integer(abs(c)));
  const Integer ratio = largest / abs(p.back()) + 2;
  return Rational(Integer(1) << (msb(ratio) + 1));
}

}  // namespace

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
