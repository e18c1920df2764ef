// Meshes whose vertices move, each on its own: cloth, soft bodies, scripted surfaces.
#pragma once

#include "certificates/point_motion.hpp"
#include "collision/deforming/moving_surface.hpp"
#include "collision/shapes/surface_tree.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace kds::collision {

/// A triangle surface that bends, over one step of time after the other. The usual use is that of a simulator, which
/// knows where vertices are at both ends of its steps:
///
///     DeformingMesh<1> cloth(positions, triangles);            // at rest there, at the time 0
///     while (...) {
///       cloth.step_to(t + h, simulated_positions);             // on straight lines from where they were
///       if (const auto contact = first_contact(cloth.surface(), ball.surface())) ...
///       if (const auto contact = first_self_contact(cloth.surface())) ...
///     }
///
/// Positions are taken as they are, so steps that follow on each other leave no gap in which something could be missed,
/// and nothing is lost far from the origin or late on the clock. The tree is built once, from the first positions, and
/// its boxes are made anew for each step, exactly (MovingSurface). Copies share the tree.
///
/// Degree 1: straight paths; 2: parabolas. Cost: O(n log n) to build, O(n) a step, 15 ns a triangle.
///
/// Steps throw std::invalid_argument, before anything has changed, unless there is a position for each vertex, all are
/// finite and at most Mesh::largest_coordinate in magnitude, and the step ends later than it begins.
template <int Degree = 1>
class DeformingMesh {
 public:
  using Positions = std::span<const Eigen::Vector3d>;

  /// Its parts are those of a mesh; triangles without area are welcome. `thickness`: of the whole sheet, half to each
  /// side. Throws InvalidMesh for a mesh that cannot be, std::invalid_argument for another number that cannot be.
  DeformingMesh(Positions positions, std::span<const Mesh::Triangle> triangles, double start = 0, double thickness = 0);

  const MovingSurface<Degree>& surface() const { return surface_; }
  std::span<const Mesh::Triangle> triangles() const { return *triangles_; }
  std::size_t vertices() const { return tree_->vertices(); }

  /// A step on straight lines from where the vertices are at the end of the last one.
  void step_to(double t1, Positions end) requires(Degree == 1) {
    check_step("step_to", surface_.end(), t1);
    check_positions("step_to", end);
    surface_.go_on();
    fill(1, end);
    finish(surface_.end(), t1);
  }
  /// A step on straight lines from anywhere.
  void set_step(double t0, double t1, Positions begin, Positions end) requires(Degree == 1) {
    set_control_points(t0, t1, {begin, end});
  }
  /// Any step, by its control points (MovingSurface). A parabola from p with velocity v (length/s) to q, in a time T:
  /// the control points p, p + v T / 2, q.
  void set_control_points(double t0, double t1, const std::array<Positions, std::size_t{Degree} + 1>& control);
  /// The same by motions of the vertices, which may have begun at any time. Their control points are rounded, and
  /// contact counts from so much farther away.
  void set_motions(double t0, double t1, std::span<const certificates::PointMotion<Degree>> motions);

 private:
  void check_step(const char* function, double t0, double t1) const;
  void check_positions(const char* function, Positions positions) const;
  void fill(std::size_t i, Positions positions);
  void finish(double t0, double t1, double uncertainty = 0);

  std::shared_ptr<const SurfaceTree> tree_;
  std::shared_ptr<const std::vector<Mesh::Triangle>> triangles_;
  MovingSurface<Degree> surface_;
};

extern template class DeformingMesh<1>;
extern template class DeformingMesh<2>;

}  // namespace kds::collision
