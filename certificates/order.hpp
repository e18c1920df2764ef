// Two values in order.
#pragma once

#include "kds/certificate.hpp"
#include "kds/motion.hpp"

namespace kds::certificates {

/// lower(t) <= upper(t).
template <int Degree>
struct Order {
  static constexpr int degree = Degree;
  const Motion<Degree>& lower;
  const Motion<Degree>& upper;

  template <class Number>
  Polynomial<Degree, Number> polynomial(double epoch) const {
    return difference_about<Number>(upper, lower, epoch);
  }

  /// Cheap and sufficient: values that move together, and values at rest in one place.
  bool vanishes() const {
    if (lower.position.c[0] != upper.position.c[0]) return false;
    bool at_rest = true;
    for (std::size_t i = 1; i <= Degree; ++i) {
      if (lower.position.c[i] != upper.position.c[i]) return false;
      at_rest = at_rest && lower.position.c[i] == 0;
    }
    return at_rest || lower.start == upper.start;
  }
};

}  // namespace kds::certificates
