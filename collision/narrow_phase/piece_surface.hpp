// The surface of a body over one piece of time after the other, as tests of meshes that bend see it.
#pragma once

#include "certificates/turning/rigid_motion.hpp"
#include "collision/body_motion.hpp"
#include "collision/deforming/rigid_surface.hpp"
#include "collision/motion_range.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/shapes/bending_mesh.hpp"
#include "collision/shapes/shape_forms.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace kds::collision {

/// How fast a motion turns, in rad/s; 0 below slowest_rate, so that no pieces of time are made for it. How far its
/// points are turned nevertheless is in the errors of their places.
template <int Degree>
double turning_rate(const certificates::RigidMotion<Degree>& motion) {
  const double rate = norm(motion.angular_velocity);
  return rate < slowest_rate ? 0 : rate;
}

/// The surface of one body. Keeps a reference to the body.
///
/// The points of a body that turns are near parabolas (RigidSurface::move), which stand for their paths. A mesh that
/// bends does not turn: the rotation of its motion, or of its placed shape where motions have none, is constant.
template <class Motion>
class PieceSurface {
 public:
  using Body = MovingShape<Motion>;
  /// Of the paths of its vertices.
  static constexpr int degree = turns<Motion> ? 2 : Motion::degree;

  explicit PieceSurface(const Body& body) : body_(body), script_(script_of(body.shape.shape)) {
    if (script_) {
      bent_.emplace(script_->tree());
    } else if constexpr (turns<Motion>) {
      rigid_.emplace(place(body.shape.shape, Eigen::Quaterniond::Identity()));
    } else {
      rigid_.emplace(body.shape);
    }
  }

  /// The longest piece in which the paths of its vertices are off by no more than `error`, in s; `never` if it does not
  /// turn.
  double longest_piece(double error) const {
    if constexpr (turns<Motion>) {
      if (script_ || !(rigid_->vertex_radius() > 0)) return never;
      const double rate = turning_rate(body_.motion);
      return rate > 0 ? std::cbrt(81.0 / 2 * error / rigid_->vertex_radius()) / rate : never;
    }
    return never;
  }

  /// The surface over [t0, t1], with its uncertainty enlarged by `more`.
  const MovingSurface<degree>& over(double t0, double t1, double more = 0) {
    MovingSurface<degree>* const changed = script_ ? &bend(t0, t1) : &move(t0, t1);
    changed->set_uncertainty(changed->uncertainty() + more);
    return *changed;
  }

 private:
  MovingSurface<degree>& move(double t0, double t1) {
    rigid_->move(body_.motion, t0, t1);
    return rigid_->change_surface();
  }

  MovingSurface<degree>& bend(double t0, double t1) {
    const PathControls<Motion::degree> path(path_of(body_.motion), t0, t1);
    const auto turn = turn_at(t0);
    // Roundings: three of a position between keyframes or of an average, five of its turn, one of the sum.
    double error = path.error;
    double farthest = 0;
    for (std::size_t i = 0; i <= degree; ++i) {
      const auto points = bent_->change_control_points(i);
      const Eigen::Vector3d origin = control_of(path, i);
      for (std::size_t v = 0; v < points.size(); ++v) {
        points[v] = origin + turn(offset(v, i, t0, t1));
        farthest = std::max(farthest, points[v].cwiseAbs().maxCoeff());
      }
    }
    error += 0x1p-49 * (farthest + script_->bounding_radius());
    if constexpr (turns<Motion>) error += turn.error() * 2 * script_->bounding_radius();
    bent_->set_uncertainty(error);
    bent_->refit(t0, t1);
    return *bent_;
  }

  static Eigen::Vector3d control_of(const PathControls<Motion::degree>& path, std::size_t i) {
    if constexpr (turns<Motion>) return path.of_parabola()[i];
    return path.points[i];
  }
  auto turn_at([[maybe_unused]] double t) const {
    if constexpr (turns<Motion>) {
      return body_.motion.rotation(t);
    } else {
      return [this](const Eigen::Vector3d& v) { return placed_vertex(body_.shape.rotation, 1, v); };
    }
  }
  /// Control point i of a vertex, on its straight way, about the centre.
  Eigen::Vector3d offset(std::size_t v, std::size_t i, double t0, double t1) const {
    if (i == 0) return script_->position(v, t0);
    if (i == degree) return script_->position(v, t1);
    return 0.5 * (script_->position(v, t0) + script_->position(v, t1));
  }

  const Body& body_;
  const MeshScript* script_;
  std::optional<RigidSurface<degree>> rigid_;
  std::optional<MovingSurface<degree>> bent_;
};

}  // namespace kds::collision
