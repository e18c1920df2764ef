#include "collision/queries/approach.hpp"

#include "certificates/ball_separation.hpp"
#include "collision/vectors.hpp"
#include "kds/roots/failure_time.hpp"

#include <stdexcept>
#include <string>

namespace kds::collision {

using Eigen::Vector3d;

template <int Degree>
Approach closest_approach(const certificates::PointMotion<Degree>& a, const certificates::PointMotion<Degree>& b,
                          double from, double until) {
  if (!(from > -never && from <= until && until < never)) {
    throw std::invalid_argument("closest_approach: from " + std::to_string(from) + " to " + std::to_string(until) +
                                " is no finite stretch of time");
  }
  const auto at = [&](double t) { return Approach{t, norm(Vector3d(b.position(t) - a.position(t)))}; };
  using SquaredDistance = certificates::BallSeparation<Degree>;
  const DerivativeCertificate<SquaredDistance> parting{SquaredDistance{a, b, 0, 0}};

  Approach nearest = at(from);
  for (double t = from; t != never;) {
    t = recovery_time(parting, t, until);
    const Approach here = at(t == never ? until : t);
    if (here.distance < nearest.distance) nearest = here;
    if (t != never) t = failure_time(parting, t, until);
  }
  return nearest;
}

#define KDS_INSTANTIATE(degree)                                                \
  template Approach closest_approach(const certificates::PointMotion<degree>&, \
                                     const certificates::PointMotion<degree>&, double, double);
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
