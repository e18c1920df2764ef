// What a domain records of the events of its world.
#include "collision/motions.hpp"
#include "collision/parallel/domain.hpp"

#include <cstddef>
#include <iterator>

namespace kds::collision {

/// Whether this is the first of the domains that know two bodies. Precondition: it knows both.
template <class Motion>
bool Domain<Motion>::is_first_to_know(BodySlot a, BodySlot b) const {
  const auto of_a = division_.knowers(a), of_b = division_.knowers(b);
  auto first = of_a.begin();
  for (auto other = of_b.begin(); *first != *other;) *first < *other ? ++first : ++other;
  return *first == index_;
}

/// Events of bodies without an owner are told by one of the domains that know them.
template <class Motion>
void Domain<Motion>::record(DomainEvent::Kind kind, const PairEvent& event) {
  ++report_.computed;
  const BodySlot a = body_slot(event.a), b = body_slot(event.b);
  const DomainIndex of_a = owner_of(a), of_b = owner_of(b);
  const bool fixed = of_a == Division::nobody && of_b == Division::nobody;
  const bool mine = fixed ? is_first_to_know(number(a), number(b)) : of_a == index_ || of_b == index_;
  if (!mine) return;
  const bool shared = !fixed && of_a != of_b && of_a != Division::nobody && of_b != Division::nobody;
  // Of a shared one the owner of the first body counts it.
  const auto counted = static_cast<std::size_t>(kind);
  if (counted < report_.told.size() && (!shared || of_a == index_)) ++report_.told[counted];
  if (!logs_) return;
  const DomainIndex other = of_a == index_ ? of_b : of_a;
  DomainEvent recorded{kind,
                       shared ? other : DomainEvent::nobody,
                       key(event.a),
                       key(event.b),
                       event.contact,
                       event.user_data_a,
                       event.user_data_b};
  if (recorded.follows()) recorded.cause = cause_at(event.contact.time);
  put(recorded);
}

/// Independent events of one time, and those that follow from one, are put into the order of ids in the scene, as this
/// world tells of them by ids of its own. Those of contacts and of walls, which may follow from each other, come in
/// that order: queues know the keys of bodies.
template <class Motion>
void Domain<Motion>::put(const DomainEvent& event) {
  auto place = events_.end();
  if (event.kind != Kind::contact && event.kind != Kind::separation && event.kind != Kind::wall) {
    const auto origin = event.origin();
    const auto before = [&](const DomainEvent& other) {
      const auto others = other.origin();
      if (others.phase != origin.phase || other.contact.time != event.contact.time) return true;
      return others != origin || !(event.order() < other.order());
    };
    // Two bodies may meet several times at one instant: what follows from each time stays after the one before.
    const auto first = events_.begin() + (event.follows() ? static_cast<std::ptrdiff_t>(caused_from_) : 0);
    while (place != first && !before(*std::prev(place))) --place;
  }
  events_.insert(place, event);
}

/// What is told from now on follows from this, until the next.
template <class Motion>
void Domain<Motion>::begin_cause(DomainEvent::Cause::Phase phase, BodyId a, BodyId b, double t) {
  cause_ = {phase, a, b};
  caused_at_ = t;
  caused_from_ = events_.size();
  ends_seen_ = engine_.parts().resting.last_event().count;
}

/// From what the event that is told now, at t, follows. What this world was not told of are the ends of contacts and
/// of spans, and, if it is none of these, pieces of motion.
template <class Motion>
DomainEvent::Cause Domain<Motion>::cause_at(double t) {
  using Phase = DomainEvent::Cause::Phase;
  const auto& last = engine_.parts().resting.last_event();
  if (last.count != ends_seen_ && last.time == t) {
    begin_cause(last.is_span ? Phase::spans : Phase::ends_of_rest, last.rank.a, last.rank.b, t);
  }
  if (caused_at_ != t) begin_cause(Phase::pieces, 0, 0, t);
  return cause_;
}

/// Something about a resting contact. All domains that know a body know the fixed ones that carry it, unless these have
/// owners.
template <class Motion>
void Domain<Motion>::rest(DomainEvent::Kind kind, const PairEvent& event) {
  const auto& bodies = engine_.bodies();
  const BodySlot a = body_slot(event.a), b = body_slot(event.b);
  if (!bodies.fixed(a) && !bodies.fixed(b)) {
    record(kind, event);
    if (kind != Kind::rebound_suppressed) changed(a, event.contact.time), changed(b, event.contact.time);
    return;
  }
  const BodySlot carried = bodies.fixed(a) ? b : a, carrier = bodies.fixed(a) ? a : b;
  if (bodies.fixed(carried) || !bodies.fixed(carrier) || known_[carrier].role != Role::unowned) {
    report_.divisible = false;
    return;
  }
  const auto cause = cause_at(event.contact.time);
  if (logs_ && known_[carried].role != Role::copy) {
    put({kind, DomainEvent::nobody, key(event.a), key(event.b), event.contact, event.user_data_a, event.user_data_b,
         cause});
  }
  if (kind != Kind::rebound_suppressed) changed(carried, event.contact.time);
}

template <class Motion>
void Domain<Motion>::rest(DomainEvent::Kind kind, const WallEvent& event) {
  const BodySlot slot = body_slot(event.body);
  const auto cause = cause_at(event.contact.time);
  if (logs_ && tells_of_wall(slot)) {
    put({kind, DomainEvent::nobody, key(event.body), static_cast<BodyId>(event.wall), event.contact, event.user_data, 0,
         cause});
  }
  if (kind != Kind::rebound_suppressed_at_wall) changed(slot, event.contact.time);
}

template <class Motion>
bool Domain<Motion>::tells_of_wall(BodySlot slot) const {
  const Role role = known_[slot].role;
  return role == Role::unowned ? is_first_to_know(number(slot), number(slot)) : role != Role::copy;
}

template <class Motion>
void Domain<Motion>::contact(World&, const PairEvent& event) {
  record(DomainEvent::Kind::contact, event);
  if (event.a == event.b) return;  // A mesh that bends goes through itself.
  begin_cause(DomainEvent::Cause::Phase::contacts, key(event.a), key(event.b), event.contact.time);
  const BodySlot a = body_slot(event.a), b = body_slot(event.b);
  if (!resolves_ || engine_.bodies()[a].sensor || engine_.bodies()[b].sensor) return;
  if constexpr (turns<Motion>) {
    note_islands();
    // Who does not rest yet, but is about to, would have to be known with what it lies on.
    for (const BodySlot slot : {a, b}) {
      const auto has_owner = [this](BodySlot fixed) { return known_[fixed].role != Role::unowned; };
      if (engine_.parts().resting.lies_on(slot, has_owner)) report_.divisible = false;
    }
  }
  changed(a, event.contact.time);
  changed(b, event.contact.time);
}

template <class Motion>
void Domain<Motion>::separation(World&, const PairEvent& event) {
  record(DomainEvent::Kind::separation, event);
}

template <class Motion>
void Domain<Motion>::overlap(World&, const PairEvent& event) {
  record(DomainEvent::Kind::overlap, event);
}

template <class Motion>
void Domain<Motion>::wall(World&, const WallEvent& event) {
  ++report_.computed;
  const BodySlot slot = body_slot(event.body);
  const bool mine = tells_of_wall(slot);
  if (mine) ++report_.told[static_cast<std::size_t>(DomainEvent::Kind::wall)];
  if (mine && logs_) {
    put({DomainEvent::Kind::wall, DomainEvent::nobody, key(event.body), static_cast<BodyId>(event.wall), event.contact,
         event.user_data});
  }
  begin_cause(DomainEvent::Cause::Phase::walls, key(event.body), static_cast<BodyId>(event.wall), event.contact.time);
  changed(slot, event.contact.time);
}

/// A law leaves two bodies approaching. (Where nothing could keep them apart, what rests decides it, of more bodies
/// than these.)
template <class Motion>
void Domain<Motion>::passes(World&, const PairEvent& event) {
  if (!by_law_) {
    report_.divisible = false;
    return;
  }
  record(DomainEvent::Kind::passes, event);
}

/// What a body rests on has given it another motion. (Pieces of bodies that precess are no changes: note_pieces().)
template <class Motion>
void Domain<Motion>::moved(World&, BodyId id) {
  note_islands();
  if constexpr (!turns<Motion>) changed(body_slot(id), world_.now());
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class Domain<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
