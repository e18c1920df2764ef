// A ball inside a half space bounded by a plane across an axis.
#pragma once

#include "kds/certificate.hpp"
#include "kds/motion.hpp"

namespace kds::certificates {

/// side * (plane - x(t)) >= radius: a ball whose centre has coordinate x stays below (side +1) or above (-1) a plane.
template <int Degree>
struct WallSeparation {
  static constexpr int degree = Degree;
  Motion<Degree> coordinate;
  double plane;   ///< length
  double radius;  ///< length
  double side;    ///< +1 or -1

  template <class Number>
  Polynomial<Degree, Number> polynomial(double epoch) const {
    auto f = (constant<Number>(plane) - about<Number>(coordinate, epoch)) * side;
    f.c[0] = f.c[0] - radius;
    return f;
  }
};

}  // namespace kds::certificates
