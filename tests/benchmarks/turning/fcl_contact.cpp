// FCL's conservative advancement, of boxes, frame by frame. Its motion turns by less than half a turn a call, so a
// frame of more is divided into calls of up to 3 rad. It ends with a step of less than 1e-4 of a call's time, a
// constant of FCL's: no tolerance of a request is read.
#include "tests/benchmarks/turning/fcl_motion.hpp"
#include "tests/benchmarks/turning/query.hpp"

#include <fcl/geometry/shape/box.h>
#include <fcl/narrowphase/continuous_collision.h>

#include <algorithm>

namespace turning {

double fcl_contact(const Query& query, int frames) {
  const fcl::Boxd a(2 * query.half_a), b(2 * query.half_b);
  const fcl::ContinuousCollisionRequestd request(1000, 1e-4, fcl::CCDM_LINEAR, fcl::GST_LIBCCD,
                                                 fcl::CCDC_CONSERVATIVE_ADVANCEMENT);
  const int parts = std::max(frames, calls(query, 3));
  for (int part = 0; part < parts; ++part) {
    const double from = static_cast<double>(part) / parts, to = (part + 1.0) / parts;
    const fcl::InterpMotion<double> of_a = fcl_motion(query.a, from, to), of_b = fcl_motion(query.b, from, to);
    fcl::ContinuousCollisionResultd result;
    fcl::continuousCollide<double>(&a, &of_a, &b, &of_b, request, result);
    if (result.is_collide) return from + result.time_of_contact * (to - from);
  }
  return 2;
}

}  // namespace turning
