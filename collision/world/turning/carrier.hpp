// How a fixed body moves that carries what rests on it.
#pragma once

#include "collision/shapes/shape.hpp"
#include "collision/world/image_tools.hpp"
#include "kds/arithmetic/exact.hpp"

#include <Eigen/Core>

#include <optional>

namespace kds::collision::turning_rest {

/// The motion of a body that does not turn, but for its place: a constant velocity, as of a belt, or a constant
/// acceleration, as of a lift that speeds up. What has the same coefficients about the same start stays at its place on
/// that body exactly.
struct Carrier {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();           ///< at the start
  Eigen::Vector3d half_acceleration = Eigen::Vector3d::Zero();  ///< the coefficient, as of a motion
  double start = 0;                                             ///< s; 0 if it does not accelerate

  bool accelerates() const { return !half_acceleration.isZero(0); }
  Eigen::Vector3d velocity_at(double t) const {
    return accelerates() ? Eigen::Vector3d(velocity + 2 * (t - start) * half_acceleration) : velocity;
  }
  bool finite() const { return velocity.allFinite() && half_acceleration.allFinite() && start - start == 0; }
  friend bool operator==(const Carrier&, const Carrier&) = default;
};

template <class Archive>
void archive_members(Archive& archive, Carrier& carrier) {
  image::vector(archive, carrier.velocity), image::vector(archive, carrier.half_acceleration);
  archive(carrier.start);
}

/// Nothing if the body turns.
template <class Motion>
std::optional<Carrier> carrier_of(const Motion& motion) {
  if (!motion.angular_velocity.isZero(0)) return std::nullopt;
  Carrier carrier{.velocity = motion.path.coefficients[1]};
  if constexpr (Motion::degree >= 2) {
    static_assert(Motion::degree == 2);
    carrier.half_acceleration = motion.path.coefficients[2];
    if (carrier.accelerates()) carrier.start = motion.path.start;
  }
  return carrier;
}

/// Whether a body stays at its place on a carrier, exactly.
template <class Motion>
bool moves_with(const Motion& motion, const Carrier& carrier) {
  const auto of_body = carrier_of(motion);
  return of_body && *of_body == carrier;
}

/// The velocity with which a half-space slides along itself, seen from a carrier; nothing if it does not do so exactly.
/// What is carried keeps its height above it for good, and slides on it in that direction alone.
template <class Motion>
std::optional<Eigen::Vector3d> slides_under(const Carrier& carrier, const HalfSpace& plane, const Motion& motion) {
  const auto own = carrier_of(motion);
  if (!own || own->accelerates() || carrier.accelerates() || *own == carrier) return std::nullopt;
  const Eigen::Vector3d velocity = own->velocity - carrier.velocity;
  Exact across;  // of which the rounded velocity may not tell
  for (int d = 0; d < 3; ++d) {
    across = across + Exact(plane.normal[d]) * (Exact(own->velocity[d]) - Exact(carrier.velocity[d]));
  }
  if (across.sign() != 0) return std::nullopt;
  return velocity;
}

/// From a time on a body is carried. Its place is rounded.
template <class Motion>
Motion carried_by(const Carrier& carrier, const Motion& motion, double t) {
  Motion result = motion.restarted(t);
  auto& path = result.path;
  if constexpr (Motion::degree >= 2) {
    if (carrier.accelerates()) {
      const double elapsed = t - carrier.start;
      path.coefficients[0] -= elapsed * (carrier.velocity + elapsed * carrier.half_acceleration);
      path.start = carrier.start;
    }
    path.coefficients[2] = carrier.half_acceleration;
  }
  path.coefficients[1] = carrier.velocity;
  result.angular_velocity = Eigen::Vector3d::Zero();
  return result;
}

}  // namespace kds::collision::turning_rest
