// Bodies that turn, at rest on each other and on fixed bodies.
#pragma once

#include "collision/body_motion.hpp"
#include "collision/narrow_phase/contact.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/response/static_balance.hpp"
#include "collision/response/turning_impulse.hpp"
#include "collision/world/bodies.hpp"
#include "collision/world/clock.hpp"
#include "collision/world/image_tools.hpp"
#include "collision/world/resting/kept_progress.hpp"
#include "collision/world/resting/resting_contact.hpp"
#include "collision/world/resting/shared_islands.hpp"
#include "collision/world/turning/carrier.hpp"
#include "collision/world/turning/collapse.hpp"
#include "collision/world/turning/turning_rest_progress.hpp"
#include "collision/world/world_part.hpp"
#include "collision/world_options.hpp"
#include "kds/arithmetic/lattice.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace kds::collision {

template <class Motion>
class RestingListener;

/// Rest in worlds of bodies that turn: not of contacts that roll, but of groups of bodies that do not move at all, or
/// only with what carries them. Of contacts that slide those with a half-space that goes on below what is held fast, as
/// a belt below crates at a stop. docs/turning.md states the law.
///
/// Bodies that are pressed together make flights of WorldOptions::shortest_flight, again and again. A body is *calm*
/// while no point of it is faster than such flights make it, seen from the fixed body that it lies on, directly or
/// through others: that may move as a belt or a lift does, at a constant velocity or acceleration. Where calm bodies
/// touch is noted. A group is all bodies that are linked by such places, down to fixed ones. When all bodies of a group
/// have been calm for some flights, and forces at these places within the cones of friction hold them all
/// (static_balance.hpp), they come to rest: from then on they move with those fixed bodies, mostly not at all, and cost
/// nothing. Bodies of a group that are held without its other bodies come to rest after a while even if those move. An
/// impact wakes the bodies that it moves, and those that they have held; a change of a body, or of a support, wakes the
/// whole group. A calm body wakes nothing that it touches: if forces hold it too, it comes to rest as well, and if not,
/// those bodies wake that cannot carry it.
///
/// This part of World owns its state. It reads the bodies, and tells its listener what follows. All of it is a function
/// of contacts and edits, and does not depend on the broad phase, windows or snapshots.
///
/// Cost: O(log n) a contact of calm bodies; nothing for others, and nothing while bodies rest.
template <class Motion>
class TurningRest {
 public:
  static constexpr Stage stage = Stage::reported;

  using Slot = std::uint32_t;
  using Contact = detail::RestingContact;
  static constexpr Slot none = ~Slot{0};

  using Listener = RestingListener<Motion>;

  TurningRest(const Bodies<Motion>& bodies, const WorldOptions& options, const Clock& clock)
      : bodies_(bodies), flight_(options.shortest_flight), clock_(clock), blows_(options.zeno.interval) {}
  TurningRest(const TurningRest&) = delete;
  TurningRest& operator=(const TurningRest&) = delete;
  /// It must be set before anything rests.
  void set_listener(Listener& listener) { listener_ = &listener; }

  bool empty() const { return resting_ == 0; }
  bool holds(BodySlot a, BodySlot b, int = -1) const { return find(a, b) != none; }
  /// Not `none` if a and b, in their order, rest on each other.
  Slot find(BodySlot a, BodySlot b, int = -1) const;
  /// Whether a body rests, and so has not the motion that callers gave.
  bool carries(BodySlot slot) const { return slot < of_.size() && of_[slot].rests; }
  bool keeps_apart(Slot) const { return true; }
  ContactEstimate next_contact(BodySlot, BodySlot, double) const { return {never, true}; }

  /// Two bodies are about to meet. Returns whether one of them rests and the impulse decides whether it wakes. It does
  /// not if the other is calm: that body may lie on it soon, and until then bounces off it as off a fixed body.
  bool meet(BodySlot a, BodySlot b);
  using MobilityOf = std::function<Mobility(BodySlot)>;
  /// Two bodies have met, and move as they do after their impulses. Returns whether they, and all bodies of their
  /// group, have come to rest.
  bool comes_to_rest(BodySlot a, BodySlot b, const collision::Contact& contact, const MobilityOf& mobility);
  /// To be called if meet() returned true, with the impulse on b as if the resting body were fixed, and the angular
  /// impulses on both. If the resting body and those that it lies on take the impulse without moving, nothing changes;
  /// if not, the bodies that it moves wake, and those that they have held. Returns whether any wakes.
  bool strike(BodySlot a, const Eigen::Vector3d& turn_a, BodySlot b, const Eigen::Vector3d& turn_b,
              const Eigen::Vector3d& impulse, const MobilityOf& mobility);

  /// Two bodies strike each other that have both met others often within ZenoPolicy::interval. Returns the contacts of
  /// that time that have to be resolved together with this one, which is the first of them (collapse.hpp).
  std::vector<detail::Blow> note_blow(const detail::Blow& blow);

  /// A body jumps, is removed, or gets a motion from a caller: what it rests on, and what rests on it, wakes.
  void drop_all(BodySlot slot);
  void forget(BodySlot slot) { drop_all(slot), kept_.forget(slot); }
  /// The same if it has touched a body that it may not collide with any more; otherwise forgets only its contacts of a
  /// collapse, and returns false.
  bool drop_filtered(BodySlot slot);
  /// The bodies that a body rests on, and those that rest on it.
  std::vector<BodySlot> partners(BodySlot slot) const;
  void leave(BodySlot slot) { drop_all(slot); }
  void disturb(BodySlot) {}
  bool solved() const { return woken_.empty(); }
  /// Gives bodies that have woken their motions.
  void solve();

  static constexpr double next_time() { return never; }
  static constexpr bool certify() { return false; }
  static void process() {}
  static void extend_horizon() {}
  /// Throws AuditFailure unless bodies that rest move with what they rest on.
  void audit(double t) const;

  // turning_rest_transfer.cpp: bodies that several worlds have, each a part of them (transfer.cpp).
  using Progress = TurningRestProgress;
  /// Whether the progress of each body is all there is: nothing is still to be solved, and no contacts are remembered
  /// that a collapse may have to be resolved with.
  bool divisible() const { return solved() && !blows_.any(clock_.now); }
  Progress progress(BodySlot slot) const;
  /// As RestingContacts, as are the next six.
  void go_on_from(BodySlot slot, const Progress& progress, const std::function<BodySlot(BodySlot)>& slot_of);
  void require_listed() { of_both_.require_listed(); }
  void let_go(BodySlot slot);
  void set_aside();
  void go_on() { kept_.give_back(bodies_, *this); }
  KeptProgress<Progress>& kept() { return kept_; }
  const KeptProgress<Progress>& kept() const { return kept_; }
  static detail::RestingEvent last_event() { return {}; }  ///< it has none of its own
  static std::vector<BodySlot> take_solved() { return {}; }

  /// The bodies that are not fixed on which one depends, its island: those with which it lies, or is about to, or has a
  /// collapse, directly or through others; in their order.
  std::vector<BodySlot> island(BodySlot slot) const;
  /// Whether there are others in it.
  bool leans(BodySlot slot) const;
  SharedIslands& shared() { return shared_; }
  /// SharedIslands::begin(), with the islands that there are.
  void begin_shared();
  /// A collapse gives a body another motion.
  void touch(BodySlot slot) {
    if (shared_.any_copies()) touched_.push_back(slot);
  }
  /// In a world that may have copies: the bodies of which the motion has changed, or the progress, since this was
  /// called last, some several times. Of two bodies that meet only what is not theirs alone.
  std::vector<BodySlot> take_touched() { return std::exchange(touched_, {}); }
  /// Whether a body lies, or is about to, on a fixed one of which this is true.
  template <class Is>
  bool lies_on(BodySlot slot, const Is& is) const {
    if (slot >= of_.size() || bodies_.fixed(slot)) return false;
    return std::ranges::any_of(of_[slot].others, [&](BodySlot other) { return bodies_.fixed(other) && is(other); });
  }

  using Ignored = turning_rest::Ignored;

  /// All of it, as plain data.
  struct Image {
    struct One {
      BodySlot a = 0, b = 0;
      detail::LyingPair pair;
    };
    std::vector<One> pairs;     ///< in order
    std::vector<double> since;  ///< by body, as are the next three
    std::vector<double> looked;
    std::vector<char> rests;
    std::vector<Ignored> ignored;
    std::vector<turning_rest::Carrier> carriers;  ///< by body
    std::vector<BodySlot> woken;
    std::vector<detail::Blow> blows;  ///< in the order of their times

    template <class Archive>
    void archive(Archive& archive) {
      archive(since, looked, rests, ignored, woken);
      archive.each(carriers, [&](turning_rest::Carrier& carrier) { archive(carrier); });
      archive.each(pairs, [&](One& one) { archive(one.a, one.b, one.pair); });
      archive.each(blows, [&](detail::Blow& blow) { archive(blow); });
    }
    /// Throws std::runtime_error, naming what is wrong.
    void check(const typename Bodies<Motion>::Image& bodies, double now, const WorldOptions& options) const;
  };
  Image image() const;
  void become(const Image& image);

 private:
  using Key = std::pair<BodySlot, BodySlot>;  ///< in their order
  using Pair = detail::LyingPair;

  /// The state of a body.
  struct Member {
    std::vector<BodySlot> others;  ///< with which there is a pair, in their order
    double since = never;          ///< s; since when it is calm
    double looked = -never;        ///< s; when its group was last found not to be at rest
    bool rests = false;
    Ignored ignored;
    turning_rest::Carrier carrier;  ///< if there are others: how what they lie on moves
    std::uint64_t seen = 0;         ///< the last walk that has visited it
    std::uint32_t place = 0;
  };
  /// Of the bodies of a pair that are not fixed.
  struct Scale {
    double acceleration = 0;  ///< the greatest
    double size = never;      ///< the smallest bounding radius
    double driven = 1;        ///< how much faster than one corner's flights those of many make them
  };
  struct Group {
    std::vector<BodySlot> bodies;  ///< none of them fixed
    std::vector<Load> loads;
    std::vector<Foothold> footholds;
    std::vector<Key> pairs;              ///< of each foothold
    std::vector<char> busy;              ///< by body: whether it cannot rest yet, by itself or by what it lies on
    std::vector<char> leans;             ///< by body: whether it leans on one that is busy
    std::vector<std::uint32_t> sliding;  ///< places of bodies that slide without friction
    bool any_busy() const;
  };

  Member& member(BodySlot slot) {
    if (of_.size() <= slot) of_.resize(slot + std::size_t{1});
    return of_[slot];
  }
  auto before() const {
    return [this](BodySlot a, BodySlot b) { return bodies_.before(a, b); };
  }
  Pair& pair(Key key);
  Pair& list(Key key);
  void unlist(Key key);
  void erase(Key key);
  void erase_all(BodySlot slot);
  void wake(BodySlot slot);
  void wake_only(std::span<const BodySlot> slots);

  turning_rest::Carrier carrier(BodySlot slot) const;
  Eigen::Vector3d half_weight(BodySlot slot) const;
  double acceleration(BodySlot slot) const;
  Scale scale(Key key) const;
  double holding_distance(const Scale& scale) const;
  double calm_speed(const Scale& scale) const;
  std::optional<turning_rest::Carrier> common_carrier(BodySlot a, BodySlot b) const;
  std::optional<Eigen::Vector3d> slides_under(BodySlot slot, const turning_rest::Carrier& carrier) const;
  bool stays_below(BodySlot slot, const turning_rest::Carrier& carrier) const;
  std::optional<Eigen::Vector3d> slip(Key key, const turning_rest::Carrier& carrier) const;
  bool calm(BodySlot slot, double acceleration, const turning_rest::Carrier& carrier) const;
  bool slides(Key key, const Eigen::Vector3d& normal, const std::optional<Eigen::Vector3d>& away) const;
  void note_what_slides_on(Group& group, const MobilityOf& mobility) const;
  void note(Key key, const collision::Contact& contact, const turning_rest::Carrier& carrier);
  Group find_group(BodySlot first, bool resting = false);
  bool ready(BodySlot slot, double acceleration) const;
  /// The group without some of its bodies, by place, and without those that then touch nothing.
  static Group without(const Group& group, std::vector<char> out);
  /// The largest part of a group that is found to be in balance; `removed`: something that rests has been taken out of
  /// it.
  Group held_part(Group group, bool removed) const;
  void stop(const Group& group, const collision::Contact& contact, Key met);

  // turning_rest_transfer.cpp
  template <class Take>
  void each_partner(BodySlot slot, const Take& take) const;
  void note_linked(BodySlot a, BodySlot b);
  void note_struck(BodySlot a, BodySlot b);

  const Bodies<Motion>& bodies_;
  const double flight_;
  const Clock& clock_;
  Listener* listener_ = nullptr;
  std::map<Key, Pair> pairs_;
  std::vector<Member> of_;  ///< by body, up to the last that has been calm
  std::vector<BodySlot> woken_;
  std::size_t resting_ = 0;  ///< pairs that rest
  std::uint64_t walks_ = 0;
  detail::Blows blows_;
  KeptProgress<Progress> kept_;
  ContactsOfBoth of_both_;
  std::vector<BodySlot> touched_;  ///< take_touched()
  SharedIslands shared_;
};

#ifdef KDS_TURNING
extern template class TurningRest<certificates::RigidMotion<1>>;
extern template class TurningRest<certificates::RigidMotion<2>>;
#endif

}  // namespace kds::collision
