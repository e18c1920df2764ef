// Two double-doubles at a time.
#pragma once

#include "kds/arithmetic/double_double.hpp"
#include "kds/simd/two_doubles.hpp"

namespace kds {

/// A double-double in each lane.
struct TwoDoubleDoubles {
  Two high, low;
};

inline TwoDoubleDoubles two_sum(Two a, Two b) {
  const Two sum = a + b;
  return {sum, detail::sum_error(a, b, sum)};
}

inline TwoDoubleDoubles two_product(Two a, Two b) {
  const Two product = a * b;
  return {product, detail::product_error(a, b, product)};
}

}  // namespace kds
