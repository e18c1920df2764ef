// The square of a number of any type in which certificates are evaluated.
#pragma once

namespace kds::certificates::detail {

/// By the type's own function where it has one, which gives a tighter bound or costs less than a product.
template <class T>
auto squared(const T& x) {
  if constexpr (requires { square(x); }) {
    return square(x);
  } else {
    return x * x;
  }
}

}  // namespace kds::certificates::detail
