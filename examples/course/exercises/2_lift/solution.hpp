// Solution of exercise 2: three numbers, and the polynomial that they stand for.
#pragma once

#include "kds/motion.hpp"

namespace kds::exercises {

/// A lift that starts gently from a height: an element whose motion is of degree 3.
struct Lift {
  static constexpr int degree = 3;  // of its motion as a polynomial
  double height = 0;
  double push = 0;
  double start = 0;

  Motion<3> motion() const { return {{{height, 0, 0, push}}, start}; }
  bool finite() const { return is_finite(motion()); }
};

template <class Number>
Polynomial<3, Number> difference_about(const Lift& upper, const Lift& lower, double epoch) {
  return difference_about<Number>(upper.motion(), lower.motion(), epoch);
}

}  // namespace kds::exercises
