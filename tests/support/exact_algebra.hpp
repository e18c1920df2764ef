// Polynomials with rational coefficients, and their real roots as exact numbers. For tests: slow and simple.
// Shares no code with the library, so that both cannot be wrong in the same way.
#pragma once

#include "tests/support/exact_rational.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace oracle {

/// c[0] + c[1] t + c[2] t^2 + ...; the zero polynomial has no coefficients.
class Polynomial {
 public:
  Polynomial() = default;
  Polynomial(std::vector<Rational> coefficients);  // NOLINT(google-explicit-constructor)
  Polynomial(const Rational& constant);            // NOLINT(google-explicit-constructor)
  /// c0 + c1 (t - start) + ..., written about zero.
  static Polynomial motion(const std::vector<double>& coefficients, double start);

  const std::vector<Rational>& coefficients() const { return c_; }
  int degree() const { return static_cast<int>(c_.size()) - 1; }
  Rational operator()(const Rational& t) const;
  Polynomial derivative() const;

  /// Sign just after t: of the first derivative, from the zeroth on, that is not zero there.
  int sign_after(const Rational& t) const;

  friend Polynomial operator+(const Polynomial& a, const Polynomial& b);
  friend Polynomial operator-(const Polynomial& a, const Polynomial& b);
  friend Polynomial operator*(const Polynomial& a, const Polynomial& b);

 private:
  std::vector<Rational> c_;
};

/// A point in time, known exactly: a rational, or the one root of a polynomial in an open interval, which is
/// simple. Asking narrows the interval, and changes nothing else.
class Instant {
 public:
  explicit Instant(Rational value);
  explicit Instant(double value) : Instant(rational(value)) {}

  /// low() <= the instant <= high(); equal where the value is known to be rational.
  const Rational& low() const { return low_; }
  const Rational& high() const { return high_; }
  bool is_rational() const { return low_ == high_; }

  /// Narrows until high - low <= 2^-bits max(|low|, |high|); 60 bits by default.
  const Instant& narrow(int bits = 60) const;
  /// -1, 0, 1 as the instant is before, at or after t.
  int compare(const Rational& t) const;
  int compare(const Instant& other) const;
  friend bool operator<(const Instant& a, const Instant& b) { return a.compare(b) < 0; }
  friend bool operator==(const Instant& a, const Instant& b) { return a.compare(b) == 0; }

  /// One halving of the interval.
  void halve() const;

  /// The first double that is not before the instant; exact. +infinity beyond the largest.
  double ceiling() const;
  /// A double next to the instant.
  double approximate() const;

 private:
  friend std::vector<Instant> roots(const Polynomial& p, const Rational& after, const std::optional<Rational>& upto);
  Instant(std::vector<Integer> polynomial, Rational low, Rational high);

  std::vector<Integer> polynomial_;  // of opposite signs at the two ends
  mutable Rational low_;
  mutable Rational high_;
};

/// The distinct real roots in (after, upto], rising; all above `after` if upto is empty. None for the zero polynomial.
std::vector<Instant> roots(const Polynomial& p, const Rational& after, const std::optional<Rational>& upto);

/// A stretch of time in which something holds: just after every t with begin <= t < end.
struct Stretch {
  Instant begin;
  std::optional<Instant> end;  ///< empty if it holds at the end of the time looked at
  bool at_start = false;       ///< held from the start of the time looked at
};

/// Something that can change its truth only at roots of the given polynomials.
struct Condition {
  std::vector<Polynomial> critical;
  std::function<bool(const Rational& t)> holds;  ///< asked only strictly between roots
};

/// Watches a condition, which may be another one in each part of the time, and notes the stretches in which it holds.
class Watch {
 public:
  /// Looks at start <= t < end, or at start <= t <= end if it is the last part; an empty end is infinity. The parts
  /// follow each other; what holds on both sides of a seam goes on.
  void look(const Condition& condition, const Rational& start, const std::optional<Rational>& end, bool last);

  const std::vector<Stretch>& stretches() const { return stretches_; }

 private:
  void note(bool holds, const Instant& since);

  std::vector<Stretch> stretches_;
  bool holds_ = false;
  bool begun_ = false;
};

/// The stretches of start <= t <= end.
std::vector<Stretch> stretches(const Condition& condition, const Rational& start, const std::optional<Rational>& end);

/// The first t in [start, end] just after which p < 0.
std::optional<Instant> first_negative(const Polynomial& p, const Rational& start,
                                      const std::optional<Rational>& end = std::nullopt);

}  // namespace oracle
