// Several facts at once: the first time at which all of a set of certificates have failed.
#pragma once

#include "kds/roots/failure_time.hpp"

#include <algorithm>
#include <span>

namespace kds::certificates {

/// Whether all certificates are broken (negative) just after t.
template <Certificate... C>
bool all_broken(double t, std::span<const C>... certificates) {
  const auto broken = [t](const auto& certificate) { return sign_after(certificate, t) < 0; };
  return (std::all_of(certificates.begin(), certificates.end(), broken) && ...);
}

/// The first double t in [now, horizon] just after which every certificate of all the spans is broken, or `never`.
/// Preconditions: now is finite; there is a certificate.
///
/// This is how contacts of convex shapes are found: shapes penetrate when no axis separates them any more. While any
/// certificate holds there is no contact; so the search jumps to its failure time and looks again. Each jump passes a
/// root, so there are at most (number of certificates) x (degree) of them. The answer does not depend on the order in
/// which the certificates are looked at.
template <Certificate... C>
double first_all_broken(double now, double horizon, std::span<const C>... certificates) {
  double t = now;
  bool moved = true;
  const auto jump = [&](const auto& certificate) {
    const double failure = failure_time(certificate, t, horizon);  // t itself where it is broken already
    moved = moved || failure != t;
    t = failure;
    return t != never;
  };
  while (moved) {
    moved = false;
    if (!(std::all_of(certificates.begin(), certificates.end(), jump) && ...)) return never;
  }
  return t;
}

/// The first double t in [now, horizon] just after which some certificate holds (is positive), or `never`.
template <Certificate... C>
double first_any_holds(double now, double horizon, std::span<const C>... certificates) {
  double first = never;
  const auto look = [&](const auto& certificate) {
    first = std::min(first, recovery_time(certificate, now, std::min(first, horizon)));
  };
  (std::for_each(certificates.begin(), certificates.end(), look), ...);
  return first;
}

}  // namespace kds::certificates
