// How the listener of a world is told.
#pragma once

#include "collision/world/guard.hpp"
#include "collision/world/world_parts.hpp"
#include "collision/world_listener.hpp"

namespace kds::collision {

/// Calls the functions of a listener: of what has been reported, one after the other, and of timers.
template <class Motion>
class ListenerCalls {
 public:
  using Listener = BasicWorldListener<Motion>;

  /// `world` is what callbacks are given. A null listener hears nothing.
  ListenerCalls(BasicWorld<Motion>& world, Listener* listener, WorldParts<Motion>& parts, Guard& guard);
  ListenerCalls(const ListenerCalls&) = delete;
  ListenerCalls& operator=(const ListenerCalls&) = delete;

  /// Whether there is a listener that is told of every piece of bodies that precess.
  bool hears_pieces() const { return listener_ != &silent_ && listener_->hears_pieces(); }
  /// call(listener, world), in a step.
  template <class Call>
  void tell(const Call& call) {
    guard_.tell([&] { call(*listener_, world_); });
  }
  /// Tells the first report. Precondition: there are reports.
  void report_next();
  /// Tells the next timer. Precondition: it is due.
  void ring();

  PairEvent event_of(BodySlot a, BodySlot b, const Contact& contact) const {
    return {bodies_.id_of(a), bodies_.id_of(b), contact, bodies_[a].user_data, bodies_[b].user_data};
  }

 private:
  void report_resting(const Reports::Report& event, const PairEvent& pair);

  BasicWorld<Motion>& world_;
  Listener silent_;
  Listener* listener_;
  const Bodies<Motion>& bodies_;
  Timers& timers_;
  Reports& reports_;
  WorldCounters& counters_;
  Guard& guard_;
};

}  // namespace kds::collision
