// The events of a scene, as the listener of a ParallelWorld is told of them.
#pragma once

#include "collision/parallel/parallel_options.hpp"
#include "collision/parallel/parallel_world.hpp"
#include "collision/parallel/world_events.hpp"
#include "collision/world/bodies.hpp"

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace kds::collision {

/// Tells a listener of an event that a domain has recorded.
inline void relay(const DomainEvent& event, ParallelListener& listener) {
  using Kind = DomainEvent::Kind;
  const WallEvent wall{event.a, static_cast<int>(event.b), event.contact, event.user_data_a};
  const PairEvent pair{event.a, event.b, event.contact, event.user_data_a, event.user_data_b};
  switch (event.kind) {
    case Kind::overlap:
      return listener.overlap(pair);
    case Kind::wall:
      return listener.wall(wall);
    case Kind::contact:
      return listener.contact(pair);
    case Kind::separation:
      return listener.separation(pair);
    case Kind::rebound_suppressed:
      return listener.rebound_suppressed(pair);
    case Kind::rebound_suppressed_at_wall:
      return listener.rebound_suppressed_at_wall(wall);
    case Kind::wakes:
      return listener.wakes(pair);
    case Kind::wakes_at_wall:
      return listener.wakes_at_wall(wall);
    case Kind::rests:
      return listener.rests(pair);
    case Kind::rests_at_wall:
      return listener.rests_at_wall(wall);
    case Kind::passes:
      return listener.passes(pair);
    case Kind::mark:
      return;
  }
}

/// Passes on what a World tells while the scene is run as one, and counts it. Makes the changes for which the listener
/// has asked, when it has been told of the event.
template <class Motion>
class RelayedEvents final : public BasicWorldListener<Motion> {
 public:
  using World = BasicWorld<Motion>;
  using Change = std::function<void(World&)>;

  /// `listener`: null if there is none.
  RelayedEvents(ParallelListener* listener, ParallelCounters& counters)
      : listener_(listener ? *listener : silent_), counters_(counters) {}

  /// At the event that is being told, or the last of those that are passed over.
  void add_change(Change change) { changes_.push_back(std::move(change)); }
  bool awaits_change() const { return !changes_.empty(); }
  /// The listener has been told of so many of the events that follow.
  void pass_over(std::size_t events) { to_pass_over_ = events; }

  void contact(World& world, const PairEvent& event) override {
    ++counters_.contacts;
    tell(world, [&] { listener_.contact(event); });
  }
  void separation(World& world, const PairEvent& event) override {
    ++counters_.separations;
    tell(world, [&] { listener_.separation(event); });
  }
  void overlap(World& world, const PairEvent& event) override {
    ++counters_.overlaps;
    tell(world, [&] { listener_.overlap(event); });
  }
  void wall(World& world, const WallEvent& event) override {
    ++counters_.wall_contacts;
    tell(world, [&] { listener_.wall(event); });
  }
  void rebound_suppressed(World& world, const PairEvent& event) override {
    tell(world, [&] { listener_.rebound_suppressed(event); });
  }
  void rebound_suppressed_at_wall(World& world, const WallEvent& event) override {
    tell(world, [&] { listener_.rebound_suppressed_at_wall(event); });
  }
  void rests(World& world, const PairEvent& event) override {
    tell(world, [&] { listener_.rests(event); });
  }
  void rests_at_wall(World& world, const WallEvent& event) override {
    tell(world, [&] { listener_.rests_at_wall(event); });
  }
  void wakes(World& world, const PairEvent& event) override {
    tell(world, [&] { listener_.wakes(event); });
  }
  void wakes_at_wall(World& world, const WallEvent& event) override {
    tell(world, [&] { listener_.wakes_at_wall(event); });
  }
  void passes(World& world, const PairEvent& event) override {
    tell(world, [&] { listener_.passes(event); });
  }
  void timer(World& world, TimerId timer) override {
    tell(world, [&] { listener_.timer(timer, world.now()); });
  }

 private:
  template <class Tell>
  void tell(World& world, const Tell& tell) {
    if (to_pass_over_ == 0) {
      tell();
    } else if (--to_pass_over_ > 0) {
      return;
    }
    for (const Change& change : std::exchange(changes_, {})) change(world);
  }

  ParallelListener silent_;
  ParallelListener& listener_;
  ParallelCounters& counters_;
  std::vector<Change> changes_;
  std::size_t to_pass_over_ = 0;
};

}  // namespace kds::collision
