// Solution of exercise 1: distances are compared by their squares.
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

  template <class Number>
  Polynomial<degree, Number> polynomial(double epoch) const {
    const auto x = difference_about<Number>(dog.axis(0), owner.axis(0), epoch);
    const auto y = difference_about<Number>(dog.axis(1), owner.axis(1), epoch);
    return constant<Number>(length) * constant<Number>(length) - square(x) - square(y);
  }
};

}  // namespace kds::exercises
