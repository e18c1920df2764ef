// Signs of turning certificates, and when they change, each found when it is asked for.
#pragma once

#include "kds/turning/turning_certificate.hpp"
#include "kds/turning/turning_failure_time.hpp"

namespace kds::collision {

/// Signs and failure times as they are, each found when it is asked for.
struct ExactSigns {
  template <class C>
  double failure_time(const C& certificate, double t, double until) const {
    return kds::failure_time(certificate, t, until);
  }
  template <class C>
  double recovery_time(const C& certificate, double t, double until) const {
    return kds::recovery_time(certificate, t, until);
  }
  template <class C>
  int sign_after(const C& certificate, double t) const {
    return kds::sign_after(certificate, t);
  }
  template <class C>
  bool vanishes(const C& certificate) const {
    return kds::vanishes(certificate);
  }
};

}  // namespace kds::collision
