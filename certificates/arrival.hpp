// A point on a straight line that has not reached what another has passed over.
#pragma once

#include "certificates/plane_motion.hpp"
#include "kds/certificate.hpp"
#include "kds/lasting.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace kds::certificates {

/// side * f(t) >= 0: the point `end` has not come to the track of another point, which is where that has been since the
/// start of its path. f(t), linear in t, is by `at`:
///
///     line       v x (end(t) - track(t)), v the velocity of the track: on which side of its line the end is
///     tip        track(t) - end(t), on an axis on which the end moves: the two face each other on one line
///     beginning  track(start) - end(t), on that axis: the end follows on the line of the other
///
/// The sign tells only that the end has come to that line, tip or beginning. Whether the track covers that place is for
/// the structure to find out.
struct Arrival {
  static constexpr int degree = 1;
  enum class At : std::uint8_t { line, tip, beginning };  ///< of the track: where the end comes to

  PlaneMotion<1> end, track;
  At at;
  double side;  ///< 1 or -1

  template <class Archive>
  void archive(Archive& archive) {
    archive(end, track, at, side);
  }

  template <class Number>
  Polynomial<1, Number> polynomial(double epoch) const {
    if (at == At::line) {
      const auto apart = [&](int d) { return difference_about<Number>(end.axis(d), track.axis(d), epoch); };
      return (apart(1) * velocity<Number>(track, 0) - apart(0) * velocity<Number>(track, 1)) * side;
    }
    const int d = axis(end);
    if (at == At::tip) return difference_about<Number>(track.axis(d), end.axis(d), epoch) * side;
    return (constant<Number>(track.coordinate[static_cast<std::size_t>(d)].c[0]) - about<Number>(end.axis(d), epoch)) *
           side;
  }

  /// That on which the point moves faster.
  static int axis(const PlaneMotion<1>& path) {
    return std::abs(path.coordinate[0].c[1]) >= std::abs(path.coordinate[1].c[1]) ? 0 : 1;
  }

 private:
  template <class Number>
  static Polynomial<0, Number> velocity(const PlaneMotion<1>& path, std::size_t axis) {
    return constant<Number>(path.coordinate[axis].c[1]);
  }
};

/// The velocity of b is counter-clockwise of that of a: the sign is that of (velocity of a) x (velocity of b).
struct TurnsLeft {
  static constexpr int degree = 0;
  const PlaneMotion<1>& a;
  const PlaneMotion<1>& b;

  TurnsLeft(Lasting<PlaneMotion<1>> first, Lasting<PlaneMotion<1>> second) : a(first), b(second) {}

  template <class Number>
  Polynomial<0, Number> polynomial(double /*epoch*/) const {
    const auto& p = a.coordinate;
    const auto& q = b.coordinate;
    Polynomial<0, Number> result;
    result.c[0] = Number(p[0].c[1]) * Number(q[1].c[1]) - Number(p[1].c[1]) * Number(q[0].c[1]);
    return result;
  }
};

/// Which of two points comes first to where their lines cross: the sign of w x (a - b), w the velocity of a relative to
/// b, times that of TurnsLeft{b, a}, is 1 if b does, -1 if a does, and 0 if both come at one time. It
/// does not depend on time.
struct CrossesFirst {
  static constexpr int degree = 0;
  const PlaneMotion<1>& a;
  const PlaneMotion<1>& b;

  CrossesFirst(Lasting<PlaneMotion<1>> first, Lasting<PlaneMotion<1>> second) : a(first), b(second) {}

  template <class Number>
  Polynomial<0, Number> polynomial(double epoch) const {
    const auto apart = [&](int d) { return difference_about<Number>(a.axis(d), b.axis(d), epoch).c[0]; };
    const auto faster = [&](std::size_t d) { return difference<Number>(a.coordinate[d].c[1], b.coordinate[d].c[1]); };
    Polynomial<0, Number> result;
    result.c[0] = faster(0) * apart(1) - faster(1) * apart(0);
    return result;
  }
};

/// a comes to its track before b does: its sign is 1; 0 at one time. Precondition: both come nearer, so that the slopes
/// of both are negative. It does not depend on time.
struct ArrivesFirst {
  static constexpr int degree = 0;
  const Arrival& a;
  const Arrival& b;

  ArrivesFirst(Lasting<Arrival> first, Lasting<Arrival> second) : a(first), b(second) {}

  template <class Number>
  Polynomial<0, Number> polynomial(double epoch) const {
    const auto f = a.template polynomial<Number>(epoch), g = b.template polynomial<Number>(epoch);
    Polynomial<0, Number> result;
    result.c[0] = f.c[0] * g.c[1] - g.c[0] * f.c[1];
    return result;
  }
};

}  // namespace kds::certificates
