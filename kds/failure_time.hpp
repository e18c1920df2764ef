// Failure times: when a certificate first ceases to hold.
#pragma once

#include "kds/certificate.hpp"
#include "kds/lattice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kds {

/// The failure time of a certificate that does not fail within the horizon.
inline constexpr double never = std::numeric_limits<double>::infinity();

/// The first double t in [now, horizon] with sign_after(certificate, t) < 0, or `never`.
///
/// This is the library's definition of an event time. It has three consequences. It is within one ulp above the true
/// root, and the enclosure is (previous double, t]. It is a function of the certificate alone: every solver, queue,
/// broad phase and compiler gives the same bits. And when the clock stands at t the certificate *has* failed,
/// exactly, so an event never proves early.
///
/// Method: closed forms in double-double for degrees 1 and 2, verified by exact signs on both sides; for higher
/// degrees the sign changes of the derivatives, from the linear one up, cut [now, horizon] into intervals on which
/// f is monotone, and in each a safeguarded Newton iteration finds the double at which the exact sign turns. Nothing
/// is assumed about the roots: double and clustered ones cost more, never an error.
///
/// Cost: O(degree^2) sign evaluations; most certificates are decided by signs alone. `horizon` may be infinite.
template <Certificate C>
double failure_time(const C& certificate, double now, double horizon = never);

/// The same where f has just turned from - to + at now (two elements that have just swapped): its sign there, which
/// is zero up to rounding and would ask for the expensive rungs, is known. A line has no second failure.
template <Certificate C>
double failure_time_after_turn(const C& certificate, double now, double horizon = never);

/// f with its sign turned: "fails" when f turns positive.
template <Certificate C>
struct Negated {
  static constexpr int degree = C::degree;
  const C& certificate;

  template <class Number>
  Polynomial<degree, Number> polynomial(double epoch) const {
    return -certificate.template polynomial<Number>(epoch);
  }
  bool vanishes() const { return detail::known_to_vanish(certificate); }
};

/// The first double t in [now, horizon] with sign_after(certificate, t) > 0, or `never`.
template <Certificate C>
double recovery_time(const C& certificate, double now, double horizon = never) {
  return failure_time(Negated<C>{certificate}, now, horizon);
}

// ---------------------------------------------------------------------------------------------------------------

namespace detail {

/// Middle of the coefficients about an epoch, for guesses.
template <class C>
Polynomial<C::degree> middle(const Polynomial<C::degree, Ball<double>>& p) {
  Polynomial<C::degree> result;
  for (std::size_t i = 0; i <= C::degree; ++i) result.c[i] = p.c[i].middle;
  return result;
}

/// Finds where derivative number `order` of f changes sign, on a stretch with exactly one change.
template <class C>
class LatticeCrossing {
 public:
  LatticeCrossing(const C& certificate, int order) : certificate_(certificate), order_(static_cast<std::size_t>(order)) {}

  /// The first double in (below, above] whose sign is that of `above`. Precondition: the sign at `below` differs, and
  /// there is one change between. `guess` may be anything.
  double operator()(double below, double above, int sign_above, double guess) const {
    int without_progress = 0;
    double candidate = guess;
    while (next_up(below) < above) {
      const std::uint64_t width = lattice_distance(below, above);
      if (!(candidate > below)) candidate = next_up(below);
      if (!(candidate < above)) candidate = next_down(above);
      if (without_progress > 2) {
        candidate = lattice_middle(below, above);
        without_progress = 0;
      }
      const Step step = evaluate(candidate);
      if (step.sign == sign_above) {
        above = candidate;
      } else {
        below = candidate;
      }
      if (lattice_distance(below, above) > width / 2) ++without_progress;
      // The first double not before Newton's root; once that is known to be past the root, the one before it.
      candidate = step.newton;
      if (candidate == above) candidate = next_down(above);
    }
    return above;
  }

 private:
  struct Step {
    int sign;
    double newton;
  };

  Step evaluate(double t) const {
    ++sign_counters.extended;
    const auto f = certificate_.template polynomial<Ball<DoubleDouble>>(t);
    const auto& value = f.c[order_];
    int s = certain_sign(value);
    if (s == 0) s = exact_sign_after(certificate_, t, static_cast<int>(order_));
    const DoubleDouble slope = f.c[order_ + 1].middle * static_cast<double>(order_ + 1);
    const DoubleDouble root = -value.middle / slope + t;
    return {s, root.low > 0 ? next_up(root.high) : root.high};
  }

  const C& certificate_;
  std::size_t order_;
};

/// f > 0 just after now, linear and falling. The first double in (now, horizon] not before the root, from a guess that is
/// usually it or the one before.
template <class C>
double first_past_linear_root(const C& certificate, double now, double guess, double horizon) {
  if (!(guess <= horizon)) guess = horizon < never ? horizon : std::numeric_limits<double>::max();
  if (extended_sign_after(certificate, guess, 0) < 0) {
    const double before = next_down(guess);
    if (!(before > now) || extended_sign_after(certificate, before, 0) >= 0) return guess;
    return LatticeCrossing<C>(certificate, 0)(now, before, -1, before);
  }
  const double after = next_up(guess);
  if (!(after <= horizon) || after == never) return never;
  if (extended_sign_after(certificate, after, 0) < 0) return after;
  const double end = horizon < never ? horizon : std::numeric_limits<double>::max();
  if (extended_sign_after(certificate, end, 0) >= 0) return never;
  return LatticeCrossing<C>(certificate, 0)(after, end, -1, after);
}

/// f > 0 just after now, linear and falling; p is f about now. The first double not before the root.
///
/// A root in doubles, then one Newton step from it with f evaluated in double-double: the step is small, so a double
/// division gives it to a few units of 2^-53, and the root is start + step to well beyond the precision of start.
template <class C>
double linear_failure_time(const C& certificate, const Polynomial<1, Ball<double>>& p, double now, double horizon) {
  const double steepest = std::abs(p.c[1].middle) + p.c[1].radius;
  // Cheap and safe rejection: the root is not before now + lower.
  const double lower = (p.c[0].middle - p.c[0].radius) / steepest;
  if (now + lower * (1 - 0x1p-40) > horizon) return never;
  const double start = std::max(now, now + p.c[0].middle / -p.c[1].middle);
  // A slope that vanishes in doubles may still bring a root among them.
  if (!(start < never)) return first_past_linear_root(certificate, now, std::numeric_limits<double>::max(), horizon);
  ++sign_counters.extended;
  const auto f = certificate.template polynomial<Ball<DoubleDouble>>(start);
  const double value = f.c[0].middle.high;
  const double slope = f.c[1].middle.high;
  const double step = value / -slope;
  const DoubleDouble root = two_sum(start, step);
  // |step| 2^-50 covers the quotient and the two numbers' low parts; twice the rest is the error of f at start, and
  // exceeds |step| where the slope is not known to half of itself.
  const double error =
      (0x1p-50 * std::abs(value) + 2 * (f.c[0].radius + std::abs(step) * f.c[1].radius)) / std::abs(slope) +
      Ball<double>::underflow;
  double t = root.high;
  if (root.low > error) {
    t = next_up(t);
  } else if (!(root.low < -error)) {
    // The root is t up to rounding, or the numbers are out of the range of these bounds: find it by exact signs.
    if (!(t > now)) t = next_up(now);
    return first_past_linear_root(certificate, now, t, horizon);
  }
  return t <= horizon ? t : never;
}

/// A root of p between lower and upper (one sign change), to a few ulps: bisection with Newton steps in doubles.
template <int Degree>
double approximate_root(const Polynomial<Degree>& p, double lower, double upper, bool rising) {
  const auto slope = derivative(p);
  double x = 0.5 * lower + 0.5 * upper;
  for (int i = 0; i < 100 && lower < upper; ++i) {
    const double value = p(x);
    ((value > 0) == rising ? upper : lower) = x;
    double next = x - value / slope(x);
    if (!(next > lower && next < upper)) next = 0.5 * lower + 0.5 * upper;
    if (std::abs(next - x) <= 0x1p-50 * std::abs(next)) return next;
    x = next;
  }
  return x;
}

/// Derivative number `order` of the polynomial, up to the factor order!.
template <int Order, int Degree>
Polynomial<Degree - Order> scaled_derivative(const Polynomial<Degree>& p) {
  Polynomial<Degree - Order> result;
  for (std::size_t i = Order; i <= Degree; ++i) {
    double binomial = 1;
    for (std::size_t j = 1; j <= Order; ++j) binomial = binomial * static_cast<double>(i - Order + j) / static_cast<double>(j);
    result.c[i - Order] = p.c[i] * binomial;
  }
  return result;
}

/// Sign changes on the lattice of doubles, by derivatives.
template <class C>
class DerivativeIntervals {
 public:
  DerivativeIntervals(const C& certificate, const Polynomial<C::degree>& guide, double now, double horizon)
      : certificate_(certificate), guide_(guide), now_(now), horizon_(horizon) {}

  /// First double in [now, horizon] with f < 0 just after.
  double first_negative() {
    Breaks breaks;
    return descend<C::degree - 1>(breaks);
  }

 private:
  // Doubles at which the sign of a derivative is new, in order, and how many.
  struct Breaks {
    std::array<double, C::degree + 1> at{};
    int count = 0;
  };

  /// Sign at the end of the horizon: the leading term decides at infinity.
  int sign_at_end(int order) const {
    if (horizon_ < never) return sign_after(certificate_, horizon_, order);
    for (int i = C::degree; i >= order; --i) {
      if (const int s = sign_after(certificate_, now_, i)) return s;
    }
    return 0;
  }

  template <int Order>
  double crossing(double below, double above, int sign_above) const {
    double guess = below;
    const auto p = scaled_derivative<Order>(guide_);
    const bool rising = sign_above > 0;
    double lower = below - now_;
    double upper = above - now_;
    if (!(upper < 0x1p1000)) {  // Unbounded: double the step until the sign turns.
      double step = 1;
      while (step < 0x1p900 && (p(lower + step) > 0) != rising) step *= 2;
      upper = lower + step;
    }
    guess = now_ + approximate_root(p, lower, upper, rising);
    return LatticeCrossing<C>(certificate_, Order)(below, above, sign_above, guess);
  }

  /// Given the sign changes of derivative Order + 1, finds those of derivative Order, and so on down to f itself.
  template <int Order>
  double descend(const Breaks& steeper) const {
    Breaks breaks;
    double start = now_;
    int start_sign = sign_after(certificate_, start, Order);
    if (Order == 0 && start_sign < 0) return start;
    for (int i = 0; i <= steeper.count; ++i) {
      const bool last = i == steeper.count;
      const double stop = last ? horizon_ : next_down(steeper.at[static_cast<std::size_t>(i)]);
      // Derivative Order is monotone on [start, stop].
      const int stop_sign = last ? sign_at_end(Order) : (stop > start ? sign_after(certificate_, stop, Order) : start_sign);
      if (stop_sign != start_sign && stop_sign != 0 && start_sign != 0) {
        const double end = last && horizon_ == never ? std::numeric_limits<double>::max() : stop;
        const double t = crossing<Order>(start, end, stop_sign);
        if (Order == 0 && stop_sign < 0) return t;
        breaks.at[static_cast<std::size_t>(breaks.count++)] = t;
      }
      if (!last) {
        start = steeper.at[static_cast<std::size_t>(i)];
        start_sign = sign_after(certificate_, start, Order);
        if (start_sign != stop_sign && start_sign != 0 && stop_sign != 0) {
          if (Order == 0 && start_sign < 0) return start;
          breaks.at[static_cast<std::size_t>(breaks.count++)] = start;
        }
      }
    }
    if constexpr (Order > 0) {
      return descend<Order - 1>(breaks);
    } else {
      return never;
    }
  }

  const C& certificate_;
  const Polynomial<C::degree>& guide_;
  double now_;
  double horizon_;
};

/// Precondition: f > 0 just after now.
template <class C>
double quadratic_failure_time(const C& certificate, const Polynomial<2, Ball<double>>& p, double now, double horizon) {
  const auto by_derivatives = [&] {
    const auto guide = middle<C>(certificate.template polynomial<Ball<double>>(now));
    return DerivativeIntervals<C>(certificate, guide, now, horizon).first_negative();
  };
  const int bend = certain_sign(p.c[2]);
  const int rate = certain_sign(p.c[1]);
  if (bend > 0 && rate > 0) return never;
  const Ball<double> discriminant = p.c[1] * p.c[1] - p.c[0] * p.c[2] * 4.0;
  const int real = certain_sign(discriminant);
  if (bend > 0 && real < 0) return never;
  if (bend == 0 || (bend > 0 && (rate == 0 || real == 0)) || !(discriminant.middle < never)) {
    return by_derivatives();
  }
  const double c0 = p.c[0].middle;
  const double c1 = p.c[1].middle;
  const double c2 = p.c[2].middle;
  const double root = std::sqrt(discriminant.middle > 0 ? discriminant.middle : 0.0);
  if (bend > 0) {  // Falls, then rises: the smaller root, which lies before the vertex.
    const double guess = now + 2 * c0 / (root - c1);
    double above = now - c1 / (2 * c2);
    if (above > horizon) {
      if (guess * (1 - 0x1p-30) > horizon && now + (guess - now) * (1 - 0x1p-30) > horizon && sign_after(certificate, horizon) > 0) {
        return never;
      }
      above = horizon;
    }
    if (above < never && sign_after(certificate, above) < 0) {
      return LatticeCrossing<C>(certificate, 0)(now, above, -1, guess);
    }
    if (above == horizon && horizon < never) {
      // Positive at the horizon, which is before the vertex: falling all the way, so positive throughout.
      if (sign_after(certificate, horizon, 1) < 0) return never;
    }
    return by_derivatives();
  }
  // Concave and positive now: one crossing ahead.
  const double tau = c1 >= 0 ? (c1 + root) / (-2 * c2) : 2 * c0 / (root - c1);
  if (horizon < never && sign_after(certificate, horizon) > 0) return never;
  const double above = horizon < never ? horizon : std::numeric_limits<double>::max();
  if (horizon == never && !(now + tau < 0x1p900) && sign_after(certificate, above) >= 0) return never;
  return LatticeCrossing<C>(certificate, 0)(now, above, -1, now + tau);
}

/// The first coefficients of a polynomial whose others are zero.
template <int Lower, int Degree, class Scalar>
Polynomial<Lower, Scalar> truncated(const Polynomial<Degree, Scalar>& p) {
  Polynomial<Lower, Scalar> result;
  for (std::size_t i = 0; i <= Lower; ++i) result.c[i] = p.c[i];
  return result;
}

/// p is f about now. Precondition: f > 0 just after now.
template <class C>
double failure_time_while_positive(const C& certificate, const Polynomial<C::degree, Ball<double>>& p, double now,
                                   double horizon) {
  // Where all higher coefficients are certainly not negative, f never falls.
  int falling = C::degree;
  while (falling > 0) {
    const auto& c = p.c[static_cast<std::size_t>(falling)];
    if (!(c.middle >= c.radius * Ball<double>::slack)) break;
    --falling;
  }
  if (falling == 0) return never;
  // Motions of a formal degree often differ by one of a lower: bodies in a common gravity, say.
  int degree = C::degree;
  while (p.c[static_cast<std::size_t>(degree)].is_zero()) --degree;
  if constexpr (C::degree >= 1) {
    if (degree == 1) {
      if (certain_sign(p.c[1]) == 0 && extended_sign_after(certificate, now, 1) >= 0) return never;
      return linear_failure_time(certificate, truncated<1>(p), now, horizon);
    }
  }
  if constexpr (C::degree >= 2) {
    if (degree == 2) return quadratic_failure_time(certificate, truncated<2>(p), now, horizon);
  }
  if constexpr (C::degree >= 3) {
    const auto guide = middle<C>(p);
    return DerivativeIntervals<C>(certificate, guide, now, horizon).first_negative();
  }
  return never;
}

}  // namespace detail

template <Certificate C>
double failure_time(const C& certificate, double now, double horizon) {
  if (!(now <= horizon)) return never;
  if constexpr (requires { certificate.quick_failure_time(now, horizon); }) {
    const double t = certificate.quick_failure_time(now, horizon);
    if (!std::isnan(t)) return t;
  }
  const auto p = certificate.template polynomial<Ball<double>>(now);
  int value = certain_sign(p.c[0]);
  if (value == 0) value = detail::extended_sign_after(certificate, now, 0);
  if (value < 0) return now;
  if (value == 0) return never;  // f vanishes identically
  return detail::failure_time_while_positive(certificate, p, now, horizon);
}

template <Certificate C>
double failure_time_after_turn(const C& certificate, double now, double horizon) {
  if (!(now <= horizon)) return never;
  if constexpr (C::degree <= 1) {
    return never;  // A line that is positive just after a zero has risen through it.
  } else {
    return detail::failure_time_while_positive(certificate, certificate.template polynomial<Ball<double>>(now), now,
                                               horizon);
  }
}

}  // namespace kds
