// FCL's conservative advancement, of boxes, in calls of up to 3 rad: its motion turns by less than half a turn a call.
#include "tests/benchmarks/turning/query.hpp"

#include <fcl/geometry/shape/box.h>
#include <fcl/narrowphase/continuous_collision.h>

namespace turning {

double fcl_contact(const Query& query) {
  const fcl::Boxd a(2 * query.half_a), b(2 * query.half_b);
  const fcl::ContinuousCollisionRequestd request(1000, 1e-6, fcl::CCDM_LINEAR, fcl::GST_LIBCCD,
                                                 fcl::CCDC_CONSERVATIVE_ADVANCEMENT);
  const int parts = calls(query, 3);
  for (int part = 0; part < parts; ++part) {
    const double from = static_cast<double>(part) / parts, to = (part + 1.0) / parts;
    fcl::ContinuousCollisionResultd result;
    fcl::continuousCollide<double>(&a, pose(query.a, from), pose(query.a, to), &b, pose(query.b, from),
                                   pose(query.b, to), request, result);
    if (result.is_collide) return from + result.time_of_contact * (to - from);
  }
  return 2;
}

}  // namespace turning
