// Exercise 1: a certificate. A dog and its owner move on parabolas in the plane, joined by a leash. The leash holds as
// long as their distance is not greater than its length. Write that fact as a polynomial of time.
#pragma once

#include "certificates/plane_motion.hpp"
#include "kds/certificate.hpp"

namespace kds::exercises {

using Path = certificates::PlaneMotion<2>;

/// A dog is not farther from its owner than the leash is long.
struct Leash {
  static constexpr int degree = 4;  // of f as a polynomial of time
  const Path& dog;
  const Path& owner;
  double length;

  /// f in the time since `epoch`, in any number type: f(t) >= 0 while the leash holds. A distance is a square root, and
  /// that is no polynomial; what can be compared instead? You need path.axis(0) and path.axis(1), the x and y of a path
  /// as motions; difference_about<Number>(a, b, epoch) of two motions; constant<Number>(value); and +, -, *, square().
  template <class Number>
  Polynomial<degree, Number> polynomial(double /*epoch*/) const {
    return Polynomial<degree, Number>() + constant<Number>(1);  // holds for ever: to be replaced
  }
};

}  // namespace kds::exercises
