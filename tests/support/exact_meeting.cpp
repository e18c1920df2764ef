#include "tests/support/exact_meeting.hpp"

#include "tests/support/exact_algebra.hpp"

#include <optional>
#include <vector>

namespace oracle::meeting {
namespace {

/// s; whoever is not deeper in another one by then, on a straight path, never is.
constexpr double ages = 0x1p40;

Polynomial coordinate(const Between<Rational>& exact, std::size_t i) {
  return {std::vector<Rational>{exact.c[0][i], exact.c[1][i], exact.c[2][i]}};
}

/// At roots of these alone the shapes may come to penetrate, or cease to.
std::vector<Polynomial> changes_of_penetration(const Between<Rational>& exact) {
  const std::array path{coordinate(exact, 0), coordinate(exact, 1), coordinate(exact, 2)};
  const Polynomial square_of_radius(square(exact.radius));
  if (!exact.boxes) return {path[0] * path[0] + path[1] * path[1] + path[2] * path[2] - square_of_radius};
  std::vector<Polynomial> result;
  std::array<std::array<Polynomial, 3>, 3> squares;  // of the gap along an axis: none, above, below
  for (std::size_t i = 0; i < 3; ++i) {
    const Polynomial above = path[i] - Polynomial(exact.half_widths[i]);
    const Polynomial below = path[i] + Polynomial(exact.half_widths[i]);
    result.push_back(above);
    result.push_back(below);
    squares[i] = {Polynomial(), above * above, below * below};
  }
  for (std::size_t k = 1; exact.balls && k < 27; ++k) {
    result.push_back(squares[0][k % 3] + squares[1][k / 3 % 3] + squares[2][k / 9] - square_of_radius);
  }
  return result;
}

/// And at roots of these, besides, to come nearer.
std::vector<Polynomial> changes_of_nearing(const Between<Rational>& exact) {
  std::vector<Polynomial> result = changes_of_penetration(exact);
  const std::size_t gaps = result.size();
  const std::array path{coordinate(exact, 0), coordinate(exact, 1), coordinate(exact, 2)};
  for (std::size_t k = 0; k < gaps; ++k) result.push_back(result[k].derivative());
  for (std::size_t i = 0; exact.boxes && i < 3; ++i) {
    result.push_back(path[i]);
    const std::size_t j = (i + 1) % 3;  // of which the wider gap changes
    const Polynomial widest(exact.half_widths[i] - exact.half_widths[j]);
    for (const Polynomial& other : {path[i] - path[j], path[i] + path[j]}) {
      result.push_back(other - widest);
      result.push_back(other + widest);
    }
  }
  return result;
}

struct Doubles {
  double begin, end;  ///< the last is the first after it
};

/// The stretches of doubles just after which something holds; those that hold at none are left out.
template <class Holds>
std::vector<Doubles> when(const std::vector<Polynomial>& changes, double from, double until, const Holds& holds) {
  std::vector<Doubles> result;
  for (const Stretch& stretch : stretches({changes, holds}, rational(from), rational(until))) {
    const Doubles doubles{stretch.at_start ? from : stretch.begin.ceiling(),
                          stretch.end ? stretch.end->ceiling() : never};
    if (doubles.begin < doubles.end && doubles.begin <= until) result.push_back(doubles);
  }
  return result;
}

std::vector<Doubles> penetrations(const Between<Rational>& exact, double from, double until) {
  return when(changes_of_penetration(exact), from, until,
              [&](const Rational& t) { return exact.just_after(t).penetrate; });
}

/// Whether their bounding balls meet in all that time, which few do.
bool come_near(const Between<Rational>& exact, double from, double until) {
  Rational farthest = exact.radius;
  for (const Rational& half : exact.half_widths) farthest += half;
  Polynomial room(-square(farthest));
  for (std::size_t i = 0; i < 3; ++i) room = room + coordinate(exact, i) * coordinate(exact, i);
  return first_negative(room, rational(from), rational(until)).has_value();
}

double first_straight_meeting(const Between<Rational>& exact, const Between<double>& rough, double from, double until) {
  // The signed distance is convex in time. So where it falls it does so until it never does again, and while it falls
  // they come to penetrate once.
  const auto decided = [](const Lie& lie) { return lie.penetrate || !lie.nearing; };
  const double t = first_double(
      from, until, [&](double time) { return decided(exact.just_after(time)); },
      [&](double time) { return decided(rough.just_after(time)); });
  return t != never && exact.just_after(t).nearing ? t : never;
}

}  // namespace

double first_meeting(const Between<Rational>& exact, const Between<double>& rough, double from, double until) {
  if (exact.straight()) return first_straight_meeting(exact, rough, from, until);
  if (!come_near(exact, from, until)) return never;
  for (const auto& [begin, end] : penetrations(exact, from, until)) {
    if (exact.just_after(begin).nearing) return begin;
    // By a rounding, while they part: they may turn before they have.
    const auto meetings = when(changes_of_nearing(exact), begin, std::min(until, before(end)), [&](const Rational& t) {
      const Lie lie = exact.just_after(t);
      return lie.penetrate && lie.nearing;
    });
    if (!meetings.empty()) return meetings.front().begin;
  }
  return never;
}

double first_apart(const Between<Rational>& exact, double from, double until) {
  if (!exact.just_after(from).penetrate) return from;
  if (exact.straight()) {
    const auto apart = [&](double t) { return !exact.just_after(t).penetrate; };
    return first_double(from, until, apart, apart);
  }
  const auto found = penetrations(exact, from, until);
  double t = from;
  for (const auto& [begin, end] : found) {
    if (begin > t) break;
    t = end;
  }
  return t <= until ? t : never;
}

double first_beyond(const Piece& path, std::size_t axis, double out, double limit, double radius, double from,
                    double until) {
  std::vector<double> coordinate;
  for (const auto& c : path.coefficients) coordinate.push_back(out * c[axis]);
  const Polynomial room =
      Polynomial(rational(out * limit) - rational(radius)) - Polynomial::motion(coordinate, path.start);
  if (room.degree() < 1) return never;
  if (room.degree() == 1) {
    if (!(room.coefficients()[1] < 0)) return never;
    const auto beyond = [&](double t) { return room(rational(t)) <= 0; };
    const double guess = approximate(-room.coefficients()[0] / room.coefficients()[1]);
    return first_double(from, until, beyond, [&](double t) { return t >= guess; });
  }
  const Polynomial rate = room.derivative();
  const auto found = when({room, rate}, from, until, [&](const Rational& t) { return room(t) < 0 && rate(t) < 0; });
  return found.empty() ? never : found.front().begin;
}

bool only_graze(const Between<Rational>& exact, const Between<double>& rough, double t, const Rational& depth) {
  if (exact.straight()) {
    const double deepest = first_double(
        t, ages, [&](double time) { return !exact.just_after(time).nearing; },
        [&](double time) { return !rough.just_after(time).nearing; });
    return exact.no_deeper(rational(std::min(deepest, ages)), depth);
  }
  constexpr int times = 16;
  const double look_ahead = std::min(first_apart(exact, t, t + 1), t + 1);
  const Rational step = (rational(look_ahead) - rational(t)) / times;
  for (int i = 0; i <= times; ++i) {
    if (!exact.no_deeper(rational(t) + step * i, depth)) return false;
  }
  return true;
}

}  // namespace oracle::meeting
