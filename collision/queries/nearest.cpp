#include "collision/queries/nearest.hpp"

#include "collision/narrow_phase/nearest_of_shape.hpp"
#include "collision/queries/standing_body.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <stdexcept>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// Finds a box about another one that holds enough bodies, and not many more.
template <class Motion>
class Surroundings {
 public:
  Surroundings(const BasicWorld<Motion>& world, const Vector3d& low, const Vector3d& high, const BodyFilter& filter)
      : world_(world), low_(low), high_(high), filter_(filter) {}

  /// Those whose volumes are no farther than a length in any coordinate.
  std::vector<BodyId> within(double length) const {
    std::vector<BodyId> bodies;
    const Vector3d room = Vector3d::Constant(length);
    world_.visit_overlapping(low_ - room, high_ + room, [&](BodyId id) {
      if (detail::accepts(filter_, id)) bodies.push_back(id);
    });
    return bodies;
  }

  /// A length within which there are so many bodies, if there are, and not many times as many, if that can be.
  double enough(std::size_t count) const {
    constexpr double step = 2;
    constexpr int most_steps = 32;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (world_.size() <= count) return infinity;
    const double size = std::max(low_.cwiseAbs().maxCoeff(), high_.cwiseAbs().maxCoeff());
    if (!(size < infinity)) return infinity;
    double length = 0x1p-6 * (size > 0 ? size : 1);
    std::size_t there = within(length).size();
    if (there < count) {
      for (int i = 0; i < most_steps; ++i) {
        length *= step;
        if (within(length).size() >= count) return length;
      }
      return infinity;
    }
    for (int i = 0; i < most_steps && there > 4 * count + 16; ++i) {
      there = within(length / step).size();
      if (there < count) break;
      length /= step;
    }
    return length;
  }

 private:
  const BasicWorld<Motion>& world_;
  Vector3d low_, high_;
  const BodyFilter& filter_;
};

bool nearer(const NearBody& a, const NearBody& b) {
  if (a.distance != b.distance) return a.distance < b.distance;
  return a.body < b.body;
}

/// The `count` bodies of the least measure(body).distance, which is not less than that of the boxes of the two.
template <class Motion, class Measure>
std::vector<NearBody> nearest_by(const Surroundings<Motion>& surroundings, std::size_t count, const Measure& measure) {
  if (count == 0) return {};
  const auto measured = [&](double length) {
    std::vector<NearBody> bodies;
    for (const BodyId id : surroundings.within(length)) bodies.push_back(measure(id));
    std::sort(bodies.begin(), bodies.end(), nearer);
    if (bodies.size() > count) bodies.resize(count);
    return bodies;
  };
  const double length = surroundings.enough(count);
  std::vector<NearBody> bodies = measured(length);
  // What is not in that box is farther than its half side; but not all in it are nearer than that.
  constexpr double roundings = 1 + 0x1p-20;
  if (bodies.size() == count && bodies.back().distance * roundings > length) {
    bodies = measured(bodies.back().distance * roundings);
  }
  return bodies;
}

}  // namespace

template <class Motion>
std::vector<NearBody> nearest(const BasicWorld<Motion>& world, const Vector3d& to, std::size_t count,
                              const BodyFilter& filter) {
  detail::require_in_range("nearest", to);
  return nearest_by(Surroundings<Motion>(world, to, to, filter), count, [&](BodyId id) {
    const detail::StandingBody body = detail::standing_body(world, id);
    const NearestOfShape of_body = nearest_of_shape(body.shape, to - body.centre);
    return NearBody{id, of_body.distance, of_body.point + body.centre, to};
  });
}

template <class Motion>
std::vector<NearBody> nearest(const BasicWorld<Motion>& world, const PlacedShape& shape, const Vector3d& at,
                              std::size_t count, const BodyFilter& filter) {
  detail::require_in_range("nearest", at);
  if (!is_placed(shape)) throw std::invalid_argument("nearest: the shape is not what place() makes of it");
  const Surroundings<Motion> surroundings(world, at + shape.low, at + shape.high, filter);
  return nearest_by(surroundings, count, [&](BodyId id) {
    const detail::StandingBody body = detail::standing_body(world, id);
    const ShapeDistance found = shape_distance(shape, body.shape, body.centre - at, world.now());
    return NearBody{id, found.distance, found.of_b + at, found.of_a + at};
  });
}

template <class Motion>
ShapeDistance distance_between(const BasicWorld<Motion>& world, BodyId a, BodyId b) {
  for (const BodyId id : {a, b}) detail::require_entered("distance_between", world, id);
  const detail::StandingBody of_a = detail::standing_body(world, a), of_b = detail::standing_body(world, b);
  ShapeDistance found = shape_distance(of_a.shape, of_b.shape, of_b.centre - of_a.centre);
  found.of_a += of_a.centre;
  found.of_b += of_a.centre;
  return found;
}

#define KDS_INSTANTIATE(motion)                                                                                       \
  template std::vector<NearBody> nearest(const BasicWorld<motion>&, const Vector3d&, std::size_t, const BodyFilter&); \
  template std::vector<NearBody> nearest(const BasicWorld<motion>&, const PlacedShape&, const Vector3d&, std::size_t, \
                                         const BodyFilter&);                                                          \
  template ShapeDistance distance_between(const BasicWorld<motion>&, BodyId, BodyId);
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
