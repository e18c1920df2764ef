// Contacts that last: bodies that lie, lean and slide on each other and on walls.
#pragma once

#include "collision/motions.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/response/least_constraint.hpp"
#include "collision/world/bodies.hpp"
#include "collision/world/clock.hpp"
#include "collision/world/resting/contact_gaps.hpp"
#include "collision/world/resting/kept_progress.hpp"
#include "collision/world/resting/resting_contact.hpp"
#include "collision/world/resting/resting_progress.hpp"
#include "collision/world/resting/shared_islands.hpp"
#include "collision/world/turning/turning_rest.hpp"
#include "collision/world/world_part.hpp"
#include "collision/world_options.hpp"
#include "kds/events/dary_queue.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

namespace kds::collision {

namespace detail {

using RestingSlot = std::uint32_t;

/// The order of resting contacts: by the keys of their bodies, those at walls last.
struct RestingRank {
  const std::vector<RestingContact>* contacts;
  const BodyKeys* keys;
  PairKey operator()(std::uint32_t slot) const {
    const RestingContact& contact = (*contacts)[slot];
    return {keys->key(contact.a), contact.b == no_body ? ~BodyId{0} : keys->key(contact.b)};
  }
};

}  // namespace detail

/// The sum of the magnitudes of the terms that a velocity at t is made of.
template <int Degree>
double velocity_terms(const certificates::PointMotion<Degree>& motion, double t) {
  double sum = 0;
  for (std::size_t i = Degree; i >= 1; --i) {
    sum = sum * std::abs(t - motion.start) + static_cast<double>(i) * motion.coefficients[i].cwiseAbs().maxCoeff();
  }
  return sum;
}

/// The listener of resting contacts.
template <class Motion>
class RestingListener {
 public:
  virtual void take_up(BodySlot id, const Motion& motion) = 0;  ///< a new motion
  virtual void changed(BodySlot a, BodySlot b) = 0;             ///< the next contact of the two has to be found anew
  virtual void let_pass(BodySlot a, BodySlot b) = 0;
  virtual void tell_rebound_suppressed(BodySlot a, BodySlot b) = 0;  ///< the Zeno policy has acted on the two
  /// A contact begins or ceases to last.
  virtual void tell_resting(bool begins, const detail::RestingContact& contact) = 0;
  virtual void tell_passes(const detail::RestingContact& contact) = 0;
  /// In a world whose bodies belong to another one: what rests of a body may have changed, though it moves as before.
  virtual void tell_touched(BodySlot id) = 0;

 protected:
  ~RestingListener() = default;
};

/// The resting contacts of a world: which there are, how the bodies move that rest on each other, and when they part.
/// docs/resting.md states the law.
///
/// This part of World owns its state and its queue. It reads the bodies, and tells its listener what follows.
///
/// Cost: nothing while nothing rests. O(1) a contact that begins or ends; a change of motion of a body that rests
/// solves for all bodies of its island (least_constraint.hpp).
template <class Motion>
class RestingContacts {
 public:
  static constexpr Stage stage = Stage::reported;

  using Slot = detail::RestingSlot;
  using Contact = detail::RestingContact;
  static constexpr Slot none = ~Slot{0};

  using Listener = RestingListener<Motion>;

  RestingContacts(const Bodies<Motion>& bodies, const WorldOptions& options, const Clock& clock)
      : bodies_(bodies),
        clock_(clock),
        gaps_(bodies, options.walls, clock),
        releases_(detail::RestingRank{&contacts_, &bodies.keys()}),
        spans_(BodyRank{&bodies.keys()}) {}
  RestingContacts(const RestingContacts&) = delete;
  RestingContacts& operator=(const RestingContacts&) = delete;
  /// It must be set before anything rests.
  void set_listener(Listener& listener) { listener_ = &listener; }

  /// Whether there are any.
  bool empty() const { return contacts_.size() == free_.size(); }
  /// A contact of a and b, in their order, or of a and a wall (b: no_body); `none` if there is none.
  Slot find(BodySlot a, BodySlot b, int wall = -1) const { return rests(a) ? find_among(a, b, wall) : none; }
  /// Whether the two have a resting contact that keeps them from coming nearer; in a cluster only those that push do.
  bool holds(BodySlot a, BodySlot b, int wall = -1) const {
    const Slot slot = find(a, b, wall);
    return slot != none && (contacts_[slot].push > 0 || !(clustered(a) || (b != no_body && clustered(b))));
  }
  bool rests(BodySlot id) const { return id < of_.size() && !of_[id].contacts.empty(); }

  /// A contact begins to last. Between meshes several may last at once, in a groove, say; one for each normal.
  void add(const Contact& contact);
  /// All contacts of a body end, since it jumps.
  void drop_all(BodySlot id);
  /// Those contacts of a body end whose two bodies may not collide any more; false if there were none.
  bool drop_filtered(BodySlot id);
  /// The bodies that a body rests on, and those that rest on it.
  std::vector<BodySlot> partners(BodySlot id) const;
  /// All contacts of a body end, since it is removed.
  void forget(BodySlot id) {
    drop_all(id);
    if (id < spans_.slots()) spans_.clear(id);
    if (id < of_.size()) {
      of_[id] = {};
    }
    kept_.forget(id);
  }

  /// A caller moves a body: it leaves its cluster.
  void leave(BodySlot id) {
    if (!clustered(id)) return;
    of_[id].span_ends = -never;
    if (id < spans_.slots()) spans_.clear(id);
  }

  /// A surface that moves on its own strikes a body. Returns the velocity that the body has from now on, along the
  /// normal, a unit vector, at least this. What leans on it is driven with it, so that none of these contacts
  /// approaches.
  Eigen::Vector3d drive(BodySlot id, const Eigen::Vector3d& normal, double velocity);

  /// The motion of a body or its contacts have changed: solve() is to look at it, and at those that rest on it or that
  /// it rests on. A fixed body moves on as before when it begins or ceases to carry another, so that does not concern
  /// what else it carries.
  void disturb(BodySlot id) {
    if (!contacts_.empty() || clustered(id)) note(id);
  }
  bool solved() const { return disturbed_.empty(); }
  /// Gives all disturbed bodies the motions that their contacts allow.
  void solve() {
    if (!solved()) solve_all();
  }

  /// Whether a plane is proven to stay between the two bodies of a contact, so that they do not meet until a motion or
  /// the contact changes.
  bool keeps_apart(Slot contact) const { return contacts_[contact].proven && !gaps_.concave(contacts_[contact]); }
  /// When two bodies that rest on each other meet elsewhere, from a time on; or, where one of them is a mesh, how far
  /// ahead that was looked for. Then it is asked again with that time.
  ContactEstimate next_contact(BodySlot a, BodySlot b, double from);
  /// How two bodies that rest on each other touch at t.
  collision::Contact contact_at(BodySlot a, BodySlot b, double t, const FoundTouch& found) const;

  /// When the next contact ends, by sliding off or parting; process() ends it.
  double next_time() const {
    return std::min(releases_.empty() ? never : releases_.top().time, spans_.empty() ? never : spans_.top().time);
  }
  static constexpr bool certify() { return false; }
  void process();
  void extend_horizon();

  /// Whether a body belongs to a cluster: bodies in sustained contact that are advanced together, span by span.
  bool clustered(BodySlot id) const { return id < of_.size() && of_[id].span_ends != -never; }
  /// Whether its motion is not the one that callers gave.
  bool carries(BodySlot id) const { return rests(id) || clustered(id); }
  /// A contact of two bodies, or of a body and a wall, of which one is in a cluster. Precondition: they approach.
  void impact(const Contact& contact, double restitution);
  /// The cluster of a body moves as one for a span, since its impacts do not end.
  void halt(BodySlot id);
  /// Two bodies that are not fixed have met.
  void note_meeting(BodySlot a, BodySlot b) { note_meeting(a), note_meeting(b); }
  void note_meeting(BodySlot id) { member(id).met = true; }
  /// Makes a cluster of all that leans on a body that is not fixed.
  void gather(BodySlot id) { gather(id, clock_.now); }
  /// Whether a cluster of the two would have a span: something accelerates them.
  bool can_gather(BodySlot a, BodySlot b) const {
    return (!bodies_.fixed(a) && longest_span(a) < never) || (!bodies_.fixed(b) && longest_span(b) < never);
  }

  // resting_transfer.cpp: bodies that several worlds have, each a part of them (transfer.cpp).
  using Progress = RestingProgress;
  /// Whether the progress of each body is all there is: nothing is still to be solved, and each cluster has a span.
  bool divisible() const;
  /// Of a body; of a fixed one, what rests of it at walls.
  Progress progress(BodySlot id) const;
  /// A body without contacts goes on from there. `slot_of`: gives the slot of a body by its number, `no_body` if it is
  /// not here: then std::runtime_error is thrown. What leans on each other goes on together; require_listed() follows.
  void go_on_from(BodySlot id, const Progress& progress, const std::function<BodySlot(BodySlot)>& slot_of);
  /// Throws std::runtime_error if a body that has gone on leans on one that does not lean on it.
  void require_listed() { of_both_.require_listed(); }
  /// A body is removed with which another world goes on, and all that leans on it with it: nothing is told, and what is
  /// fixed goes on as it was.
  void let_go(BodySlot id);
  /// Other worlds run the bodies from now on: this one only keeps the progress of each, until go_on().
  void set_aside();
  void go_on() { kept_.give_back(bodies_, *this); }
  KeptProgress<Progress>& kept() { return kept_; }
  const KeptProgress<Progress>& kept() const { return kept_; }
  /// The last event of process(), and, in a world whose bodies belong to another one, the bodies whose contacts have
  /// been solved for since this was called last, some of them several times.
  const detail::RestingEvent& last_event() const { return last_event_; }
  std::vector<BodySlot> take_solved() { return std::exchange(solved_, {}); }

  /// Whether it leans on a body that is not fixed.
  bool leans(BodySlot id) const;
  /// Its island: the bodies that lean on each other, directly or not, and are not fixed; in their order.
  std::vector<BodySlot> island(BodySlot id) const;
  SharedIslands& shared() { return shared_; }
  /// SharedIslands::begin(), with the islands that there are.
  void begin_shared();

  /// Checks all contacts, once the bodies have the motions that these allow; throws AuditFailure.
  void audit(double t) const;

  /// All of it, as plain data.
  struct Image {
    std::vector<Contact> contacts;
    std::vector<Slot> free;
    std::vector<BodySlot> disturbed;
    std::vector<std::vector<Slot>> of;  ///< by body
    std::vector<double> releases;       ///< by contact
    std::vector<double> span_ends;      ///< by body, as many as `of`
    std::vector<double> calm_since;     ///< by body
    std::vector<char> met;              ///< by body
    std::vector<double> spans;          ///< by body, those for which spans_ has room

    template <class Archive>
    void archive(Archive& archive);
    /// Throws std::runtime_error, naming what is wrong.
    void check(const typename Bodies<Motion>::Image& bodies, double now, const WorldOptions& options) const;
  };
  Image image() const;
  void become(const Image& image);

 private:
  /// The state of a body.
  struct Member {
    std::vector<Slot> contacts;  ///< of a fixed body in no order: there may be very many
    std::uint64_t island = 0;    ///< the last island in which it was found
    std::uint32_t place = 0;     ///< in that
    bool disturbed = false;
    double span_ends = -never;  ///< s, of the cluster's span; `never`: asleep; -never: in no cluster
    double calm_since = never;  ///< s
    bool met = false;           ///< it has met another that is not fixed, and may come to rest
    bool carried = false;       ///< degree 3 and above: its motion is one that contacts have changed
  };
  /// Bodies that lean on each other, in the arithmetic of least_constraint.
  struct Island {
    std::vector<BodySlot> bodies;  ///< fixed ones last
    std::size_t free = 0;          ///< how many are not fixed
    std::vector<Slot> contacts;
    std::vector<Touch> touches;  ///< of the contacts
  };

  Member& member(BodySlot id) {
    if (of_.size() <= id) of_.resize(id + std::size_t{1});
    return of_[id];
  }
  const std::vector<Slot>& fewer(BodySlot a, BodySlot b) const;
  Slot find_among(BodySlot a, BodySlot b, int wall) const;
  Slot find_like(const Contact& contact) const;
  Slot give_slot(const Contact& contact);
  void list(Slot slot, BodySlot id);
  void unlist(Slot slot);
  std::vector<Slot> in_order(BodySlot id) const;
  Slot first_release() const;
  void note(BodySlot id);
  void drop(Slot slot);
  void schedule_release(Slot slot);
  /// When a contact ends; `never` if that is not known.
  double release(Slot slot) const { return contacts_[slot].unfinished ? never : releases_.time(slot); }
  bool alone_on_face(const Contact& contact) const;
  Eigen::Vector3d moved_away(BodySlot a, BodySlot b) const;

  // resting_islands.cpp
  void solve_all();
  void solve_fixed(BodySlot id);
  bool solve_island(BodySlot id, bool& dissolved);
  Island find_island(BodySlot id);
  bool drop_broken(const Island& island);
  void stay(const Island& island, std::vector<Motion>& motions) const;
  bool constrain(Island& island, std::size_t order, std::vector<Motion>& motions);
  bool constrain_curves(Island& island, std::vector<Motion>& motions);
  bool press(Motion& motion, Contact& contact) const;
  void part(Slot slot);
  bool let_pass_worst(const Island& island, const std::vector<Eigen::Vector3d>& rates);

  // resting_clusters.cpp
  class Span;
  friend Span;
  bool in_cluster(const Island& island) const;
  bool turns(const Island& island) const;
  bool slides_on(const Island& island) const;
  bool repeats(const Island& island, std::size_t k) const;
  bool renew(const Island& island);
  bool step_cluster(Island& island, bool& dissolved);
  void take_up(const Island& island, Span& span, double length);
  void gather(BodySlot id, double ends);
  void dissolve(const Island& island);
  void set_span(BodySlot first, double ends);
  void set_proven(Contact& contact, bool proven);
  void move(BodySlot id, const Eigen::Vector3d& velocity, const Eigen::Vector3d& half_acceleration, BodySlot carrier);
  Eigen::Vector3d velocity(BodySlot id) const;
  Eigen::Vector3d acceleration(BodySlot id) const;
  double longest_span(BodySlot id) const;
  bool soon_back(const Contact& contact, double rate) const;
  bool squeezed(const Island& island) const;

  // coming_to_rest.cpp
  double comes_to_rest(const Island& island, const std::vector<Eigen::Vector3d>& velocities);
  void watch(const Island& island, std::vector<Motion>& motions);

  // resting_transfer.cpp
  Slot listed_by_other(const Contact& contact, BodySlot id) const;
  void note_shared(BodySlot a, BodySlot b);
  void note_struck(const Contact& contact);
  void note_concerned(const Island& island);

  // cluster_impacts.cpp
  class Neighbourhood;
  friend Neighbourhood;
  double wake(const Contact& contact, bool joins);
  Slot add_to_cluster(const Contact& contact);

  const Bodies<Motion>& bodies_;
  const Clock& clock_;
  ContactGaps<Motion> gaps_;
  Listener* listener_ = nullptr;
  std::vector<Contact> contacts_;
  std::vector<Slot> free_;
  std::vector<Member> of_;  ///< by body, up to the last that has rested
  std::vector<BodySlot> disturbed_;
  DaryQueue<detail::RestingRank> releases_;  ///< when contacts end; slots are contacts
  DaryQueue<BodyRank> spans_;                ///< when spans end; slots are bodies, the first of each cluster
  std::uint64_t islands_ = 0;
  detail::RestingEvent last_event_;
  std::vector<BodySlot> solved_;
  KeptProgress<Progress> kept_;
  ContactsOfBoth of_both_;
  SharedIslands shared_;
};

/// The part of a world that knows what rests in it: contacts that last, or, where bodies turn, groups that lie still.
template <class Motion>
using RestingPart = std::conditional_t<turns<Motion>, TurningRest<Motion>, RestingContacts<Motion>>;

#define KDS_DECLARE(motion) extern template class RestingContacts<motion>;
KDS_FOR_ALL_PATHS(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
