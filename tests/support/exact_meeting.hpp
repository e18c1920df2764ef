// How two balls or boxes lie to each other, on straight paths or parabolas, and when they come to: in rational numbers,
// or roughly in doubles.
#pragma once

#include "tests/support/exact_oracle.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
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

/// A quantity and its derivatives: what it and each of them is just after a time is told by the first that is not zero.
template <class Number, std::size_t count>
int sign_of(const std::array<Number, count>& derivatives, std::size_t first = 0) {
  const Number zero(0);
  for (std::size_t i = first; i < count; ++i) {
    if (derivatives[i] != zero) return derivatives[i] < zero ? -1 : 1;
  }
  return 0;
}

/// How two shapes lie to each other just after a time.
struct Lie {
  bool penetrate;
  bool nearing;  ///< their signed distance falls
};

/// The centre of b from that of a, c[0] + c[1] t + c[2] t^2, and what is between the shapes.
template <class Number>
struct Between {
  std::array<Three<Number>, 3> c;
  Three<Number> half_widths{};  ///< of boxes
  Number radius{};              ///< of balls
  bool boxes = false;           ///< at least one box
  bool balls = false;           ///< at least one ball

  Between(const Shape& a, const Shape& b) {
    for (const Shape* shape : {&a, &b}) {
      if (const auto* ball = std::get_if<Sphere>(shape)) {
        radius = radius + number(ball->radius, radius);
        balls = true;
      } else {
        const Box& box = std::get<Box>(*shape);
        for (std::size_t i = 0; i < 3; ++i) half_widths[i] = half_widths[i] + number(box.half_extents[i], radius);
        boxes = true;
      }
    }
  }

  void move(const Piece& a, const Piece& b) {
    c = {};
    add(b, Number(1));
    add(a, Number(-1));
  }

  /// Whether the one sees the other move straight on: then their signed distance is a convex function of time.
  bool straight() const { return c[2] == Three<Number>{}; }

  Three<Number> at(const Number& t) const {
    Three<Number> here;
    for (std::size_t i = 0; i < 3; ++i) here[i] = c[0][i] + (c[1][i] + c[2][i] * t) * t;
    return here;
  }

  Lie just_after(const Number& t) const {
    const auto paths = derivatives(t);
    if (!boxes) {
      const auto excess = excess_of(paths, {true, true, true});
      return {sign_of(excess) < 0, sign_of(excess, 1) < 0};
    }
    Three<Derivatives> gaps;
    std::array<bool, 3> beyond{};
    for (std::size_t i = 0; i < 3; ++i) {
      gaps[i] = paths[i];
      if (sign_of(paths[i]) < 0) {
        for (Number& x : gaps[i]) x = -x;
      }
      gaps[i][0] = gaps[i][0] - half_widths[i];
      beyond[i] = sign_of(gaps[i]) > 0;
    }
    if (balls && (beyond[0] || beyond[1] || beyond[2])) {  // the distance of the ball's centre from the box
      const auto excess = excess_of(gaps, beyond);
      return {sign_of(excess) < 0, sign_of(excess, 1) < 0};
    }
    const Derivatives& widest = *std::max_element(gaps.begin(), gaps.end());
    return {balls || sign_of(widest) < 0, sign_of(widest, 1) < 0};
  }
  Lie just_after(double t) const requires(!std::is_same_v<Number, double>) { return just_after(rational(t)); }

  /// Whether they are in each other by no more than this at t.
  bool no_deeper(const Number& t, const Number& depth) const {
    const Three<Number> here = at(t);
    const Number zero(0), least = radius - depth;
    if (!boxes) return least < zero || !(dot(here, here) < least * least);
    Number square(0), widest = magnitude(here[0]) - half_widths[0];
    for (std::size_t i = 0; i < 3; ++i) {
      const Number gap = magnitude(here[i]) - half_widths[i];
      widest = std::max(widest, gap);
      if (zero < gap) square = square + gap * gap;
    }
    return zero < square ? least < zero || !(square < least * least) : !(widest < least);
  }

 private:
  using Derivatives = std::array<Number, 3>;

  void add(const Piece& path, const Number& sign) {
    const Number start = number(path.start, radius);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto of = [&](std::size_t k) {
        return k < path.coefficients.size() ? sign * number(path.coefficients[k][i], radius) : Number(0);
      };
      c[0][i] = c[0][i] + of(0) + (of(2) * start - of(1)) * start;
      c[1][i] = c[1][i] + of(1) - (of(2) + of(2)) * start;
      c[2][i] = c[2][i] + of(2);
    }
  }

  Three<Derivatives> derivatives(const Number& t) const {
    const Three<Number> here = at(t);
    Three<Derivatives> result;
    for (std::size_t i = 0; i < 3; ++i) {
      const Number twice = c[2][i] + c[2][i];
      result[i] = {here[i], c[1][i] + twice * t, twice};
    }
    return result;
  }

  /// Sum of the squares of some, less that of the radius, with four derivatives, each up to a positive factor.
  std::array<Number, 5> excess_of(const Three<Derivatives>& e, const std::array<bool, 3>& some) const {
    std::array<Number, 5> f{};
    f[0] = f[0] - radius * radius;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!some[i]) continue;
      const auto& [x, v, a] = e[i];
      f[0] = f[0] + x * x;
      f[1] = f[1] + x * v;
      f[2] = f[2] + v * v + x * a;
      f[3] = f[3] + v * a;
      f[4] = f[4] + a * a;
    }
    return f;
  }
};

/// The first double in [from, until] just after which the shapes penetrate and come nearer; `never` if there is none.
double first_meeting(const Between<Rational>& exact, const Between<double>& rough, double from, double until);

/// The first double in [from, until] just after which they do not penetrate; `never` if there is none.
double first_apart(const Between<Rational>& exact, double from, double until);

/// The first double in [from, until] just after which a ball of this radius on a path is beyond limit along an axis, or
/// along it backwards (`out` = -1), and goes on; `never` if there is none.
double first_beyond(const Piece& path, std::size_t axis, double out, double limit, double radius, double from,
                    double until);

/// Whether two that penetrate at a time are never in each other by more than this before they are apart again. Of paths
/// that are not straight this is asked at some times until then (of the next second, if they stay in each other): a
/// piece of a polynomial of degree 4 that is small at them is nowhere much greater.
bool only_graze(const Between<Rational>& exact, const Between<double>& rough, double t, const Rational& depth);

}  // namespace oracle::meeting
