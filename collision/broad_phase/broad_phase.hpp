// The interface and the laws of every broad phase.
#pragma once

#include "collision/broad_phase/body_visitor.hpp"
#include "collision/broad_phase/broad_phase_counters.hpp"
#include "collision/broad_phase/kinetic_box.hpp"
#include "collision/broad_phase/swept_box.hpp"

#include <cstdint>
#include <span>
#include <string_view>

namespace kds::collision {

/// Told of pairs whose kinetic bounding volumes begin and cease to overlap, by the slots of their bodies. a < b always.
class PairListener {
 public:
  virtual ~PairListener() = default;
  /// A hint: about this many pairs will be reported at once.
  virtual void pairs_to_come(std::size_t) {}
  /// Whether any pairs need not be reported; and whether a pair may collide. The answer for two bodies stays the same
  /// as long as both are there.
  virtual bool filters() const { return false; }
  virtual bool may_collide(BodySlot, BodySlot) const { return true; }
  /// A body's filter, a number: bodies whose filters do not meet may not collide.
  virtual std::uint64_t filter_of(BodySlot) const { return 0; }
  virtual bool filters_meet(std::uint64_t, std::uint64_t) const { return true; }
  virtual void pair_began(BodySlot a, BodySlot b, double t) = 0;
  virtual void pair_ended(BodySlot a, BodySlot b, double t) = 0;
  /// If it lists the pairs of each body: calls visit(other) for each that has been reported as begun and not as ended,
  /// in any order, and returns true. Broad phases that keep no such lists then need no search for them.
  virtual bool visit_pairs(BodySlot, SlotVisitor) const { return false; }
  /// A hint: the box and the pairs of this body will soon be asked for.
  virtual void prefetch(BodySlot) const {}
};

/// From so many bodies on a world exceeds the caches, most of what an event needs is in none, and it pays to fetch it
/// ahead.
inline constexpr std::size_t more_than_caches = 4096;

/// Reports, at the right times and in order, which pairs of bodies have to be tested.
///
/// A body is identified by its slot, a small number that the owner of the bodies chooses, and may choose again for
/// another body at once when the body has been removed.
///
/// Semantic laws: (1) a pair is reported as begun no later than the instant its bounding volumes overlap (kinetic
/// boxes, with edges rounded by their `rounding` where `exact()` is false, or k-DOPs, see WorldOptions.kdop), and as
/// ended not before they cease to; (2) where `exact()` is true, at exactly those instants; (3) reports alternate for
/// each pair, beginning with pair_began, and removing a body ends its pairs; (4) a broad phase never reports a time
/// before the last it was given. Both reports of pairs that may not collide may be left out: such pairs then cost only
/// their repeated search. Exchanging one broad phase for another changes neither contacts nor their times.
///
/// (5) A query (visit_overlapping, visit_swept) visits each body whose bounding volume meets the box in question then:
/// none is missed, and none is visited twice. Volumes and boxes are closed, so those that touch meet; volumes are
/// kinetic boxes, without rounded edges, and k-DOPs. Other bodies that are near may be visited too, and which these are
/// depends on the broad phase. Queries do not change the state: several threads may make them at a time, while none
/// calls anything else.
template <int Degree>
class BroadPhase {
 public:
  /// A body that is added, and its bounding volume, which the caller keeps.
  struct Entry {
    BodySlot slot;
    const KineticBox<Degree>* box;
  };

  virtual ~BroadPhase() = default;

  /// Whether pairs are exactly those whose bounding volumes overlap.
  virtual bool exact() const = 0;

  /// A name of broad_phase_kind.hpp, or `few-boxes`: the default's method for a few bodies.
  virtual std::string_view name() const = 0;

  /// Adds bodies; cheapest when all come in one call. Pairs that overlap are reported. Preconditions, here and below:
  /// `now` is not before the last time given, a body that is added is not there yet, and one that is removed or updated
  /// is.
  virtual void insert(std::span<const Entry> bodies, double now, PairListener& listener) = 0;
  /// A hint: there will be bodies in all slots below `end`. Changes nothing that can be observed; what this makes room
  /// for then needs no time when bodies are inserted.
  virtual void reserve(BodySlot /*end*/) {}
  /// A hint: there are far fewer bodies than there were. Gives back memory that these do not need, and changes nothing
  /// that can be observed.
  virtual void fit() {}
  /// A hint: so many bodies, of slots below `end`, will be inserted soon, in parts; these are some of them. Changes
  /// nothing that can be observed.
  virtual void expect(std::size_t /*bodies*/, BodySlot /*end*/, std::span<const Entry> /*some*/, double /*now*/) {}
  /// Takes a body out. Its pairs end, and are reported.
  virtual void remove(BodySlot body, double now, PairListener& listener) = 0;

  /// Gives a body another box, also at another place (a jump). Pairs that begin and end are reported.
  virtual void update(BodySlot body, const KineticBox<Degree>& box, double now, PairListener& listener) = 0;

  /// A hint: a body will soon be updated.
  virtual void prefetch(BodySlot /*body*/) const {}

  /// Processes events not later than `limit` and returns true right after the first that reported a pair; false when
  /// all are done. Precondition: limit is finite.
  virtual bool advance(double limit, PairListener& listener) = 0;

  /// Time of the next event, `never` if none is known.
  virtual double next_time() const = 0;

  /// Sets the horizon: events later than this need not be known yet.
  virtual void extend_horizon(double now, double horizon) = 0;

  /// Calls visit(slot) for the bodies that may meet a box at rest now, in no particular order. Preconditions of this
  /// and the next: no end is a NaN; `now` or `from` is not before the last time given, nothing is due before it, and it
  /// is not beyond the horizon. Only queries may be called from within `visit`.
  virtual void visit_overlapping(const StaticBox& box, double now, SlotVisitor visit) const = 0;

  /// The same for a box that moves, at some time in [from, until], with the present motions of the bodies: with their
  /// present boxes, whatever `valid_until` is. Precondition: from <= until, both finite.
  virtual void visit_swept(const KineticBox<Degree>& box, double from, double until, SlotVisitor visit) const = 0;

  /// Checks the state against the motions; throws AuditFailure.
  virtual void audit(double now) const = 0;

  virtual BroadPhaseCounters counters() const = 0;
};

}  // namespace kds::collision
