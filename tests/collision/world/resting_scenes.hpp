// Bodies that bounce and come to rest, the same with every broad phase.
#pragma once

#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <functional>
#include <vector>

namespace kds::collision::tests {

inline const Vector3d weight{0, 0, -5};  // half the acceleration

inline WorldOptions elastic(BroadPhaseKind method = BroadPhaseKind::kinetic_sap) {
  WorldOptions options;
  options.response = Response::elastic;
  options.broad_phase = method;
  options.rate = 16;
  return options;
}

template <int Degree>
BodyDescription<Degree> bouncy(BodyDescription<Degree> body, double restitution, double mass = 1) {
  body.restitution = restitution;
  body.mass = mass;
  return body;
}

/// Its upper face is z = 0.
inline BodyDescription<2> floor_box(double half = 50) {
  return fixed_body<2>(Box{{half, half, 1}}, motion<2>({0, 0, -1}));
}

/// Runs `scene(world)` with each broad phase, hands each world at the end to `check`, and compares the logs.
inline void with_all_methods(const WorldOptions& options, const std::function<void(World<2>&)>& scene,
                             const std::function<void(World<2>&, EventLog<2>&)>& check) {
  std::vector<Event> first;
  for (const auto method : all_methods) {
    WorldOptions own = options;
    own.broad_phase = method;
    EventLog<2> log;
    World<2> world(own, &log);
    scene(world);
    world.audit();
    CHECK(in_order_of_time(log.events));
    if (method == all_methods.front()) first = log.events;
    INFO("method " << static_cast<int>(method));
    const bool same = log.events == first;
    CHECK(same);
    check(world, log);
  }
}

inline bool at_rest(const World<2>& world, BodyId id) {
  return world.motion(id).coefficients[1].isZero(0) && world.motion(id).coefficients[2].isZero(0);
}

}  // namespace kds::collision::tests
