// Balls, boxes, capsules, hulls and meshes that keep their shape, as surfaces that may meet one that bends.
#pragma once

#include "certificates/point_motion.hpp"
#include "certificates/turning/rigid_motion.hpp"
#include "collision/deforming/moving_surface.hpp"
#include "collision/shapes/shape.hpp"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace kds::collision {

/// The surface of a placed shape about its centre: of a ball the centre, of a capsule its segment, both with a radius;
/// of a box its faces as two triangles each, whose diagonals do not count; of a mesh or a hull its triangles, by whose
/// names its features go. All but meshes are solid. Its vertices are those of the shape as it is placed, rounded (a
/// box: as its rounded axes say).
///
/// Cost: O(n) to make, and each move; O(n log n) where a mesh or a hull is used for the first time, for its tree.
template <int Degree>
class RigidSurface {
 public:
  explicit RigidSurface(const PlacedShape& shape);

  /// Lets it move with the path over [t0, t1].
  void move(const certificates::PointMotion<Degree>& path, double t0, double t1);

  /// Lets it turn as well, on parabolas (Degree 2): the shape has to be placed without a rotation, since that of the
  /// motion counts. A vertex at a distance r from the origin of the body begins where it is meant to be at t0, with the
  /// velocity that is meant, and ends where it is meant to be at t1; in between no coordinate is off by more than 2 /
  /// 81 of r times the cube of the angle. That is in the uncertainty of the surface: what touches is found in any case,
  /// but up to 3.5 times as much too early. So steps should be short: after 0.003 rad it is 2^-30 of r.
  template <int PathDegree>
  void move(const certificates::RigidMotion<PathDegree>& motion, double t0, double t1);

  const MovingSurface<Degree>& surface() const { return surface_; }
  MovingSurface<Degree>& change_surface() { return surface_; }
  /// Of the vertices from the centre, at most, rounded; units of length.
  double vertex_radius() const { return vertex_radius_; }

 private:
  std::vector<Eigen::Vector3d> offsets_;  ///< of the vertices from the centre
  double vertex_radius_ = 0;
  std::shared_ptr<const SurfaceTree> tree_;  ///< in its place, or in a mesh
  MovingSurface<Degree> surface_;
};

extern template class RigidSurface<1>;
extern template class RigidSurface<2>;
extern template void RigidSurface<2>::move(const certificates::RigidMotion<1>&, double, double);
extern template void RigidSurface<2>::move(const certificates::RigidMotion<2>&, double, double);

}  // namespace kds::collision
