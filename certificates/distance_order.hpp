// Two pairs of moving points of the plane in order of their distances.
#pragma once

#include "kds/bounded.hpp"
#include "kds/certificate.hpp"
#include "kds/lasting.hpp"
#include "kds/motion.hpp"

namespace kds::certificates {

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
    return apart(c, d, 0) + apart(c, d, 1) - (apart(a, b, 0) + apart(a, b, 1));
  }

  Ball<DoubleDouble> extended_value(double t) const requires(!requires { Path::sampled; }) {
    const auto apart = [&](const Path& p, const Path& q, int axis) {
      const Ball<DoubleDouble> x = extended_difference(q.axis(axis), p.axis(axis), t);
      return x * x;
    };
    return apart(c, d, 0) + apart(c, d, 1) - (apart(a, b, 0) + apart(a, b, 1));
  }

  /// Cheap and sufficient: both pairs are the same.
  bool vanishes() const requires(!requires { Path::sampled; }) { return (a == c && b == d) || (a == d && b == c); }

  bool is_negative_of(const DistanceOrder& other) const {
    return is_same_thing(a, other.c) && is_same_thing(b, other.d) && is_same_thing(c, other.a) &&
           is_same_thing(d, other.b);
  }
};

template <class Path>
DistanceOrder(const Path&, const Path&, const Path&, const Path&) -> DistanceOrder<Path>;

}  // namespace kds::certificates
