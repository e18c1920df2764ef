// A body as it stands at now(): whether it has entered, where it is, and its shape as it is turned and bent. And what
// is a place at all.
#pragma once

#include "collision/motions.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/shapes/shape_forms.hpp"
#include "collision/world.hpp"
#include "kds/number_text.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kds::collision::detail {

/// Throws std::invalid_argument, naming the function, for a place that is out of the range of shape.hpp.
inline void require_in_range(const char* function, const Eigen::Vector3d& at) {
  if ((at.array().abs() <= largest_magnitude).all()) return;
  throw std::invalid_argument(std::string(function) + ": a coordinate is not a number from -2^205 to 2^205");
}

/// Bodies that enter later are not there.
template <class Motion>
bool entered(const BasicWorld<Motion>& world, BodyId id) {
  return path_of(world.motion(id)).start <= world.now();
}

/// Throws std::invalid_argument, naming the function, for a body that is not there yet.
template <class Motion>
void require_entered(const char* function, const BasicWorld<Motion>& world, BodyId id) {
  if (entered(world, id)) return;
  throw std::invalid_argument(std::string(function) + ": body " + std::to_string(id) + " enters later, at " +
                              number_text(path_of(world.motion(id)).start));
}

struct StandingBody {
  PlacedShape shape;
  Eigen::Vector3d centre;  ///< rounded
};

/// Turned as the motion says at t.
template <int Degree>
PlacedShape turned_shape(const PlacedShape& shape, const certificates::PointMotion<Degree>&, double) {
  return shape;
}
template <int Degree>
PlacedShape turned_shape(const PlacedShape& shape, const certificates::RigidMotion<Degree>& motion, double t) {
  return place(shape.shape, motion.restarted(t).orientation.normalized());
}

/// A mesh that bends, as it is at t and stays.
inline Shape bent_shape(const MeshScript& script, double t) {
  MeshScript::Keyframe now{0, {}};
  for (std::size_t i = 0; i < script.vertices(); ++i) now.positions.push_back(script.position(i, t));
  const auto triangles = script.triangles();
  return BendingMesh{
      std::make_shared<const MeshScript>(std::vector<MeshScript::Keyframe>{std::move(now)},
                                         std::vector<Mesh::Triangle>(triangles.begin(), triangles.end()))};
}

template <class Motion>
StandingBody standing_body(const BasicWorld<Motion>& world, BodyId id) {
  const double t = world.now();
  const Motion& motion = world.motion(id);
  StandingBody body{turned_shape(world.shape(id), motion, t), path_of(motion).position(t)};
  if (const MeshScript* const script = script_of(body.shape.shape)) body.shape.shape = bent_shape(*script, t);
  return body;
}

}  // namespace kds::collision::detail
