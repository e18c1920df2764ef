// How failure times of turning certificates are found: by Taylor's series, and by signs.
#pragma once

#include "kds/arithmetic/lattice.hpp"
#include "kds/turning/precise_turning_model.hpp"
#include "kds/turning/turning_crossing.hpp"
#include "kds/turning/turning_expansion.hpp"
#include "kds/turning/turning_reference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace kds::detail {

/// Looks for the first double just after which side * f < 0.
template <int Degree, int Harmonics>
class TurningSearch {
 public:
  using Certificate = TurningReference<Degree, Harmonics>;

  TurningSearch(const Certificate& certificate, int side)
      : certificate_(certificate), side_(side), crossing_(certificate, side), spins_(certificate.spins()) {
    rate_ = Harmonics * (rate_bound(spins_[0]) + rate_bound(spins_[1]));
  }

  /// Precondition: now <= horizon, both finite.
  double from_any(double now, double horizon) const {
    const int sign_now = crossing_.sign(now);
    if (sign_now < 0) return now;
    if (sign_now == 0) return never;  // at all times
    return from_positive(now, horizon);
  }

  /// Precondition: both finite, and side * f > 0 just after now.
  double from_positive(double now, double horizon) const {
    double l = now;
    while (l < horizon) {
      Expansion f(certificate_, side_, l);
      const double reached = skipped(f, l, horizon);
      if (reached != l && reached < horizon) f = Expansion(certificate_, side_, reached);
      l = reached;
      for (int k = 0; k < strides_of_expansion && l < horizon; ++k) {
        const double r = stop_after(l, 1 / rate_, horizon);
        const double t = first_negative(f, {l, r, 0, 0});
        if (t != never) return t;
        l = r;
      }
    }
    return never;
  }

 private:
  using Expansion = TurningExpansion<Degree, Harmonics>;

  /// How many radians are looked at before f is written about another epoch, and strides are tried again: costs of
  /// either are small beside those of as many models.
  static constexpr int strides_of_expansion = 16;
  /// How often a stretch is halved before signs take over.
  static constexpr int most_halvings = 6;
  /// Doubles that are looked at one by one.
  static constexpr std::uint64_t few_doubles = 4;

  /// side * f > 0 just after l, and has not been looked at up to r.
  struct Stretch {
    double l, r;
    int halvings;
    int precision;  ///< 0: doubles; 1: double-doubles; 2: 160 bits; 2 + n: 160 2^n bits, and all derivatives
  };

  static double stop_after(double l, double step, double horizon) {
    return std::min(std::max(l + step, next_up(l)), horizon);
  }

  /// How far from l the part that does not turn certainly outweighs the others.
  double skipped(const Expansion& f, double l, double horizon) const {
    double step = horizon - l;
    while (l < horizon && step * rate_ > 2) {
      const double r = stop_after(l, step, horizon);
      const double m = middle(l, r);
      if (f.outweighs(m, radius(l, m, r))) {
        l = r;
      } else {
        step *= 0.25;
      }
    }
    return l;
  }

  static double middle(double l, double r) { return l + (0.5 * r - 0.5 * l); }
  /// At least the distance of l and r from m.
  static double radius(double l, double m, double r) { return next_up(std::max(m - l, r - m)); }

  double first_negative(const Expansion& f, const Stretch& s) const {
    if (lattice_distance(s.l, s.r) <= few_doubles) return first_negative_of_few(s);
    const double m = middle(s.l, s.r);
    const double rho = radius(s.l, m, s.r);
    if (!(rho * rate_ <= 0.75)) return first_negative_of_halves(f, s);
    if (s.precision == 0) {
      ++turning_search_counters.expansions;
      return first_negative(f, s, f.about(m, rho), m, rho);
    }
    int exponent = 0;
    std::frexp(rho, &exponent);
    const double unit = std::ldexp(1.0, exponent);
    if (!(unit * rate_ <= 1)) return first_negative_of_halves(f, s);
    if (s.precision == 1) {
      ++turning_search_counters.extended;
      return first_negative(f, s, model<Ball<DoubleDouble>, usual_order<Certificate>>(m, exponent), m, unit);
    }
    ++turning_search_counters.enclosed;
    if (s.precision == 2) {
      return first_negative(f, s, model<Exact, usual_order<Certificate>>(m, exponent, 160), m, unit);
    }
    const int bits = 160 << (s.precision - 2);
    return first_negative(f, s, model<Exact, whole_order<Certificate>>(m, exponent, bits), m, unit);
  }

  template <class Number, int Order>
  TaylorModel<Order> model(double m, int exponent, int bits = 0) const {
    return precise_turning_model<Number, Order>(certificate_, side_, m, exponent, bits);
  }

  double first_negative_of_few(const Stretch& s) const {
    for (double t = next_up(s.l); t <= s.r; t = next_up(t)) {
      if (crossing_.sign(t) < 0) return t;
    }
    return never;
  }

  double first_negative_of_halves(const Expansion& f, const Stretch& s) const {
    const double m = middle(s.l, s.r);
    const double t = first_negative(f, {s.l, m, s.halvings + 1, s.precision});
    return t != never ? t : first_negative(f, {m, s.r, s.halvings + 1, s.precision});
  }

  /// The model holds f at the times m + rho x.
  template <class Model>
  double first_negative(const Expansion& f, const Stretch& s, const Model& model, double m, double rho) const {
    if (model.certain_sign(0) > 0) return never;
    if (const int slope = model.certain_sign(1)) return slope > 0 ? never : fall(s, model, m, rho);
    if (const int bend = model.certain_sign(2)) {
      return bend < 0 ? fall(s, model, m, rho) : first_negative_of_convex(s, model, m, rho);
    }
    if (s.halvings >= most_halvings) {
      for (int top = 3; top <= Model::order; ++top) {
        if (model.certain_sign(top) != 0) return by_signs(s, top, model, m, rho);
      }
    }
    if (model.blurred()) return first_negative(f, {s.l, s.r, s.halvings, s.precision + 1});
    return first_negative_of_halves(f, s);
  }

  /// f falls, or is concave, from l, where it is not negative, to r: so it changes its sign once, or not at all.
  template <class Model>
  double fall(const Stretch& s, const Model& model, double m, double rho) const {
    if (certain_sign(model.derivative(0, (s.r - m) / rho)) > 0) return never;
    return crossing_.sign(s.r) > 0 ? never : change(s, model, m, rho);
  }

  /// f changes its sign once, and is negative just after r.
  template <class Model>
  double change(const Stretch& s, const Model& model, double m, double rho) const {
    const double guess = root(model, 0, s.l, s.r, m, rho);
    if (s.precision < 2) {  // else the model has another factor than f
      const Ball<double> slope = model.derivative(1, (guess - m) / rho);
      const double radius = std::min(guess - s.l, s.r - guess);
      const double t = crossing_.next_to_root(guess, {slope.middle / rho, slope.radius / rho * (1 + 0x1p-40)},
                                              model.size(2) / rho / rho * (1 + 0x1p-40), radius);
      if (t > s.l && t <= s.r) return t;
    }
    return crossing_(0, s.l, s.r, -1, guess);
  }

  /// f'' > 0. With an x where the polynomial's slope is nearly zero, f is not below its tangent there. If that does not
  /// tell, f is computed there in double-doubles: if it is negative, f falls to there through one root; if it exceeds
  /// slope^2 / (2 f''), the most that it can fall yet, there is none; and else signs tell.
  template <class Model>
  double first_negative_of_convex(const Stretch& s, const Model& model, double m, double rho) const {
    const double from = (s.l - m) / rho;
    const double to = (s.r - m) / rho;
    double x = 0;
    for (int i = 0; i < 8; ++i) {
      const double next = std::clamp(x - model.derivative(1, x).middle / model.derivative(2, x).middle, from, to);
      const bool near = std::abs(next - x) < 0x1p-30;
      x = next;
      if (near) break;
    }
    const Ball<double> least = model.derivative(0, x);
    const Ball<double> slope = model.derivative(1, x);
    const bool at_end = (x == from && slope.middle >= 0) || (x == to && slope.middle <= 0);
    const double tilt = at_end ? 0 : std::abs(slope.middle);
    if (least.middle > (least.radius + 2 * (tilt + slope.radius)) * Ball<double>::slack) return never;

    const double t = std::clamp(m + rho * x, next_up(s.l), s.r);
    const Ball<DoubleDouble> value = crossing_.value(t);
    int sign = certain_sign(value);
    if (sign == 0 && certain_sign(least) < 0) sign = crossing_.sign(t);
    if (sign < 0) return change({s.l, t, s.halvings, s.precision}, model, m, rho);
    if (sign > 0 && s.precision < 2) {  // else the model has another factor than f
      const Ball<double> slope_there = model.derivative(1, (t - m) / rho);
      const double steepness = std::abs(slope_there.middle) + slope_there.radius;
      const double fall = steepness * steepness / (2 * model.least_size(2));
      if (value.middle.high > (value.radius + fall) * (1 + 0x1p-30)) return never;
    }
    return by_signs(s, 2, model, m, rho);
  }

  template <class Model>
  double by_signs(const Stretch& s, int top, const Model& model, double m, double rho) const {
    return first_negative_by_signs(crossing_, s.l, s.r, top, [&](int order, double from, double to) {
      return root(model, order, from, to, m, rho);
    });
  }

  /// A time from l to r at which the polynomial's derivative number `order` is zero, to a few roundings, where it
  /// changes its sign once: Newton's method and bisection.
  template <class Model>
  static double root(const Model& model, int order, double l, double r, double m, double rho) {
    double from = (l - m) / rho;
    double to = (r - m) / rho;
    const bool rising = model.derivative(order, to).middle > model.derivative(order, from).middle;
    double x = 0.5 * (from + to);
    for (int i = 0; i < 60; ++i) {
      const double value = model.derivative(order, x).middle;
      ((value > 0) == rising ? to : from) = x;
      double next = x - value / model.derivative(order + 1, x).middle;
      if (!(next >= from && next <= to)) next = 0.5 * (from + to);
      if (std::abs(next - x) <= 0x1p-52) return m + rho * next;
      x = next;
    }
    return m + rho * x;
  }

  const Certificate& certificate_;
  int side_;
  TurningCrossing<Certificate> crossing_;
  std::array<Spin, 2> spins_;
  double rate_;  ///< of both spins together, rad/s: of the fastest of the harmonics
};

}  // namespace kds::detail
