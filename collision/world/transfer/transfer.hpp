// Bodies that several worlds have, each for a part of the scene.
#pragma once

#include "collision/world/callers_clock.hpp"
#include "collision/world/edits/edits.hpp"
#include "collision/world/guard.hpp"
#include "collision/world/membership.hpp"
#include "collision/world/transfer/body_progress.hpp"
#include "collision/world/transfer/parcel.hpp"
#include "collision/world/world_parts.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace kds::collision {

/// How the bodies of one world are divided among several (parallel/parallel_world.hpp), and come back into one.
///
/// A world takes in bodies of another one in the middle of their history, and all that follows is the same, bit for
/// bit: they have the motions, scripts and counts of the other world, their pairs begin as pairs of bodies that move
/// past each other do, and pairs that overlap there overlap here.
template <class Motion>
class Transfer {
 public:
  /// Two bodies, by slots, that overlap, and Pair::passes_at.
  struct Overlap {
    BodySlot a, b;
    double passes_at;
  };

  Transfer(WorldParts<Motion>& parts, Membership<Motion>& membership, Edits<Motion>& edits, Guard& guard,
           CallersClock& callers)
      : parts_(parts), membership_(membership), edits_(edits), guard_(guard), callers_(callers) {}
  Transfer(const Transfer&) = delete;
  Transfer& operator=(const Transfer&) = delete;

  // transfer.cpp
  /// Whether descriptions, scripts and progress of bodies, what rests of each of them, and the pairs that overlap,
  /// decide all later events; in mode `callback` with a law.
  bool is_divisible() const;
  /// Takes in bodies of another world with the same options and clock, by their slots there; their numbers ascend.
  /// Those that have not entered there enter with the next step, or when their motion begins. What leans on each other
  /// comes together, and so do a sensor and the body to which it is attached. `known`: the slots of the bodies that
  /// were taken in before, by their numbers. `ignored`: by numbers. Returns the slots, in the same order.
  std::vector<BodySlot> take_in(const Transfer& from, std::span<const BodySlot> slots, std::span<const BodySlot> known,
                                const IgnoredPairs& ignored);
  /// Removes bodies that another world goes on with, whole islands of them: nothing is reported.
  void let_go(std::span<const BodySlot> slots);
  /// The overlaps of bodies that have been taken in, by their slots here.
  void go_on_overlapping(std::span<const Overlap> overlaps);
  std::vector<Overlap> overlaps() const;
  BodyProgress<Motion> progress(BodySlot slot) const;
  /// A body that belongs to another world continues from its state there. The first, for different bodies, may be
  /// called by several threads at once.
  void go_on_from(BodySlot slot, const BodyProgress<Motion>& progress);
  using Resting = typename RestingPart<Motion>::Progress;
  /// The islands of a world whose bodies belong to another one.
  RestingPart<Motion>& islands() { return parts_.resting; }
  /// What rests of a body of a world that runs.
  Resting resting(BodySlot slot) const { return parts_.resting.progress(slot); }
  /// The same of one that has been set aside, or only stores bodies: what it has been told last.
  Resting kept_resting(BodySlot slot) const { return parts_.resting.kept()[slot]; }
  void keep_resting(BodySlot slot, const Resting& resting) { parts_.resting.kept().keep(slot, resting); }
  /// As RestingContacts::take_solved().
  std::vector<BodySlot> take_solved() { return parts_.resting.take_solved(); }
  /// Other worlds have run to t: bodies have entered, pieces of scripts have begun, timers have rung.
  void note_passed(double t);
  /// Forgets all but the bodies, until go_on().
  void set_aside();
  /// Goes on at t with the bodies as they are then.
  void go_on(double t, std::span<const Overlap> overlaps);

  // parcels.cpp
  /// Bodies of a world that only stores a part of them, as plain data. `meshes`: all meshes of the scene.
  Parcel<Motion> pack(std::span<const BodySlot> slots, std::vector<std::shared_ptr<const Mesh>> meshes) const;
  /// Stores those of a parcel, whose numbers are slots of `whole`; attach() follows. Returns the slots, in order.
  std::vector<BodySlot> store(const Parcel<Motion>& parcel, const Bodies<Motion>& whole);
  void attach(BodySlot sensor, BodySlot owner) { parts_.bodies.attach(sensor, owner); }
  /// Forgets bodies that have been stored.
  void forget(std::span<const BodySlot> slots);
  /// The bodies that have been added get the numbers `first`, `first` + 1, ...
  void number_from(BodySlot first) { parts_.bodies.number_from(first); }
  /// Others store the bodies of this world, and it forgets them until take_back(); then they are put_back() one by one,
  /// and it is whole with go_on(). `bodies`: of so many that have been added elsewhere.
  void lend();
  void lend(std::size_t bodies) { parts_.bodies.lend(bodies); }
  void take_back() { parts_.bodies.take_back(); }
  void put_back(const Parcel<Motion>& parcel);

 private:
  bool has_begun(BodySlot slot) const { return parts_.bodies.path(slot).start <= parts_.clock.now; }
  BodySlot slot_among(std::span<const BodySlot> slots, BodySlot of) const;
  void relate(const Bodies<Motion>& from, std::span<const BodySlot> slots, std::span<const BodySlot> taken,
              std::span<const BodySlot> known, const IgnoredPairs& ignored);
  void resume(const Parcel<Motion>& parcel, std::size_t place, BodySlot slot);

  WorldParts<Motion>& parts_;
  Membership<Motion>& membership_;
  Edits<Motion>& edits_;
  Guard& guard_;
  CallersClock& callers_;
};

}  // namespace kds::collision
