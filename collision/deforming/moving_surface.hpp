// A surface whose vertices move over a stretch of time, each on its own, and the boxes of its tree.
#pragma once

#include "certificates/point_motion.hpp"
#include "collision/shapes/surface_tree.hpp"
#include "kds/kept_memory.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace kds::collision {

/// An axis-aligned box whose sides are polynomials of s in [0, 1], by their Bernstein coefficients.
template <int Degree>
struct ControlBox {
  std::array<std::array<double, 3>, std::size_t{Degree} + 1> min, max;
};

/// The vertices of a surface on polynomial paths over [t0, t1], and a box for each node of its tree.
///
/// A path is the sum of its control points times the Bernstein polynomials of s = (t - t0) / (t1 - t0). A straight path
/// has two: the places at t0 and at t1, as they are given. So a path begins and ends exactly at its first and last
/// control points, and pieces that follow on each other leave no gap.
///
/// Law. The box of a node holds the elements below it at all times of the stretch, exactly: coefficient i of a side is
/// the least (or greatest) coordinate of the control points i, so nothing is rounded; as Bernstein polynomials are not
/// negative, the sum of the least is not above any of the sums. (For straight paths: a minimum of linear functions is
/// concave, so it lies above its chord.)
template <int Degree>
class MovingSurface {
 public:
  static constexpr std::size_t controls = std::size_t{Degree} + 1;

  /// All vertices at the origin, over [0, 1]. Keeps a reference to the tree.
  explicit MovingSurface(const SurfaceTree& tree);

  const SurfaceTree& tree() const { return *tree_; }
  double begin() const { return t0_; }  ///< s, on the clock
  double end() const { return t1_; }
  /// s at t, rounded; 0 where the stretch is an instant.
  double part(double t) const { return t1_ > t0_ ? (t - t0_) / (t1_ - t0_) : 0; }
  std::span<const Eigen::Vector3d> control_points(std::size_t i) const { return control_[i]; }
  std::span<const ControlBox<Degree>> boxes() const { return boxes_; }

  /// How thick it is to either side of its elements: the radius of a ball or a capsule, half the thickness of cloth.
  double radius() const { return radius_; }
  void set_radius(double radius) { radius_ = radius; }
  /// No coordinate of a vertex meant is farther than this from its path.
  double uncertainty() const { return uncertainty_; }
  void set_uncertainty(double uncertainty) { uncertainty_ = uncertainty; }

  /// Whether the faces are those of a convex solid, wound so that their normals point outward: then what is inside it
  /// touches it.
  bool solid() const { return solid_; }
  void set_solid() { solid_ = true; }

  /// Place and velocity of a vertex, rounded.
  Eigen::Vector3d position(std::size_t vertex, double t) const;
  Eigen::Vector3d velocity(std::size_t vertex, double t) const;

  /// The control points, to be changed; refit() then makes the boxes anew. Costs O(n), 15 ns a triangle.
  std::span<Eigen::Vector3d> change_control_points(std::size_t i) { return control_[i]; }
  /// Starts a stretch in which each vertex begins where it was at the end of the last; the caller sets the other
  /// control points.
  void go_on() { control_[0].swap(control_[Degree]); }
  void refit(double t0, double t1);

  /// Throws AuditFailure unless each box holds the control points of the elements below it.
  void audit() const;

 private:
  const SurfaceTree* tree_;
  double t0_ = 0;
  double t1_ = 1;
  double radius_ = 0;
  double uncertainty_ = 0;
  bool solid_ = false;
  // A world makes a surface for each test of a pair.
  std::array<KeptVector<Eigen::Vector3d>, controls> control_;
  KeptVector<ControlBox<Degree>> boxes_;  ///< by node
};

/// The control points of a path over [t0, t1], rounded, and a bound on what each of their coordinates is off.
template <int Degree>
struct PathControls {
  std::array<Eigen::Vector3d, std::size_t{Degree} + 1> points;
  double error = 0;

  PathControls(const certificates::PointMotion<Degree>& path, double t0, double t1);

  /// Those of the same path as a parabola.
  std::array<Eigen::Vector3d, 3> of_parabola() const {
    if constexpr (Degree == 1) return {points[0], 0.5 * points[0] + 0.5 * points[1], points[1]};
    if constexpr (Degree == 2) return points;
  }
};

extern template class MovingSurface<1>;
extern template class MovingSurface<2>;
extern template struct PathControls<1>;
extern template struct PathControls<2>;

}  // namespace kds::collision
