// Failure times by the sign changes of all derivatives: the net under the quicker methods.
#pragma once

#include "kds/failure_time_lattice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kds::detail {

/// Middle of the coefficients about an epoch, for guesses.
template <class C>
Polynomial<C::degree> middle(const Polynomial<C::degree, Ball<double>>& p) {
  Polynomial<C::degree> result;
  for (std::size_t i = 0; i <= C::degree; ++i) result.c[i] = p.c[i].middle;
  return result;
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

}  // namespace kds::detail
