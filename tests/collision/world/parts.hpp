// The parts of a world without the world: for tests of each by itself.
#pragma once

#include "collision/world/bodies.hpp"
#include "collision/world/clock.hpp"
#include "collision/world/pairs/pairs.hpp"
#include "collision/world/reports.hpp"
#include "collision/world/resting/resting_contacts.hpp"
#include "collision/world/volumes.hpp"
#include "collision/world_counters.hpp"
#include "collision/world_options.hpp"
#include "tests/collision/random_scenes.hpp"

#include <memory>
#include <utility>
#include <vector>

namespace kds::collision::tests {

/// Bodies, volumes, pairs and resting contacts that know each other, with a record of what resting contacts tell.
template <int Degree>
struct Parts final : RestingContacts<certificates::PointMotion<Degree>>::Listener {
  using Motion = certificates::PointMotion<Degree>;

  explicit Parts(const WorldOptions& chosen = {})
      : options(chosen),
        clock{options.start_time, options.start_time + options.window},
        volumes(bodies, options, clock),
        resting(bodies, options, clock),
        pairs(bodies, volumes, resting, reports, options, clock, counters, nullptr) {
    resting.set_listener(*this);
  }

  /// Adds a body that has entered.
  BodySlot add(const BodyDescription<Degree>& description) {
    auto shape = std::make_shared<const PlacedShape>(place(description.shape, description.orientation));
    const BodySlot id = bodies.add(description, std::move(shape), description.motion.front());
    bodies[id].entered = true;
    volumes.add(id, description.box);
    return id;
  }
  void move(BodySlot id, const Motion& motion) {
    bodies.move(id, motion);
    bodies.accelerate_freely(id, motion);
    pairs.motion_changed(id, false);
  }

  void take_up(BodySlot id, const Motion& motion) override {
    bodies.move(id, motion);
    taken_up.push_back(id);
  }
  void changed(BodySlot a, BodySlot b) override { pairs.changed(a, b); }
  void let_pass(BodySlot a, BodySlot b) override { pairs.let_pass(a, b); }
  void tell_rebound_suppressed(BodySlot a, BodySlot b) override { told.emplace_back(a, b); }
  void tell_resting(bool, const detail::RestingContact&) override {}
  void tell_passes(const detail::RestingContact&) override {}
  void tell_touched(BodySlot) override {}

  WorldOptions options;
  Clock clock;
  WorldCounters counters;
  Bodies<Motion> bodies;
  Volumes<Motion> volumes;
  Reports reports;
  RestingContacts<Motion> resting;
  Pairs<Motion> pairs;
  std::vector<BodySlot> taken_up;
  std::vector<std::pair<BodySlot, BodySlot>> told;
};

}  // namespace kds::collision::tests
