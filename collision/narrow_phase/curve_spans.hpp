// When polynomials of the time of degree 3 and above are negative: by exact signs.
#pragma once

#include "certificates/features/positive_stretch.hpp"
#include "collision/narrow_phase/time_spans.hpp"
#include "kds/certificate.hpp"
#include "kds/motion.hpp"
#include "kds/polynomial.hpp"
#include "kds/roots/failure_time.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

namespace kds::collision {

/// As TimeSpans, with up to `Most` stretches: as many as those on which a polynomial of degree 2 Most - 1 may be
/// negative.
template <std::size_t Most>
struct CurveSpans {
  static constexpr double infinity = TimeSpans::infinity;

  std::array<double, Most> begin;
  std::array<double, Most> end;
  std::size_t size = 0;

  bool empty() const { return size == 0; }

  /// The first time >= tau inside, or infinity.
  double first_inside(double tau) const {
    for (std::size_t i = 0; i < size; ++i) {
      if (tau < end[i]) return std::max(tau, begin[i]);
    }
    return infinity;
  }
  bool contains(double tau) const { return first_inside(tau) == tau; }

  /// Where the stretch that contains tau begins and ends. Precondition: contains(tau).
  double enter(double tau) const { return begin[at(tau)]; }
  double leave(double tau) const { return end[at(tau)]; }

 private:
  std::size_t at(double tau) const {
    std::size_t i = 0;
    while (!(tau < end[i])) ++i;
    return i;
  }
};

/// The times at which a motion may be near something: by closed forms for straight and quadratic motions, exactly for
/// others.
template <int Degree>
using SpansOf = std::conditional_t<(Degree <= 2), TimeSpans, CurveSpans<std::size_t{Degree} + 1>>;

/// When a certificate is broken, from tau = 0 to the horizon: from each first double just after which it is negative to
/// the next just after which it is positive. A stretch that contains 0 begins at -infinity, one that contains the
/// horizon ends at infinity. It is an exact function of the polynomial: the only errors are those of its coefficients.
template <std::size_t Most, Certificate C>
CurveSpans<Most> broken_spans(const C& certificate, double horizon) {
  static_assert(C::degree < static_cast<int>(2 * Most));
  CurveSpans<Most> spans;
  double t = failure_time(certificate, 0.0, horizon);
  while (t != never) {
    spans.begin[spans.size] = t > 0 ? t : -TimeSpans::infinity;
    t = recovery_time(certificate, t, horizon);
    spans.end[spans.size++] = t;
    if (t != never) t = failure_time(certificate, t, horizon);
  }
  return spans;
}

/// |s(tau)|^2 >= g(tau)^2: a point on a path is no nearer to the origin than a radius that grows. About tau = 0.
template <int PathDegree>
struct FarCurve {
  static constexpr int degree = 2 * PathDegree;
  using Coordinate = kds::Motion<PathDegree>;

  FarCurve(const std::array<Eigen::Vector3d, std::size_t{PathDegree} + 1>& path,
           const std::array<double, std::size_t{PathDegree} + 1>& growing_radius) {
    for (std::size_t i = 0; i <= PathDegree; ++i) {
      for (std::size_t d = 0; d < 3; ++d) s[d].position.c[i] = path[i][static_cast<Eigen::Index>(d)];
      radius.position.c[i] = growing_radius[i];
    }
  }

  std::array<Coordinate, 3> s;
  Coordinate radius;

  template <class Number>
  Polynomial<degree, Number> polynomial(double epoch) const {
    return square(about<Number>(s[0], epoch)) + square(about<Number>(s[1], epoch)) +
           square(about<Number>(s[2], epoch)) - square(about<Number>(radius, epoch));
  }

  Ball<DoubleDouble> extended_value(double t) const {
    const auto value = [t](const Coordinate& x) { return compensated_value(x.position, DoubleDouble(t)); };
    const Ball<DoubleDouble> g = value(radius);
    Ball<DoubleDouble> f = -(g * g);
    for (const Coordinate& x : s) {
      const Ball<DoubleDouble> along = value(x);
      f = f + along * along;
    }
    return f;
  }
};

/// Calls fails(t) and recovers(t) for the times between `from` and `end`, both excluded, at which the sign of f
/// changes, in order, until one returns true: the first doubles just after which it is the other.
template <Certificate C, class Fails, class Recovers>
void each_change(const C& f, double from, double end, const Fails& fails, const Recovers& recovers) {
  for (double t = from;;) {
    t = failure_time(f, t, end);
    if (!(t < end) || (t > from && fails(t))) return;
    t = recovery_time(f, t, end);
    if (!(t < end) || (t > from && recovers(t))) return;
  }
}

template <Certificate C, class Visit>
void each_failure(const C& f, double from, double end, const Visit& visit) {
  each_change(f, from, end, visit, [](double) { return false; });
}

/// The same of the maxima of f: the first doubles just after which f falls.
template <Certificate C, class Visit>
void each_maximum(const C& f, double from, double end, const Visit& visit) {
  each_failure(DerivativeCertificate<C>{f}, from, end, visit);
}

/// Shrinks the window to a part that contains all its times at which c0 + c1 x + c2 x^2 + ... < 0; false if there are
/// none.
///
/// Rounding: with u = 2^-53 and S the sum of |c_i| (end of the window)^i, the coefficients about an end, times powers
/// of the length, take at most 5 n + 8 roundings (see positive_until()) of parts whose magnitudes sum to at most S. The
/// ends of the window are known to u of its size, which moves the polynomial by another 2 n u S. Together that is 43 u
/// S for degrees n up to 5, and less than the 64 u S that the margin of the caller's coefficients allows for.
template <std::size_t Count>
bool clip_to_negative(const std::array<double, Count>& c, TimeWindow& window) {
  constexpr int degree = static_cast<int>(Count) - 1;
  const double length = window.end - window.begin;
  // From one end of the window on, in units of its length.
  const auto free_from = [&](double from, double direction) {
    auto p = taylor_shift<double>(Polynomial<degree>{c}, from);
    double factor = 1;
    for (double& each : p.c) {
      each *= factor;
      factor *= direction * length;
    }
    return certificates::positive_until(p, 0.0, 0.0);
  };
  constexpr double inward = 1 - 0x1p-40;
  const double before = free_from(window.begin, 1);
  if (before >= 1) return false;
  const double after = free_from(window.end, -1);
  const TimeWindow left{window.begin + before * length * inward, window.end - after * length * inward};
  if (left.begin <= left.end) window = left;
  return true;
}

/// Derivative number `order` of a polynomial at tau, in doubles.
template <std::size_t Count>
double derivative_at(const std::array<double, Count>& c, int order, double tau) {
  double sum = 0;
  for (int i = static_cast<int>(Count) - 1; i >= order; --i) {
    double factor = 1;
    for (int k = 0; k < order; ++k) factor *= i - k;
    sum = sum * tau + factor * c[static_cast<std::size_t>(i)];
  }
  return sum;
}

}  // namespace kds::collision
