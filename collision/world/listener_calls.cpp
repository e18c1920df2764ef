#include "collision/world/listener_calls.hpp"

#include "collision/motions.hpp"

namespace kds::collision {

template <class Motion>
ListenerCalls<Motion>::ListenerCalls(BasicWorld<Motion>& world, Listener* listener, WorldParts<Motion>& parts,
                                     Guard& guard)
    : world_(world),
      listener_(listener ? listener : &silent_),
      bodies_(parts.bodies),
      timers_(parts.timers),
      reports_(parts.reports),
      counters_(parts.counters),
      guard_(guard) {}

template <class Motion>
void ListenerCalls<Motion>::report_next() {
  const Reports::Report event = reports_.take_first();
  const auto user_data = [this](BodyId id, std::uint64_t of_removed) {
    return bodies_.contains(id) ? bodies_[body_slot(id)].user_data : of_removed;
  };
  const PairEvent pair{event.a, event.b, event.contact, user_data(event.a, event.user_data_a),
                       user_data(event.b, event.user_data_b)};
  switch (event.kind) {
    case Reports::Kind::overlap:
      ++counters_.overlaps;
      return tell([&](Listener& listener, auto& world) { listener.overlap(world, pair); });
    case Reports::Kind::separation:
      ++counters_.separations;
      return tell([&](Listener& listener, auto& world) { listener.separation(world, pair); });
    case Reports::Kind::rebound_suppressed:
      return tell([&](Listener& listener, auto& world) { listener.rebound_suppressed(world, pair); });
    case Reports::Kind::wakes:
    case Reports::Kind::rests:
      return report_resting(event, pair);
    case Reports::Kind::passes:
      return tell([&](Listener& listener, auto& world) { listener.passes(world, pair); });
    case Reports::Kind::moved:
      return tell([&](Listener& listener, auto& world) { listener.moved(world, event.a); });
    case Reports::Kind::piece:
      return tell([&](Listener& listener, auto& world) { listener.piece(world, event.a); });
    case Reports::Kind::pair_began:
      return tell(
          [&](Listener& listener, auto& world) { listener.pair_began(world, event.a, event.b, event.contact.time); });
    case Reports::Kind::pair_ended:
      return tell(
          [&](Listener& listener, auto& world) { listener.pair_ended(world, event.a, event.b, event.contact.time); });
  }
}

template <class Motion>
void ListenerCalls<Motion>::report_resting(const Reports::Report& event, const PairEvent& pair) {
  const bool begins = event.kind == Reports::Kind::rests;
  if (event.wall >= 0) {
    const WallEvent wall{event.a, event.wall, event.contact, pair.user_data_a};
    return tell([&](Listener& listener, auto& world) {
      begins ? listener.rests_at_wall(world, wall) : listener.wakes_at_wall(world, wall);
    });
  }
  tell([&](Listener& listener, auto& world) { begins ? listener.rests(world, pair) : listener.wakes(world, pair); });
}

template <class Motion>
void ListenerCalls<Motion>::ring() {
  const TimerId timer = timers_.take_next();
  tell([&](Listener& listener, auto& world) { listener.timer(world, timer); });
}

#define KDS_INSTANTIATE(motion) template class ListenerCalls<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
