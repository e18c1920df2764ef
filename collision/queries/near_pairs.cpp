#include "collision/queries/near_pairs.hpp"

#include "collision/broad_phase/kinetic_box.hpp"
#include "collision/queries/standing_body.hpp"
#include "collision/shapes/shape.hpp"
#include "kds/number_text.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <tuple>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// How far the bounding volume of a body may be from its centre, whatever its orientation.
template <class Motion>
double offset_of(const PlacedShape& shape) {
  if (ball_radius(shape.shape) > 0) return 0;
  const bool inside = (shape.low.array() <= 0).all() && (shape.high.array() >= 0).all();
  return inside && !turns<Motion> ? 0 : shape.bounding_radius;
}

bool before(const NearPair& x, const NearPair& y) {
  const auto key = [](const NearPair& near) { return std::tuple(near.approach.time, near.pair.a, near.pair.b); };
  return key(x) < key(y);
}

}  // namespace

template <class Motion>
std::vector<BodyPair> contact_pairs(const BasicWorld<Motion>& world) {
  std::vector<BodyPair> pairs;
  world.visit_bodies([&](BodyId a) {
    world.visit_partners(a, [&](BodyId b) {
      if (a < b) pairs.push_back({a, b});
    });
  });
  return pairs;
}

template <class Motion>
std::vector<NearPair> pairs_nearer_than(const BasicWorld<Motion>& world, double distance, double until,
                                        const BodyFilter& filter) {
  const double now = world.now();
  if (!(distance > 0 && distance <= largest_magnitude)) {
    throw std::invalid_argument("pairs_nearer_than: the distance " + number_text(distance) +
                                " is not a positive number below 2^205");
  }
  if (!(until >= now && until < never)) {
    throw std::invalid_argument("pairs_nearer_than: " + number_text(until) + " is not a finite time from now on (" +
                                number_text(now) + ")");
  }
  std::vector<BodyId> bodies;
  double offset = 0;
  world.visit_bodies([&](BodyId id) {
    if (!detail::entered(world, id) || !detail::accepts(filter, id)) return;
    const PlacedShape shape = world.shape(id);
    if (unbounded(shape.shape)) return;
    bodies.push_back(id);
    offset = std::max(offset, offset_of<Motion>(shape));
  });
  const auto counts = [&](BodyId id) { return std::binary_search(bodies.begin(), bodies.end(), id); };
  std::vector<NearPair> near;
  const Vector3d room = Vector3d::Constant(distance + offset);
  for (const BodyId a : bodies) {
    const PathOf<Motion>& path = path_of(world.motion(a));
    world.visit_swept(box_around(path, Vector3d(-room), room), until, [&](BodyId b) {
      if (!(a < b) || !counts(b)) return;
      const Approach approach = closest_approach(path, path_of(world.motion(b)), now, until);
      if (approach.distance < distance) near.push_back({{a, b}, approach});
    });
  }
  std::sort(near.begin(), near.end(), before);
  return near;
}

#define KDS_INSTANTIATE(motion)                                            \
  template std::vector<BodyPair> contact_pairs(const BasicWorld<motion>&); \
  template std::vector<NearPair> pairs_nearer_than(const BasicWorld<motion>&, double, double, const BodyFilter&);
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
