// Bodies that fall and come to rest on fixed ones, and a log of what is told.
#pragma once

#include "collision/world.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace kds::tests::rest {

using namespace kds::collision;
using certificates::RigidMotion;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Turning = TurningWorld<2>;
using Body = Turning::Description;

inline constexpr double gravity = 10;
inline constexpr double flight = 1e-3;                                 // WorldOptions::shortest_flight
inline constexpr double holding_distance = gravity * flight * flight;  // at which bodies hold each other

struct Log : Turning::Listener {
  std::vector<std::string> lines;
  int contacts = 0, rested = 0, woken = 0, passed = 0;

  void note(const char* what, const PairEvent& event) {
    char text[200];
    std::snprintf(text, sizeof text, "%a %s %llu %llu %a %a %a", event.contact.time, what,
                  static_cast<unsigned long long>(event.a), static_cast<unsigned long long>(event.b),
                  event.contact.normal[2], event.contact.point[0], event.contact.point[1]);
    lines.emplace_back(text);
  }
  void contact(Turning&, const PairEvent& event) override { ++contacts, note("contact", event); }
  void rests(Turning&, const PairEvent& event) override { ++rested, note("rests", event); }
  void wakes(Turning&, const PairEvent& event) override { ++woken, note("wakes", event); }
  void rebound_suppressed(Turning&, const PairEvent& event) override { note("suppressed", event); }
  void passes(Turning&, const PairEvent& event) override { ++passed, note("passes", event); }
  bool hears_pieces() const override { return true; }
  void moved(Turning&, BodyId id) override { lines.push_back("moved " + std::to_string(id)); }
};

inline WorldOptions options(BroadPhaseKind kind = BroadPhaseKind::automatic) {
  WorldOptions result{.response = Response::elastic, .broad_phase = kind};
  result.shortest_flight = flight;
  if (kind == BroadPhaseKind::sap) result.rate = 60;
  return result;
}

/// That falls.
inline Body body(const Shape& shape, const Vector3d& at, const Quaterniond& orientation = Quaterniond::Identity(),
                 const Vector3d& spin = Vector3d::Zero()) {
  RigidMotion<2> motion{{{at, Vector3d::Zero(), Vector3d(0, 0, -gravity / 2)}}};
  motion.orientation = orientation;
  motion.angular_velocity = spin;
  return {.shape = shape, .motion = {motion}, .restitution = 0.3, .friction = 0.5};
}

inline Body fixed(const Shape& shape, const Vector3d& at, const Quaterniond& orientation = Quaterniond::Identity()) {
  Body result = body(shape, at, orientation);
  result.motion[0].path.coefficients[2] = Vector3d::Zero();
  result.fixed = true;
  return result;
}

/// Up to the height 0.
inline Body ground() { return fixed(Box{Vector3d(20, 20, 1)}, {0, 0, -1}); }

inline Quaterniond tilted(double angle, const Vector3d& axis) {
  const Vector3d v = std::sin(angle / 2) * axis.normalized();
  return {std::cos(angle / 2), v[0], v[1], v[2]};
}

inline bool still(const Turning& world, BodyId id) {
  const auto& motion = world.motion(id);
  return motion.path.coefficients[1].isZero(0) && motion.path.coefficients[2].isZero(0) &&
         motion.angular_velocity.isZero(0);
}

}  // namespace kds::tests::rest
