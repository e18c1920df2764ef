// How the listener is told of what has happened at an instant.
#include "collision/motions.hpp"
#include "collision/world/engine.hpp"

namespace kds::collision {

template <class Motion>
void Engine<Motion>::report_next() {
  const Reports::Report event = reports_.take_first();
  const auto user_data = [this](BodyId id, std::uint64_t of_removed) {
    return bodies_.contains(id) ? bodies_[body_slot(id)].user_data : of_removed;
  };
  const PairEvent pair{event.a, event.b, event.contact, user_data(event.a, event.user_data_a),
                       user_data(event.b, event.user_data_b)};
  switch (event.kind) {
    case Reports::Kind::overlap:
      ++counters_.overlaps;
      return tell([&](Listener& listener) { listener.overlap(world_, pair); });
    case Reports::Kind::separation:
      ++counters_.separations;
      return tell([&](Listener& listener) { listener.separation(world_, pair); });
    case Reports::Kind::rebound_suppressed:
      return tell([&](Listener& listener) { listener.rebound_suppressed(world_, pair); });
    case Reports::Kind::wakes:
    case Reports::Kind::rests:
      return report_resting(event, pair);
    case Reports::Kind::passes:
      return tell([&](Listener& listener) { listener.passes(world_, pair); });
    case Reports::Kind::moved:
      return tell([&](Listener& listener) { listener.moved(world_, event.a); });
    case Reports::Kind::piece:
      return tell([&](Listener& listener) { listener.piece(world_, event.a); });
    case Reports::Kind::pair_began:
      return tell([&](Listener& listener) { listener.pair_began(world_, event.a, event.b, event.contact.time); });
    case Reports::Kind::pair_ended:
      return tell([&](Listener& listener) { listener.pair_ended(world_, event.a, event.b, event.contact.time); });
  }
}

template <class Motion>
void Engine<Motion>::report_resting(const Reports::Report& event, const PairEvent& pair) {
  const bool begins = event.kind == Reports::Kind::rests;
  if (event.wall >= 0) {
    const WallEvent wall{event.a, event.wall, event.contact, pair.user_data_a};
    return tell([&](Listener& listener) {
      begins ? listener.rests_at_wall(world_, wall) : listener.wakes_at_wall(world_, wall);
    });
  }
  tell([&](Listener& listener) { begins ? listener.rests(world_, pair) : listener.wakes(world_, pair); });
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class Engine<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
