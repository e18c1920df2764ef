// Two pairs of moving points, of the plane or of space, in order of their distances.
#pragma once

#include "kds/bounded.hpp"
#include "kds/certificate.hpp"
#include "kds/lasting.hpp"
#include "kds/motion.hpp"

namespace kds::certificates {

template <int Degree>
struct PointMotion;

namespace detail {
/// How many coordinates a distance is made of.
template <class Path>
inline constexpr int axes = 2;
template <int Degree>
inline constexpr int axes<PointMotion<Degree>> = 3;
}  // namespace detail

/// |d - c|^2 >= |b - a|^2: a and b are not farther from each other than c and d. Degree 2 for linear, 4 for quadratic
/// paths.
template <class Path>
struct DistanceOrder {
  static constexpr int degree = 2 * Path::degree;
  Held<Path> a;
  Held<Path> b;
  Held<Path> c;
  Held<Path> d;

  DistanceOrder(Lasting<Path> first, Lasting<Path> second, Lasting<Path> third, Lasting<Path> fourth)
      : a(first), b(second), c(third), d(fourth) {}

  template <class Number>
  auto polynomial(double epoch) const {
    const auto apart = [&](const Path& p, const Path& q, int axis) {
      return square(difference_about<Number>(q.axis(axis), p.axis(axis), epoch));
    };
    return compare(apart);
  }

  Ball<DoubleDouble> extended_value(double t) const requires(!requires { Path::sampled; }) {
    const auto apart = [&](const Path& p, const Path& q, int axis) {
      const Ball<DoubleDouble> x = extended_difference(q.axis(axis), p.axis(axis), t);
      return x * x;
    };
    return compare(apart);
  }

  /// Cheap and sufficient: both pairs are the same.
  bool vanishes() const requires(!requires { Path::sampled; }) { return (a == c && b == d) || (a == d && b == c); }

  bool is_negative_of(const DistanceOrder& other) const {
    return is_same_thing(a, other.c) && is_same_thing(b, other.d) && is_same_thing(c, other.a) &&
           is_same_thing(d, other.b);
  }

 private:
  /// apart(p, q, axis): the square of their distance along an axis.
  template <class Apart>
  auto compare(const Apart& apart) const {
    const auto distance = [&](const Path& p, const Path& q) {
      if constexpr (detail::axes<Path> == 3) {
        return apart(p, q, 0) + apart(p, q, 1) + apart(p, q, 2);
      } else {
        return apart(p, q, 0) + apart(p, q, 1);
      }
    };
    return distance(c, d) - distance(a, b);
  }
};

template <class Path>
DistanceOrder(const Path&, const Path&, const Path&, const Path&) -> DistanceOrder<Path>;

}  // namespace kds::certificates
