// Exact numbers of the library against rationals of the oracle.
#pragma once

#include "kds/arithmetic/exact.hpp"
#include "tests/support/exact_rational.hpp"

namespace oracle {

/// Whether the two are the same: double by double they are taken apart, and must come to nothing together.
inline bool same(kds::Exact a, Rational b) {
  for (int i = 0; i < 1000; ++i) {
    if (a.sign() != b.sign()) return false;
    const double part = a.approximate();
    if (part == 0) return true;  // zero, or equal down to the least double
    a = a - kds::Exact(part);
    b = b - rational(part);
  }
  return false;
}

}  // namespace oracle
