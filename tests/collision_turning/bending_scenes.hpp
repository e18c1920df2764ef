// What turns beside what bends: places by none of the library's code, and sheets.
#pragma once

#include "collision/shapes/bending_mesh.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "tests/collision/deforming/bowls.hpp"
#include "tests/collision_turning/half_space_scenes.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <utility>
#include <variant>
#include <vector>

namespace kds::tests::sheets {

using namespace kds::collision;
using namespace kds::collision::tests;
using namespace kds::tests::planes;
using Path = certificates::PointMotion<2>;

/// As the motion says, by none of the library's code.
inline LongMatrix rotation_at(const RigidMotion<2>& motion, double t) {
  const Eigen::Quaternion<Long> q = motion.orientation.cast<Long>().normalized();
  const LongVector spin = motion.angular_velocity.cast<Long>();
  const Long rate = spin.norm();
  if (rate == 0) return q.toRotationMatrix();
  const Long angle = rate * (static_cast<Long>(t) - motion.start());
  return Eigen::AngleAxis<Long>(angle, spin / rate).toRotationMatrix() * q.toRotationMatrix();
}
inline LongVector place_at(const RigidMotion<2>& motion, double t) {
  const Long elapsed = static_cast<Long>(t) - motion.start();
  const auto& c = motion.path.coefficients;
  return c[0].cast<Long>() + elapsed * (c[1].cast<Long>() + elapsed * c[2].cast<Long>());
}
inline BruteSurface solid_at(const Solid& solid, const RigidMotion<2>& motion, double t) {
  return solid.at(place_at(motion, t), rotation_at(motion, t));
}

inline BruteSurface sheet_at(const BendingMesh& sheet, const RigidMotion<2>& motion, double t) {
  BruteSurface surface;
  const LongMatrix turn = rotation_at(motion, t);
  for (std::size_t k = 0; k < sheet.script->vertices(); ++k) {
    surface.corners.push_back(place_at(motion, t) + turn * sheet.script->position(k, t).cast<Long>());
  }
  const auto triangles = sheet.script->triangles();
  surface.faces.assign(triangles.begin(), triangles.end());
  surface.add_edges_of_faces();
  return surface;
}

/// Whether the origin of a solid is not its centre of mass, so that its inertia has to be given.
inline bool off_centre(const Shape& shape) {
  return std::holds_alternative<ConvexHull>(shape) || std::holds_alternative<MeshShape>(shape);
}

inline Body fixed_sheet(const BendingMesh& shape, double restitution = 1) {
  return {.shape = shape, .motion = {RigidMotion<2>{}}, .fixed = true, .restitution = restitution};
}

}  // namespace kds::tests::sheets
