// How strongly bodies that turn are pressed together at a contact.
#pragma once

#include "collision/narrow_phase/contact.hpp"
#include "collision/response/turning_impulse.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/shapes/shape_forms.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Core>

#include <cmath>
#include <optional>
#include <variant>

namespace kds::collision {

/// An edge of a shape, or the axis of a capsule, which is its radius away from its side.
struct ContactEdge {
  Eigen::Vector3d along = Eigen::Vector3d::Zero();  ///< in the axes of the body, of any length
  double radius = 0;
};

/// None where the feature is no edge, or the shape does not tell where it is (compounds).
inline std::optional<ContactEdge> contact_edge(const Shape& shape, const Feature& feature) {
  if (feature.kind != Feature::Kind::edge) return std::nullopt;
  if (const auto* const capsule = std::get_if<Capsule>(&shape)) {
    return ContactEdge{Eigen::Vector3d::UnitZ(), capsule->radius};
  }
  if (const auto mesh = triangles_of(shape)) {
    return ContactEdge{mesh->vertices()[feature.second] - mesh->vertices()[feature.first]};
  }
  if (!std::holds_alternative<Box>(shape)) return std::nullopt;
  ContactEdge edge;  // Its two vertices differ in one bit, that of its axis.
  for (int d = 0; d < 3; ++d) {
    if ((feature.first ^ feature.second) >> d & 1u) edge.along[d] = 1;
  }
  return edge;
}

/// The radius of the round end of a capsule, 0 of a corner; none where the feature is neither.
inline std::optional<double> contact_end(const Shape& shape, const Feature& feature) {
  if (feature.kind != Feature::Kind::vertex) return std::nullopt;
  const auto* const capsule = std::get_if<Capsule>(&shape);
  return capsule ? capsule->radius : 0.0;
}

/// By how much faster than n . x'', of places on the axis of a side and at the centre of an end that touches it, their
/// gap opens, since the normal turns with both.
///
/// Let u be the direction of the axis, v the velocity of the end's centre seen from the place on the axis that is
/// nearest to it, s' the speed with which that place moves along the axis, and f the distance, which is the sum of the
/// radii R at the contact. Then f' = n . v, s' = u . v + f n . u', and f'' = n . x'' + (v . v - s'^2 - (n . v)^2) / f.
inline double opens_at_side(const Eigen::Vector3d& along, const Eigen::Vector3d& turns, const Eigen::Vector3d& velocity,
                            const Eigen::Vector3d& normal, double radii) {
  const Eigen::Vector3d axis = along / norm(along);
  const double slides = dot(axis, velocity) + radii * dot(normal, cross(turns, axis)), closes = dot(normal, velocity);
  return (squared_norm(velocity) - slides * slides - closes * closes) / radii;
}

/// The same of two ends, of capsules or balls, or of one and a corner: between their centres the normal turns with the
/// way alone, of which v is the velocity, so that f'' = n . x'' + (v . v - (n . v)^2) / f.
inline double opens_at_end(const Eigen::Vector3d& velocity, const Eigen::Vector3d& normal, double radii) {
  const double closes = dot(normal, velocity);
  return (squared_norm(velocity) - closes * closes) / radii;
}

/// The contact of two edges that cross, each turning with its body.
///
/// Let x_a and x_b be points of the two, n the unit normal of both, and R the sum of the radii. The gap is f = n . (x_b
/// - x_a) - R, whatever points these are, so f'' = n . (x_b - x_a)'' + 2 n' . (x_b - x_a)' - R |n'|^2 where x_b - x_a =
/// R n, as at the contact.
struct CrossingEdges {
  Eigen::Vector3d normal_rate;  ///< n'
  double radius_a, radius_b;
  double sine;  ///< of the angle between the two

  /// `a` and `b` in the axes of the world. None where the two are so nearly parallel that they are not one point.
  static std::optional<CrossingEdges> of(const ContactEdge& a, const ContactEdge& b, const Eigen::Vector3d& turns_a,
                                         const Eigen::Vector3d& turns_b, const Eigen::Vector3d& normal) {
    constexpr double least_sine = 0x1p-10;
    const Eigen::Vector3d across = cross(a.along, b.along);
    const double length = norm(across), sine = length / (norm(a.along) * norm(b.along));
    if (!(sine > least_sine)) return std::nullopt;
    const Eigen::Vector3d rate =
        (cross(cross(turns_a, a.along), b.along) + cross(a.along, cross(turns_b, b.along))) / length;
    const Eigen::Vector3d turned = rate - dot(rate, normal) * normal;
    return CrossingEdges{dot(across, normal) < 0 ? Eigen::Vector3d(-turned) : turned, a.radius, b.radius, sine};
  }
};

/// What brakes how two bodies turn against each other: a couple on the second, its opposite on the first, and the
/// energy that they lose.
struct TurningBrake {
  Eigen::Vector3d couple = Eigen::Vector3d::Zero();
  double spent = 0;
};

/// Takes an energy from how two bodies turn against each other, or all that there is of it.
inline TurningBrake spend_turning(RigidVelocity& a, RigidVelocity& b, const Mobility& of_a, const Mobility& of_b,
                                  double energy) {
  const Eigen::Vector3d relative = b.angular_velocity - a.angular_velocity;
  const double rate = norm(relative);
  if (!(rate > 0 && energy > 0)) return {};
  const Eigen::Vector3d axis = relative / rate;
  const Eigen::Vector3d turns_a = of_a.turned_by(axis), turns_b = of_b.turned_by(axis);
  const double turns = dot(axis, turns_a + turns_b);
  if (!(turns > 0)) return {};
  // A couple C takes C rate - C^2 turns / 2, at most where it stops them.
  const double left = rate * rate - 2 * turns * energy;
  const double couple = left > 0 ? 2 * energy / (rate + std::sqrt(left)) : rate / turns;
  a.angular_velocity += couple * turns_a, b.angular_velocity -= couple * turns_b;
  return {-couple * axis, left > 0 ? energy : rate * rate / (2 * turns)};
}

}  // namespace kds::collision
