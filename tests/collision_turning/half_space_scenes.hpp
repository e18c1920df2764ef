// Scenes with half-spaces below bodies that turn, and what happens in them, written down.
#pragma once

#include "collision/world.hpp"
#include "tests/collision_turning/narrow_phase/turning_solids.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace kds::tests::planes {

using namespace kds::collision;
using certificates::RigidMotion;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Turning = TurningWorld<2>;
using Body = Turning::Description;

inline constexpr double gravity = 10;
inline const Vector3d zero = Vector3d::Zero();

struct Log : Turning::Listener {
  struct Event {
    const char* what;
    BodyId a, b;
    Contact contact;
    friend bool operator==(const Event& x, const Event& y) {
      return x.what == y.what && x.a == y.a && x.b == y.b && x.contact.time == y.contact.time &&
             x.contact.point == y.contact.point && x.contact.normal == y.contact.normal &&
             x.contact.feature_a == y.contact.feature_a && x.contact.feature_b == y.contact.feature_b;
    }
  };
  std::vector<Event> events;

  void note(const char* what, const PairEvent& event) { events.push_back({what, event.a, event.b, event.contact}); }
  void contact(Turning&, const PairEvent& event) override { note("contact", event); }
  void separation(Turning&, const PairEvent& event) override { note("separation", event); }
  void overlap(Turning&, const PairEvent& event) override { note("overlap", event); }
  void rests(Turning&, const PairEvent& event) override { note("rests", event); }
  void wakes(Turning&, const PairEvent& event) override { note("wakes", event); }
  void passes(Turning&, const PairEvent& event) override { note("passes", event); }

  std::size_t count(const std::string& what) const {
    return static_cast<std::size_t>(
        std::count_if(events.begin(), events.end(), [&](const Event& event) { return event.what == what; }));
  }
};

inline WorldOptions options(BroadPhaseKind kind = BroadPhaseKind::automatic) {
  WorldOptions result{.response = Response::elastic, .broad_phase = kind};
  if (kind == BroadPhaseKind::sap) result.rate = 60;
  return result;
}

inline constexpr BroadPhaseKind all_methods[] = {BroadPhaseKind::automatic, BroadPhaseKind::all_pairs,
                                                 BroadPhaseKind::sap, BroadPhaseKind::kinetic_sap,
                                                 BroadPhaseKind::grid};

inline Body fixed(const Shape& shape, const Vector3d& at = zero,
                  const Quaterniond& orientation = Quaterniond::Identity()) {
  RigidMotion<2> motion = motion_of<2>(at, zero, zero);
  motion.orientation = orientation;
  return {.shape = shape, .motion = {motion}, .fixed = true};
}
inline Body half_space(const Vector3d& normal, double offset = 0, const Vector3d& at = zero,
                       const Quaterniond& orientation = Quaterniond::Identity()) {
  return fixed(HalfSpace{normal, offset}, at, orientation);
}
inline Body ground() { return half_space(Vector3d::UnitZ()); }

/// Six walls of a cube, turned as a whole.
inline void add_room(Turning& world, double half, const Quaterniond& turn = Quaterniond::Identity()) {
  for (int d = 0; d < 3; ++d) {
    for (const double side : {-1.0, 1.0}) world.add_body(half_space(side * Vector3d::Unit(d), -half, zero, turn));
  }
}

/// One that falls.
inline Body thrown(const Shape& shape, const Vector3d& at, const Vector3d& velocity, const Vector3d& spin,
                   const Quaterniond& orientation = Quaterniond::Identity()) {
  RigidMotion<2> motion = motion_of<2>(at, velocity, spin);
  motion.path.coefficients[2] = Vector3d(0, 0, -gravity / 2);
  motion.orientation = orientation;
  return {.shape = shape, .motion = {motion}};
}

/// Adds the one of several with this number, which flies about; each third has friction.
inline void add_flying(Turning& world, const Shape& shape, std::size_t number, const Vector3d& at, Random& random) {
  const Vector3d velocity = random_vector(random, 3);
  Body body = thrown(shape, at, velocity, random_vector(random, 6), Quaterniond(1, velocity[0], at[1], 0.5));
  body.friction = number % 3 == 0 ? 0.25 : 0;
  body.restitution = 0.9;
  world.add_body(body);
}

}  // namespace kds::tests::planes
