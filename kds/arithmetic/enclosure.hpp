// A number that is known up to a radius, both of any length.
#pragma once

#include "kds/arithmetic/exact.hpp"

#include <utility>

namespace kds {

/// The real number meant lies within `radius` of `middle`. Nothing is rounded: a sum of such numbers is off by the sum
/// of the radii, a product by |a| s + |b| r + r s. For numbers that are not dyadic, such as roots and sines, to any
/// number of digits.
struct Enclosure {
  Exact middle;
  Exact radius;  ///< >= 0

  Enclosure() = default;
  Enclosure(Exact exact)
      : middle(std::move(exact)) {}  // NOLINT(google-explicit-constructor): an exact number encloses itself
  Enclosure(Exact m, Exact r) : middle(std::move(m)), radius(std::move(r)) {}

  friend Enclosure operator-(const Enclosure& a) { return {-a.middle, a.radius}; }
  friend Enclosure operator+(const Enclosure& a, const Enclosure& b) {
    return {a.middle + b.middle, a.radius + b.radius};
  }
  friend Enclosure operator*(const Enclosure& a, const Enclosure& b) {
    return {a.middle * b.middle, absolute(a.middle) * b.radius + absolute(b.middle) * a.radius + a.radius * b.radius};
  }
};

/// -1 or +1 where zero is excluded, 0 where it is not.
inline int certain_sign(const Enclosure& a) { return (absolute(a.middle) - a.radius).sign() > 0 ? a.middle.sign() : 0; }

/// The square root of a >= 0, up to 2^-bits; exact where it is a multiple of that.
inline Enclosure enclosed_square_root(const Exact& a, int bits) {
  const Exact root = truncated_square_root(a, bits);
  return root * root == a ? Enclosure(root) : Enclosure(root, scaled(Exact(1.0), -bits));
}

}  // namespace kds
