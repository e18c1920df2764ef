// Which two an order is about, so that after a swap the order of the two exchanged is recognised.
#pragma once

#include "kds/certificate_hooks.hpp"

namespace kds::detail {

/// What an antisymmetric certificate is about, and which kind it is: none of the two if default-made.
struct Ordered {
  const void* lower = nullptr;
  const void* upper = nullptr;
  const void* kind = nullptr;

  template <Antisymmetric C>
  static Ordered by(const C& certificate) {
    static constexpr char kind = 0;
    return {&certificate.lower, &certificate.upper, &kind};
  }
  Ordered turned() const { return {upper, lower, kind}; }

  friend bool operator==(const Ordered&, const Ordered&) = default;
};

}  // namespace kds::detail
