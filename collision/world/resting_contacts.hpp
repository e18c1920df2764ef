// Contacts that last: bodies that lie, lean and slide on each other and on walls.
#pragma once

#include "collision/degrees.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/response/least_constraint.hpp"
#include "collision/world/bodies.hpp"
#include "collision/world/clock.hpp"
#include "collision/world_options.hpp"
#include "kds/events/dary_queue.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace kds::collision {

namespace detail {

using RestingSlot = std::uint32_t;

/// Two bodies, or a body (a) and a wall, that stay in touch.
struct RestingContact {
  BodySlot a = 0;
  BodySlot b = no_body;  ///< of a wall
  int wall = -1;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, from a to b or out of the domain
  double push = 0;                                   ///< half the relative acceleration that it gives
  /// The largest of the velocities that were last solved for with it: what is left along the normal is a rounding of
  /// that.
  double solved = 0;
  bool alive = false;
  bool fresh = false;           ///< its approach is still to be taken out
  double ends = never;          ///< s, when nothing presses the two together any more; `never` up to degree 2
  double left_behind = -never;  ///< s, the epoch of a pair of motions: until it is another, rounding feigns a contact
};

struct RestingRank {
  const std::vector<RestingContact>* contacts = nullptr;
  std::uint64_t operator()(std::uint32_t slot) const {
    return std::uint64_t{(*contacts)[slot].a} << 32 | (*contacts)[slot].b;
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

/// The resting contacts of a world: which there are, how the bodies move that rest on each other, and when they part.
/// docs/resting.md says what the law is.
///
/// A part of World that owns its state and its queue. It reads the bodies, and tells its listener what follows.
///
/// Cost: nothing while nothing rests. O(1) a contact that begins or ends; a change of motion of a body that rests
/// solves for all that lean on each other with it (least_constraint.hpp).
template <int Degree>
class RestingContacts {
 public:
  using Motion = certificates::PointMotion<Degree>;
  using Slot = detail::RestingSlot;
  using Contact = detail::RestingContact;
  static constexpr Slot none = ~Slot{0};

  /// What resting contacts tell a world.
  class Listener {
   public:
    virtual void take_up(BodySlot id, const Motion& motion) = 0;  ///< a new motion
    virtual void changed(BodySlot a, BodySlot b) = 0;             ///< what the two may meet next has to be found anew
    virtual void let_pass(BodySlot a, BodySlot b) = 0;
    virtual void tell_held(BodySlot a, BodySlot b) = 0;  ///< that the policy has acted on the two

   protected:
    ~Listener() = default;
  };

  RestingContacts(const Bodies<Degree>& bodies, const Clock& clock, Listener& listener)
      : bodies_(bodies), clock_(clock), listener_(listener), releases_(detail::RestingRank{&contacts_}) {}
  RestingContacts(const RestingContacts&) = delete;
  RestingContacts& operator=(const RestingContacts&) = delete;

  /// Whether there are any.
  bool empty() const { return contacts_.size() == free_.size(); }
  /// One of a and b (a < b), or of a and a wall (b: no_body); `none` if there is none.
  Slot find(BodySlot a, BodySlot b, int wall = -1) const { return rests(a) ? find_among(a, b, wall) : none; }
  bool rests(BodySlot id) const { return id < of_.size() && !of_[id].contacts.empty(); }

  /// A contact begins to last. Between meshes several may last at once, in a groove, say; one for each normal.
  void add(const Contact& contact);
  /// All of a body end, since it jumps.
  void drop_all(BodySlot id);
  /// All of a body end, since it goes.
  void forget(BodySlot id) {
    drop_all(id);
    if (id < of_.size()) of_[id] = {};
  }

  /// The motion of a body has changed: those that it rests with are to be looked at by settle().
  void disturb(BodySlot id) {
    if (!contacts_.empty()) note(id);
  }
  bool settled() const { return disturbed_.empty(); }
  /// Gives all that have been disturbed the motions that their contacts leave them.
  void settle() {
    if (!settled()) settle_all();
  }

  /// When two bodies that rest on each other may meet elsewhere.
  double next_contact(BodySlot a, BodySlot b);

  /// When the next contact ends, by sliding off or parting; process() ends it.
  double next_time() const { return releases_.empty() ? never : releases_.top().time; }
  void process();
  void extend_horizon();

  /// Checks all contacts at a time up to which nothing is due; throws AuditFailure. `walls`: whether there are any.
  void audit(double t, bool walls) const;

  /// All of it, as plain data.
  struct Image {
    std::vector<Contact> contacts;
    std::vector<Slot> free;
    std::vector<BodySlot> disturbed;
    std::vector<std::vector<Slot>> of;  ///< by body
    std::vector<double> releases;       ///< by contact

    template <class Archive>
    void archive(Archive& archive);
    /// Throws std::runtime_error, naming what is wrong.
    void check(const typename Bodies<Degree>::Image& bodies, double now, const WorldOptions& options) const;

   private:
    /// How far a normal may be from unit length: far above what normalising rounds.
    static constexpr double normal_rounding = 0x1p-40;
  };
  Image image() const;
  void become(const Image& image);

 private:
  /// Of a body.
  struct Member {
    std::vector<Slot> contacts;
    std::uint64_t island = 0;  ///< the last it was seen in
    std::uint32_t place = 0;   ///< in that
    bool disturbed = false;
    bool carried = false;  ///< degree 3 and above: its motion is what contacts have left of it, or made of it
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
  Slot find_among(BodySlot a, BodySlot b, int wall) const;
  void note(BodySlot id);
  void drop(Slot slot);
  void schedule_release(Slot slot);

  // resting_islands.cpp
  void settle_all();
  void settle_fixed(BodySlot id);
  bool settle_island(BodySlot id);
  Island find_island(BodySlot id);
  bool drop_broken(const Island& island);
  bool constrain(Island& island, std::size_t order, std::vector<Motion>& motions);
  bool constrain_curves(Island& island, std::vector<Motion>& motions);
  bool press(Motion& motion, Contact& hold) const;
  void part(Slot slot);
  bool let_pass_worst(const Island& island, const std::vector<Eigen::Vector3d>& rates);

  const Bodies<Degree>& bodies_;
  const Clock& clock_;
  Listener& listener_;
  std::vector<Contact> contacts_;
  std::vector<Slot> free_;
  std::vector<Member> of_;  ///< by body, up to the last that has rested
  std::vector<BodySlot> disturbed_;
  DaryQueue<detail::RestingRank> releases_;  ///< when contacts end; slots are contacts
  std::uint64_t islands_ = 0;
};

#define KDS_DECLARE(degree) extern template class RestingContacts<degree>;
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
