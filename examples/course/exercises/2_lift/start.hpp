// Exercise 2: a motion of your own. A lift starts gently: its acceleration grows evenly, so that at t its height is
// height + push (t - start)^3. Make it an element that the sorted list of 03 can sort.
#pragma once

#include "kds/motion.hpp"

namespace kds::exercises {

/// A lift that starts gently from a height: an element whose motion is of degree 3.
struct Lift {
  static constexpr int degree = 3;  // of its motion as a polynomial
  double height = 0;
  double push = 0;
  double start = 0;

  /// To be written. (04 does it for a ball.)
  Motion<3> motion() const { return {}; }
  bool finite() const { return is_finite(motion()); }
};

/// upper - lower in the time since `epoch`. To be written: motions have a function of the same name.
template <class Number>
Polynomial<3, Number> difference_about(const Lift& /*upper*/, const Lift& /*lower*/, double /*epoch*/) {
  return {};
}

}  // namespace kds::exercises
