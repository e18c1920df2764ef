// How two balls or boxes on straight paths lie to each other, and since when: in rational numbers, or roughly in
// doubles.
#pragma once

#include "tests/support/exact_oracle.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <variant>

namespace oracle::meeting {

inline constexpr double never = std::numeric_limits<double>::infinity();

inline double number(double value, double) { return value; }
inline Rational number(double value, const Rational&) { return rational(value); }
inline double magnitude(double x) { return std::abs(x); }
inline Rational magnitude(const Rational& x) { return abs(x); }

template <class Number>
using Three = std::array<Number, 3>;

template <class Number>
Number dot(const Three<Number>& a, const Three<Number>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Vector exact(const std::array<double, 3>& v) { return {rational(v[0]), rational(v[1]), rational(v[2])}; }

/// The doubles in their order, numbered.
inline std::int64_t place(double t) {
  const auto bits = std::bit_cast<std::int64_t>(t + 0.0);
  return bits >= 0 ? bits : std::numeric_limits<std::int64_t>::min() - bits;
}
inline double at_place(std::int64_t place) {
  return std::bit_cast<double>(place >= 0 ? place : std::numeric_limits<std::int64_t>::min() - place);
}
inline double before(double t) { return at_place(place(t) - 1); }

/// From |x| to the next double, or a little more.
inline double spacing(double x) { return at_place(place(std::abs(x)) + 1) - std::abs(x); }

/// The first double in [from, until] at which something holds that, once it holds, holds from then on; `never` if there
/// is none. `roughly` may be wrong, and costs time then.
template <class Holds, class Roughly>
double first_double(double from, double until, const Holds& holds, const Roughly& roughly) {
  if (holds(from)) return from;
  if (!holds(until)) return never;
  double low = from, high = until;
  for (int i = 0; i < 80; ++i) {
    const double middle = low + (high - low) / 2;
    (roughly(middle) ? high : low) = middle;
  }
  // Holds at `yes`, not at `no`: nearer from the guess, in steps that grow.
  std::int64_t no = place(from), yes = place(until);
  const std::int64_t guess = std::clamp(place(high), no + 1, yes);
  const bool from_above = guess == yes || holds(at_place(guess));
  (from_above ? yes : no) = guess;
  for (std::int64_t step = 1; yes - no > 1;) {
    const std::int64_t half = (yes - no) / 2;
    const std::int64_t move = std::min(step, half);
    step = 2 * move;
    const std::int64_t next = from_above ? yes - move : no + move;
    (holds(at_place(next)) ? yes : no) = next;
  }
  return at_place(yes);
}

// --- two shapes

/// How two shapes lie to each other just after a time. For paths that are straight, their signed distance is a convex
/// function of time.
struct Lie {
  bool penetrate;
  bool nearing;  ///< their signed distance falls
};

template <class Number>
struct Side {
  Number gap;   ///< along an axis
  Number rate;  ///< of the gap, just after
  bool operator<(const Side& other) const { return gap != other.gap ? gap < other.gap : rate < other.rate; }
};

template <class Number>
Three<Side<Number>> sides(const Three<Number>& r, const Three<Number>& v, const Three<Number>& reach) {
  Three<Side<Number>> result;
  for (std::size_t i = 0; i < 3; ++i) {
    const bool turned = r[i] != Number(0) ? r[i] < Number(0) : v[i] < Number(0);
    result[i] = {magnitude(r[i]) - reach[i], turned ? Number(-v[i]) : v[i]};
  }
  return result;
}

/// The centre of b from that of a, r + v t, and what is between the shapes.
template <class Number>
struct Between {
  Three<Number> r, v;
  Three<Number> reach{};  ///< of boxes
  Number radius{};        ///< of balls
  bool boxes = true;      ///< at least one box
  bool balls = true;      ///< at least one ball

  Between(const Shape& a, const Shape& b) : boxes(false), balls(false) {
    for (const Shape* shape : {&a, &b}) {
      if (const auto* ball = std::get_if<Sphere>(shape)) {
        radius = radius + number(ball->radius, radius);
        balls = true;
      } else {
        const Box& box = std::get<Box>(*shape);
        for (std::size_t i = 0; i < 3; ++i) reach[i] = reach[i] + number(box.half_extents[i], radius);
        boxes = true;
      }
    }
  }

  void move(const Piece& a, const Piece& b) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto at_zero = [&](const Piece& path) {
        return number(path.coefficients[0][i], radius) -
               number(path.coefficients[1][i], radius) * number(path.start, radius);
      };
      r[i] = at_zero(b) - at_zero(a);
      v[i] = number(b.coefficients[1][i], radius) - number(a.coefficients[1][i], radius);
    }
  }

  Three<Number> at(double t) const {
    const Number time = number(t, radius);
    return {r[0] + v[0] * time, r[1] + v[1] * time, r[2] + v[2] * time};
  }

  Lie just_after(double t) const {
    const Three<Number> here = at(t);
    const Number zero(0);
    if (!boxes) {
      const Number excess = dot(here, here) - radius * radius;
      const bool nearing = dot(here, v) < zero;
      return {excess < zero || (excess == zero && nearing), nearing};
    }
    const auto gaps = sides(here, v, reach);
    const auto& widest = *std::max_element(gaps.begin(), gaps.end());
    const bool open = zero < widest.gap || (widest.gap == zero && !(widest.rate < zero));
    if (!balls) return {!open, widest.rate < zero};
    // A ball and a box: the distance of the ball's centre from the box, if it is beyond it.
    Number square = zero, rate = zero;
    bool beyond = false;
    for (const auto& [gap, gap_rate] : gaps) {
      if (gap < zero || (gap == zero && !(zero < gap_rate))) continue;
      beyond = true;
      square = square + gap * gap;
      rate = rate + gap * gap_rate;
    }
    if (!beyond) return {true, widest.rate < zero};
    const Number excess = square - radius * radius;
    return {excess < zero || (excess == zero && rate < zero), rate < zero};
  }

  /// Whether they are in each other by no more than this at t.
  bool no_deeper(double t, const Number& depth) const {
    const Three<Number> here = at(t);
    const Number least = radius - depth;
    if (!boxes) return !(dot(here, here) < least * least) || least < Number(0);
    const auto gaps = sides(here, v, reach);
    Number square(0);
    for (const auto& side : gaps) {
      if (Number(0) < side.gap) square = square + side.gap * side.gap;
    }
    if (Number(0) < square) return least < Number(0) || !(square < least * least);
    return !(std::max_element(gaps.begin(), gaps.end())->gap < least);
  }
};

}  // namespace oracle::meeting
