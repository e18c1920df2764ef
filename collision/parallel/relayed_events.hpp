// The events of a scene, as the listener of a ParallelWorld is told of them.
#pragma once

#include "collision/parallel/parallel_options.hpp"
#include "collision/parallel/parallel_world.hpp"
#include "collision/parallel/world_events.hpp"
#include "collision/world/bodies.hpp"

namespace kds::collision {

/// Tells a listener of an event that a domain has recorded.
inline void relay(const DomainEvent& event, ParallelListener& listener) {
  if (event.kind == DomainEvent::Kind::wall) {
    return listener.wall({event.a, static_cast<int>(event.b), event.contact, event.user_data_a});
  }
  const PairEvent pair{event.a, event.b, event.contact, event.user_data_a, event.user_data_b};
  if (event.kind == DomainEvent::Kind::contact) listener.contact(pair);
  if (event.kind == DomainEvent::Kind::separation) listener.separation(pair);
  if (event.kind == DomainEvent::Kind::overlap) listener.overlap(pair);
}

/// Passes on what a World tells while the scene is run as one, and counts it.
template <class Motion>
class RelayedEvents final : public BasicWorldListener<Motion> {
 public:
  using World = BasicWorld<Motion>;

  /// `listener`: null if there is none.
  RelayedEvents(ParallelListener* listener, ParallelCounters& counters)
      : listener_(listener ? *listener : silent_), counters_(counters) {}

  void contact(World&, const PairEvent& event) override {
    ++counters_.contacts;
    listener_.contact(event);
  }
  void separation(World&, const PairEvent& event) override {
    ++counters_.separations;
    listener_.separation(event);
  }
  void overlap(World&, const PairEvent& event) override {
    ++counters_.overlaps;
    listener_.overlap(event);
  }
  void wall(World&, const WallEvent& event) override {
    ++counters_.wall_contacts;
    listener_.wall(event);
  }
  void rebound_suppressed(World&, const PairEvent& event) override { listener_.rebound_suppressed(event); }
  void rebound_suppressed_at_wall(World&, const WallEvent& event) override {
    listener_.rebound_suppressed_at_wall(event);
  }
  void rests(World&, const PairEvent& event) override { listener_.rests(event); }
  void rests_at_wall(World&, const WallEvent& event) override { listener_.rests_at_wall(event); }
  void wakes(World&, const PairEvent& event) override { listener_.wakes(event); }
  void wakes_at_wall(World&, const WallEvent& event) override { listener_.wakes_at_wall(event); }
  void passes(World&, const PairEvent& event) override { listener_.passes(event); }
  void timer(World& world, TimerId timer) override { listener_.timer(timer, world.now()); }

 private:
  ParallelListener silent_;
  ParallelListener& listener_;
  ParallelCounters& counters_;
};

}  // namespace kds::collision
