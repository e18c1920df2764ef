// A world that knows a part of a scene: the bodies of a cell and those near it.
#pragma once

#include "collision/motions.hpp"
#include "collision/parallel/body_store.hpp"
#include "collision/parallel/division.hpp"
#include "collision/parallel/motion_changes.hpp"
#include "collision/parallel/parallel_options.hpp"
#include "collision/parallel/partition.hpp"
#include "collision/parallel/world_events.hpp"
#include "collision/world.hpp"
#include "collision/world/engine.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace kds::collision {

/// The outcome of a window, or of its last step, in a domain.
struct DomainReport {
  /// False if something has happened that domains cannot compute: a body rests, or is about to, on a fixed one that has
  /// an owner, an island reaches through the halo, a pair is let pass, contacts of a collapse go on, or a script takes
  /// a body far away at one instant.
  bool divisible = true;
  /// Whether the bodies that were not followed have stayed deep in the cell.
  bool stayed = true;
  /// How far owned bodies have left the cell, and bodies of their islands; and how far these were outside when the
  /// window began.
  double overshoot = 0;
  double begun_outside = 0;
  /// How near to this cell wrong copies have come, or their originals, from when they went wrong.
  double nearest_wrong = never;
  std::uint64_t wrong = 0;  ///< copies that have gone wrong
  std::uint64_t owned = 0;
  std::uint64_t known = 0;
  // Of the last step.
  std::array<std::uint64_t, 4> told{};  ///< events of each kind that the domain tells for the whole scene
  std::uint64_t computed = 0;           ///< all events, those of copies included

  bool went_through() const { return divisible && stayed; }
};

/// Another domain, to whose cell the bodies of a domain may come near in a window.
struct NeighbourDomain {
  DomainIndex domain;
  StaticBox cell;
  double nearest;  ///< how near to its cell a body has come that is owned here and not known there
};

/// A domain: a cell of space, and a world that knows the bodies in it, which it *owns*, and *copies* of those that are
/// not farther outside than the halo. It runs them for a window. Copies far outside the cell go wrong, since the bodies
/// beyond them are not known. When the owners have told what happened to their bodies, each domain finds out how near
/// to its cell any body came that it did not know, or knew wrongly; docs/parallel.md says what follows.
///
/// Owned bodies deeper in the cell than twice the halo are not followed one by one: that they stay deeper than the halo
/// is checked.
template <class Motion>
class Domain final : private BasicWorldListener<Motion> {
 public:
  using World = BasicWorld<Motion>;
  using Overlap = typename Transfer<Motion>::Overlap;
  using Change = MotionChange<Motion>;

  /// `logs`: whether events are recorded. `first`: of the domains with one store, this tells it of bodies without an
  /// owner. The division must outlive the domain.
  Domain(const WorldOptions& options, const Division& division, std::size_t index, double now, bool logs, bool first);
  Domain(const Domain&) = delete;
  Domain& operator=(const Domain&) = delete;

  /// Lets bodies go, and takes others in as `store` has them; both by their numbers, ascending. `overlaps`: all pairs
  /// of bodies known here from then on that overlap, by their numbers.
  void exchange(std::span<const BodySlot> go, std::span<const BodySlot> come, const BodyStore<Motion>& store,
                std::span<const Overlap> overlaps);
  /// Begins a window: finds the owners of the bodies in the division.
  void begin_window();

  /// Runs a step of the window.
  void run(double until);
  /// Compares the copies with what their owners know. `changes`: of each neighbour, those of its bodies known here at
  /// least.
  void compare(std::span<const std::span<const Change>> changes);

  const DomainReport& report() const { return report_; }
  /// By domain, ascending. An owned body that has stayed in the halo is not known to any other.
  std::span<const NeighbourDomain> neighbours() const { return neighbours_; }
  /// Numbers of copies that have gone wrong in this window, ascending.
  std::span<const BodySlot> wrong() const { return wrong_; }
  /// The motions that bodies have been given in this window, of copies and of owned bodies that others know.
  std::span<const Change> changes() const { return changes_.all(); }
  /// Those of them that are of the last step.
  std::span<const Change> fresh() const { return fresh_; }
  std::vector<DomainEvent> take_events() { return std::move(events_); }
  std::size_t index() const { return index_; }
  WorldCounters work() const { return world_.counters(); }
  std::string_view broad_phase() const { return world_.broad_phase(); }

  /// Tells `store` of the bodies of this domain that have changed. Domains may do the first at once, the second one by
  /// one.
  void commit(BodyStore<Motion>& store);
  void commit_resting(BodyStore<Motion>& store) const;
  /// Numbers of owned bodies that the last step has changed.
  void append_changed(std::vector<BodySlot>& numbers) const;
  /// The pairs that overlap of which this domain knows all, by numbers; the lower first.
  std::vector<Overlap> overlaps() const;
  /// Finds the owned bodies that have moved to where others are to own or know them. `store`: has the owned bodies as
  /// they are at t.
  void find_moves(const BodyStore<Motion>& store, double t);
  const BodyMoves& moves() const { return moves_; }
  /// Bodies that are known here, and those that lean on them or are attached to these; by numbers, ascending.
  std::vector<BodySlot> with_islands(std::span<const BodySlot> numbers) const;

 private:
  enum class Role : std::uint8_t { unowned, deep, followed, copy };
  /// A followed body: how it moves, and since when that is recorded.
  struct Followed {
    BodySlot slot;
    std::uint32_t strangers;  ///< which of strangers_
    double since;
    Motion motion;
  };
  struct Copy {
    BodySlot number;
    std::uint32_t owner;  ///< which of the neighbours it is
    Motion motion;        ///< when the window began
  };
  /// What a body is here.
  struct Known {
    Role role = Role::unowned;
    bool changed = false;     ///< in this step, and this domain tells the store
    std::uint32_t place = 0;  ///< of followed bodies: in followed_; of copies: of the owner in neighbours_
  };
  /// Who is to own and to know the owned bodies that lean on others, and what is attached to them.
  struct Islands {
    struct Place {
      DomainIndex owner;
      std::size_t island;
    };
    std::map<BodySlot, Place> of{};                   ///< by slot
    std::vector<std::vector<DomainIndex>> knowers{};  ///< of islands
  };
  void contact(World&, const PairEvent& event) override;
  void separation(World&, const PairEvent& event) override;
  void overlap(World&, const PairEvent& event) override;
  void wall(World&, const WallEvent& event) override;
  void piece(World&, BodyId id) override;
  void moved(World&, BodyId id) override;
  using Kind = DomainEvent::Kind;
  void rebound_suppressed(World&, const PairEvent& event) override { rest(Kind::rebound_suppressed, event); }
  void rests(World&, const PairEvent& event) override { rest(Kind::rests, event); }
  void wakes(World&, const PairEvent& event) override { rest(Kind::wakes, event); }
  void rebound_suppressed_at_wall(World&, const WallEvent& event) override {
    rest(Kind::rebound_suppressed_at_wall, event);
  }
  void rests_at_wall(World&, const WallEvent& event) override { rest(Kind::rests_at_wall, event); }
  void wakes_at_wall(World&, const WallEvent& event) override { rest(Kind::wakes_at_wall, event); }
  void passes(World&, const PairEvent& event) override;

  BodySlot number(BodySlot slot) const { return engine_.bodies().number(slot); }
  /// The id in the scene of a body that has this one here.
  BodyId key(BodyId here) const { return engine_.bodies().keys().key(body_slot(here)); }
  /// Where a body is in slots_, or would be.
  std::size_t place_of(BodySlot number) const;
  std::uint32_t strangers_to(BodySlot number);
  void begin_to_follow(BodySlot slot, double t);
  void begin_islands();
  void note_islands();
  void note_touched();
  void mark(std::span<const BodySlot> island, const DomainEvent::Cause& cause, double t);
  void find_islands(double t);
  bool leans(BodySlot slot) const;
  BodySlot slot_of(BodySlot number) const { return slots_[place_of(number)]; }
  DomainIndex owner_of(BodySlot slot) const;
  bool is_first_to_know(BodySlot a, BodySlot b) const;
  void record(DomainEvent::Kind kind, const PairEvent& event);
  void rest(DomainEvent::Kind kind, const PairEvent& event);
  void rest(DomainEvent::Kind kind, const WallEvent& event);
  bool tells_of_wall(BodySlot slot) const;
  void begin_cause(DomainEvent::Cause::Phase phase, BodyId a, BodyId b, double t);
  DomainEvent::Cause cause_at(double t);
  void put(const DomainEvent& event);
  void mark_changed(BodySlot slot);
  void changed(BodySlot slot, double t);
  void note_change(BodySlot slot, double t);
  void note_pieces(double since);
  void follow(Followed& body, double until);
  void follow_outside(const Followed& body, double until);
  bool stays_deep(const Eigen::Vector3d& place) const {
    return inside(place, division_.partition.cell(index_)) - bulge_ >= division_.halo;
  }

  const Division& division_;
  const std::size_t index_;
  const bool logs_;
  const bool first_;
  const bool resolves_;  ///< whether contacts change motions
  const bool by_law_;    ///< whether a law of the caller's says how
  World world_;
  Engine<Motion>& engine_;
  std::vector<BodySlot> slots_;  ///< of the bodies that are known, ascending by their numbers
  std::vector<Known> known_;     ///< by slot
  std::vector<Followed> followed_;
  std::map<BodySlot, Followed> shared_copies_;  ///< copies in islands of owned bodies, by slot
  Islands islands_, next_islands_;              ///< those near borders, when a step was last committed, and of the last
  std::vector<Copy> copies_;                    ///< by number
  std::vector<BodySlot> changed_;               ///< slots of the bodies of which this step tells the store
  std::vector<Change> fresh_;                   ///< as changes_, of this step; sorted by number when it is over
  MotionChanges<Motion> changes_;               ///< of this window, of bodies that others know or own
  std::vector<DomainEvent> events_;
  DomainEvent::Cause cause_;     ///< the last event from which others may follow
  double caused_at_ = -never;    ///< s
  std::uint64_t ends_seen_ = 0;  ///< RestingEvent::count, then
  std::size_t caused_from_ = 0;  ///< place in events_ from which on they follow from it
  std::vector<BodySlot> wrong_;
  BodyMoves moves_;
  std::vector<NeighbourDomain> neighbours_;
  /// By places in neighbours_, those to whom bodies are not known that are known to a set of domains; which, by the
  /// set.
  std::vector<std::vector<std::uint32_t>> strangers_;
  std::unordered_map<DomainSets::Number, std::uint32_t> strangers_to_;
  double bulge_ = 0;  ///< how far the paths of deep bodies may leave the chords between two of their places
  DomainReport report_;
};

#define KDS_DECLARE(motion) extern template class Domain<motion>;
KDS_FOR_ALL_MOTIONS(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
