#include "collision/narrow_phase/surface_rate.hpp"

#include "collision/body_motion.hpp"
#include "collision/narrow_phase/kept_rotation.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "collision/shapes/shape_forms.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kds::collision {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The weights of the corners of a triangle that make up a point of it.
std::array<double, 3> weights_in(const std::array<Vector3d, 3>& corner, const Vector3d& point) {
  const Vector3d u = corner[1] - corner[0], v = corner[2] - corner[0], on = point - corner[0];
  const Vector3d n = cross(u, v);
  const double area = squared_norm(n);
  if (!(area > 0)) return {1.0 / 3, 1.0 / 3, 1.0 / 3};
  const double wb = std::clamp(dot(n, cross(on, v)) / area, 0.0, 1.0);
  const double wc = std::clamp(dot(n, cross(u, on)) / area, 0.0, 1 - wb);
  return {1 - wb - wc, wb, wc};
}

/// `point`: of the feature, from the centre of the body; `normal`: of the contact, of either sign.
SurfaceRate rate_of_script(const MeshScript& script, const Matrix3d& rotation, const Feature& feature,
                           const Vector3d& point, const Vector3d& normal, double t) {
  if (feature.kind == Feature::Kind::none) return {};
  const auto place = [&](std::size_t v) { return placed_vertex(rotation, 1, script.position(v, t)); };
  const auto velocity = [&](std::size_t v) { return placed_vertex(rotation, 1, script.velocity(v, t)); };
  if (feature.kind == Feature::Kind::vertex) return {velocity(feature.first), Vector3d::Zero()};
  if (feature.kind == Feature::Kind::edge) {
    const Vector3d a = place(feature.first), along = place(feature.second) - a;
    const Vector3d of_a = velocity(feature.first), turns = velocity(feature.second) - of_a;
    const double squared = squared_norm(along);
    if (!(squared > 0)) return {of_a, Vector3d::Zero()};
    const double part = std::clamp(dot(point - a, along) / squared, 0.0, 1.0);
    return {of_a + part * turns, -(dot(normal, turns) / squared) * along};  // it stays across the edge
  }
  const Mesh::Triangle& face = script.triangles()[feature.first];
  const std::array<Vector3d, 3> p{place(face[0]), place(face[1]), place(face[2])};
  const std::array<Vector3d, 3> rate{velocity(face[0]), velocity(face[1]), velocity(face[2])};
  const auto w = weights_in(p, point);
  const Vector3d u = p[1] - p[0], v = p[2] - p[0];
  const Vector3d across = cross(u, v);
  const Vector3d turns = cross(rate[1] - rate[0], v) + cross(u, rate[2] - rate[0]);
  SurfaceRate result{w[0] * rate[0] + w[1] * rate[1] + w[2] * rate[2], Vector3d::Zero()};
  const double squared = squared_norm(across);
  if (!(squared > 0)) return result;
  const Vector3d unit_turns = (turns - (dot(across, turns) / squared) * across) / std::sqrt(squared);
  result.normal_rate = dot(across, normal) < 0 ? Vector3d(-unit_turns) : unit_turns;
  return result;
}

}  // namespace

template <class Motion>
SurfaceRate surface_rate(const MovingShape<Motion>& body, const Contact& contact, bool is_a) {
  const MeshScript* const script = script_of(body.shape.shape);
  if (!script) return {};
  return rate_of_script(*script, kept_rotation(body.shape, body.motion), is_a ? contact.feature_a : contact.feature_b,
                        contact.point - path_of(body.motion).position(contact.time), contact.normal, contact.time);
}

#define KDS_INSTANTIATE(motion) template SurfaceRate surface_rate(const MovingShape<motion>&, const Contact&, bool);
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
