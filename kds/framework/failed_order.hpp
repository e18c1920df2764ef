// Identifies the two elements of an order certificate, so that the certificate of the two exchanged is recognised after
// a swap.
#pragma once

#include "kds/certificate_hooks.hpp"

namespace kds::detail {

/// The two elements and the kind of an antisymmetric certificate; neither if default-constructed.
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
