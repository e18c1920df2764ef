#include "tests/support/integer_polynomials.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>

namespace oracle::integer {

void trim(Integers& p) {
  while (!p.empty() && p.back() == 0) p.pop_back();
}

void make_primitive(Integers& p) {
  Integer content = 0;
  for (const Integer& c : p) content = gcd(content, c);
  if (content <= 1) return;
  for (Integer& c : p) c /= content;
}

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

std::pair<Integer, Integer> fraction(const Rational& x) {
  if (x.exponent() >= 0) return {x.odd_numerator() << x.exponent(), x.odd_denominator()};
  return {x.odd_numerator(), x.odd_denominator() << -x.exponent()};
}

Integers derivative(const Integers& p) {
  Integers result;
  for (std::size_t i = 1; i < p.size(); ++i) result.push_back(p[i] * i);
  return result;
}

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

Rational root_bound(const Integers& p) {
  Integer largest = 0;
  for (const Integer& c : p) largest = std::max(largest, Integer(abs(c)));
  const Integer ratio = largest / abs(p.back()) + 2;
  return Rational(Integer(1) << (msb(ratio) + 1));
}

}  // namespace oracle::integer
