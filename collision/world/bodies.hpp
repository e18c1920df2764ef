// The bodies of a world: their descriptions and their motions.
#pragma once

#include "certificates/balls_together.hpp"
#include "collision/body_description.hpp"
#include "collision/body_id.hpp"
#include "collision/body_motion.hpp"
#include "collision/motions.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/world/attachments.hpp"
#include "collision/world/body_keys.hpp"
#include "collision/world/ignored_pairs.hpp"
#include "kds/large_vector.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace kds::collision {

/// With what a body may collide: see BodyDescription.
struct CollisionFilter {
  std::uint32_t category = default_category;
  std::uint32_t collides_with = ~0u;
  std::uint32_t group = 0;

  /// Both masks as one number.
  std::uint64_t masks() const { return std::uint64_t{category} << 32 | collides_with; }
  static CollisionFilter of_masks(std::uint64_t masks) {
    return {static_cast<std::uint32_t>(masks >> 32), static_cast<std::uint32_t>(masks), 0};
  }

  bool meets(const CollisionFilter& other) const {
    return (category & other.collides_with) != 0 && (other.category & collides_with) != 0 &&
           (group == 0 || group != other.group);
  }
  friend bool operator==(const CollisionFilter&, const CollisionFilter&) = default;
};

namespace detail {

/// Half the acceleration that callers gave; at degree 1 there is none.
struct Force {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
};
struct NoForce {};
/// From degree 3 on the whole path that callers gave: its acceleration is not one number.
template <class Motion>
struct Course {
  PathOf<Motion> given;
};

/// The properties of bodies that turn.
struct Turns {
  double inverse_inertia = 0;  ///< the same about all axes; 0 if nothing changes its angular velocity
  double friction = 0;
  double tangential_restitution = 0;
  double rolling_friction = 0;
  bool tumbles = false;        ///< it precesses: world/turning/tumbling.hpp knows its inertia
  double turns_until = never;  ///< and when the present piece of its motion ends; -never if it is left alone
};
struct TurnsNot {};

/// A body without its motion and its radius, which the tests of balls read and which are stored separately. Where it
/// does not turn, and its motion is a line, it fits into one cache line; so what few bodies have, or have for a short
/// time, is in arrays of its own.
template <class Motion>
struct Body
    : std::conditional_t<Motion::degree >= 3, Course<Motion>, std::conditional_t<Motion::degree == 2, Force, NoForce>>,
      std::conditional_t<turns<Motion>, Turns, TurnsNot> {
  Body() {}  // the implicit one would set all to zero first

  double inverse_mass = 1;
  double restitution = 1;
  double mass = 1;
  double bounding_radius = 0;
  std::uint64_t user_data = 0;
  double burst_start = -never;
  const PlacedShape* shape = nullptr;  ///< null if it is placed_ball(bounding_radius); see Bodies::kept_shape()
  std::uint32_t meetings = 0;          ///< contacts since burst_start (ZenoPolicy)
  BoundingVolume volume = BoundingVolume::shape;
  bool sensor : 1 = false;
  bool self_contacts : 1 = false;
  bool alive : 1 = false;
  bool entered : 1 = false;  ///< its motion has begun; it is in the broad phase, if it collides with anything
};

/// A body for the narrow phase; the shape of a ball is made on demand.
template <class Motion>
class Moving : private std::optional<PlacedShape>, public MovingShape<Motion> {
 public:
  Moving(const Body<Motion>& body, const Motion& its_motion)
      : std::optional<PlacedShape>(body.shape ? std::nullopt : std::optional(placed_ball(body.bounding_radius))),
        MovingShape<Motion>{body.shape ? *body.shape : **this, its_motion} {}
  Moving(const Moving&) = delete;
  Moving& operator=(const Moving&) = delete;
};

}  // namespace detail

/// The bodies of a world by slot, their ids, and which of them are about to enter.
///
/// A body that is added gets the slot that became free last, and the next id (body_keys.hpp); a new slot when the
/// generations are used up, which takes at least 2^32 bodies in slots that are given again.
///
/// Cost: O(1) each; memory for the largest number of bodies at any one time.
template <class Motion>
class Bodies {
 public:
  using Path = PathOf<Motion>;
  using Description = BasicBodyDescription<Motion>;
  using Body = detail::Body<Motion>;
  using Moving = detail::Moving<Motion>;
  using Mover = certificates::MovingBall<Motion::degree>;  ///< path and radius, for the tests of balls

  std::size_t size() const { return alive_; }
  bool contains(BodyId id) const { return alive(body_slot(id)) && keys_.id(body_slot(id)) == id; }
  /// The slot of a body. Throws std::out_of_range, naming the id and saying whether the body was removed, if there is
  /// no such body.
  BodySlot slot_of(BodyId id) const {
    if (!contains(id)) [[unlikely]]
      refuse(id);
    return body_slot(id);
  }
  /// The id of the body in a slot. Precondition: there is one.
  BodyId id_of(BodySlot slot) const { return keys_.id(slot); }

  /// All slots are below this.
  std::size_t slots() const { return bodies_.size(); }
  bool alive(BodySlot slot) const { return slot < bodies_.size() && bodies_[slot].alive; }
  bool entered(BodySlot slot) const { return alive(slot) && bodies_[slot].entered; }

  /// Precondition, here and below: slot < slots().
  const Body& operator[](BodySlot slot) const { return bodies_[slot]; }
  Body& operator[](BodySlot slot) { return bodies_[slot]; }
  const Mover& mover(BodySlot slot) const { return movers_[slot]; }
  const Motion& motion(BodySlot slot) const {
    if constexpr (turns<Motion>) {
      return motions_[slot];
    } else {
      return movers_[slot].motion;
    }
  }
  /// The path of its centre.
  const Path& path(BodySlot slot) const { return movers_[slot].motion; }
  Moving moving(BodySlot slot) const { return Moving(bodies_[slot], motion(slot)); }
  PlacedShape shape(BodySlot slot) const { return moving(slot).shape; }
  /// Whether the body is fixed: no other body changes its motion.
  bool fixed(BodySlot slot) const { return bodies_[slot].inverse_mass == 0; }
  /// The shape of a body that is not a ball without rotation, else null; as long as it is kept it stays as it is.
  std::shared_ptr<const PlacedShape> kept_shape(BodySlot slot) const {
    return slot < shapes_.size() ? shapes_[slot] : nullptr;
  }
  /// Whether the body is a mesh that bends.
  bool bends(BodySlot slot) const { return bodies_[slot].shape && collision::bends(bodies_[slot].shape->shape); }
  /// Counts a meeting of the body at `now`: returns how many it has had within `interval` seconds.
  std::uint64_t count_meeting(BodySlot slot, double now, double interval) {
    Body& body = bodies_[slot];
    if (now - body.burst_start > interval) {
      body.meetings = 0;
      body.burst_start = now;
    }
    return ++body.meetings;
  }

  /// Fetches what a contact of the body needs.
  void prefetch(BodySlot slot) const {
    __builtin_prefetch(&movers_[slot], 1);
    if constexpr (turns<Motion>) __builtin_prefetch(&motions_[slot], 1);
    const char* const body = reinterpret_cast<const char*>(&bodies_[slot]);
    __builtin_prefetch(body, 1);
    __builtin_prefetch(body + sizeof(Body) - 1, 1);
  }
  void move(BodySlot slot, const Motion& motion) {
    movers_[slot].motion = path_of(motion);
    if constexpr (turns<Motion>) motions_[slot] = motion;
  }
  /// Whether it precesses, and its motion is a piece that may have passed (turning/tumbling.hpp).
  bool left_alone(BodySlot slot) const {
    if constexpr (turns<Motion>) return bodies_[slot].turns_until == -never;
    return false;
  }
  /// Half the acceleration that the body has without contacts: that of the motion that callers gave last.
  Eigen::Vector3d free_acceleration(BodySlot slot) const requires(Motion::degree <= 2) {
    if constexpr (Motion::degree == 2) {
      return bodies_[slot].force;
    } else {
      return Eigen::Vector3d::Zero();
    }
  }
  /// Coefficient `order` >= 2 about t of the motion that callers gave last: half its acceleration at t, or a higher
  /// derivative times a factor.
  Eigen::Vector3d free_term(BodySlot slot, [[maybe_unused]] std::size_t order, [[maybe_unused]] double t) const {
    if constexpr (Motion::degree >= 3) {
      return bodies_[slot].given.restarted(t).coefficients[order];
    } else {
      return free_acceleration(slot);
    }
  }
  void accelerate_freely(BodySlot slot, const Motion& motion) {
    if constexpr (Motion::degree == 2) bodies_[slot].force = path_of(motion).coefficients[2];
    if constexpr (Motion::degree >= 3) bodies_[slot].given = path_of(motion);
  }
  /// Whether a body that is given this motion at t jumps: begins it at another place, by more than rounding.
  bool is_jump(BodySlot slot, const Motion& to, double t) const;

  /// Whether some body is a sensor, or was.
  bool any_sensor() const { return sensors_; }

  /// Whether some body does not collide with all others, or did not.
  bool filters() const { return filters_; }
  /// Whether there is anything that it may collide with. Bodies that collide with nothing are not in the broad phase.
  bool collides(BodySlot slot) const { return filter(slot).category != 0 && filter(slot).collides_with != 0; }
  /// Whether no box holds it. Such bodies are not in the broad phase either (unbounded.hpp).
  bool unbounded(BodySlot slot) const { return bodies_[slot].bounding_radius == never; }
  bool in_broad_phase(BodySlot slot) const { return collides(slot) && !unbounded(slot); }
  /// Its bounding radius; 0 of one that has none.
  double finite_radius(BodySlot slot) const { return unbounded(slot) ? 0 : bodies_[slot].bounding_radius; }
  const CollisionFilter& filter(BodySlot slot) const {
    static constexpr CollisionFilter meets_all;
    return slot < filter_.size() ? filter_[slot] : meets_all;
  }
  bool may_collide(BodySlot a, BodySlot b) const {
    return filter(a).meets(filter(b)) && !(!ignored_.empty() && ignored_.contains(a, b)) &&
           !(!attachments_.empty() && attachments_.together(a, b));
  }
  void set_filter(BodySlot slot, const CollisionFilter& filter);
  const IgnoredPairs& ignored() const { return ignored_; }
  void ignore(BodySlot a, BodySlot b, bool ignored);

  const Attachments& attachments() const { return attachments_; }
  void attach(BodySlot sensor, BodySlot owner);
  /// Of a body that turns, but does not precess, the inertia changes by the same factor. Precondition: it is not fixed.
  void set_mass(BodySlot slot, double mass);

  /// Adds a body with its first motion. A null `shape` stands for a ball that is not turned. Precondition: valid.
  BodySlot add(const Description& description, std::shared_ptr<const PlacedShape> shape, const Motion& motion);
  void set_shape(BodySlot slot, PlacedShape placed);
  void remove(BodySlot slot);
  void reserve(std::size_t bodies);

  /// A body's motion begins now: it waits to enter.
  void wait(BodySlot slot);
  bool any_waits() const { return waits_ > 0; }
  bool waits(BodySlot slot) const { return slot < waits_at_.size() && waits_at_[slot] != 0; }
  /// How many wait.
  std::size_t waits() const { return waits_; }
  /// Those that have waited longest come first. In the place of one that was removed is no_body.
  std::span<const BodySlot> waiting() const { return std::span<const BodySlot>(waiting_).subspan(taken_); }
  /// Takes those that have waited longest, all or so many. Cost: O(1) a body that is taken, or has been removed.
  std::vector<BodySlot> take_waiting(std::size_t most);

  /// The order of bodies.
  const BodyKeys& keys() const { return keys_; }
  bool before(BodySlot a, BodySlot b) const { return keys_.before(a, b); }
  std::pair<BodySlot, BodySlot> in_order(BodySlot a, BodySlot b) const {
    return before(b, a) ? std::pair(b, a) : std::pair(a, b);
  }
  /// Whether the bodies are those of another world (transfer.cpp), and the slot that one has there; otherwise its slot
  /// here.
  bool numbered() const { return keys_.numbered(); }
  BodySlot number(BodySlot slot) const { return keys_.number(slot); }
  /// Adds a body of another world as it is there. It has not entered.
  BodySlot take_in(const Bodies& from, BodySlot slot);

  /// The bodies have these numbers, in the order of their slots.
  void number_from(BodySlot first) { keys_.number_from(first, bodies_.size()); }
  // Bodies that several processes have, each a part (transfer.cpp).
  /// Others have the bodies from now on. This keeps which bodies there are, their ids, attachments, and ignored pairs.
  /// Until take_back() there are no slots.
  void lend();
  /// The same for so many bodies that are to come, in slots that are their numbers.
  void lend(std::size_t bodies);
  bool has_lent(BodyId id) const;
  /// Ends lend(): there are as many slots as before it, all empty.
  void take_back();

  /// The whole state as plain data, for snapshots.
  struct Image;
  Image image() const;
  /// The same with the number of bodies in place of the bodies; also while they are lent.
  Image image_without_bodies() const;
  /// Bodies in this order, without attachments and ignored pairs. `meshes`: all that the bodies may have.
  Image image_of(std::span<const BodySlot> slots, std::vector<std::shared_ptr<const Mesh>> meshes) const;
  /// Adds the body that has this place in such an image, unchanged: with the id of the world `whole` in which that
  /// number is its slot, or in an empty slot.
  BodySlot put(const Image& image, std::size_t place, BodySlot number, const Bodies& whole);
  void put_back(const Image& image, std::size_t place, BodySlot slot);
  /// Precondition: the image has been checked.
  void become(const Image& image);
  /// Every mesh of the bodies, once.
  std::vector<std::shared_ptr<const Mesh>> meshes() const;

 private:
  [[noreturn]] void refuse(BodyId id) const;
  BodySlot new_slot();
  void wait_no_more(BodySlot slot);
  void keep_shape(BodySlot slot, std::shared_ptr<const PlacedShape> shape);
  template <class One>
  void describe(BodySlot slot, One& one, const std::vector<std::shared_ptr<const Mesh>>& meshes) const;
  template <class One>
  void become(BodySlot slot, const One& one);

  LargeVector<Mover> movers_;
  LargeVector<Motion> motions_;  ///< by slot, where bodies turn
  LargeVector<Body> bodies_;
  // By slot, up to the last that has had another value than most.
  LargeVector<std::shared_ptr<const PlacedShape>> shapes_;
  LargeVector<CollisionFilter> filter_;
  /// Of a body whose motion has begun and that is about to enter, one more than its place in waiting_; else 0.
  LargeVector<std::uint32_t> waits_at_;
  BodyKeys keys_;
  std::vector<BodySlot> free_;
  std::vector<BodySlot> waiting_;  ///< and before them those that have been taken, taken_ of them
  IgnoredPairs ignored_;
  Attachments attachments_;
  std::size_t alive_ = 0;
  std::size_t lent_ = 0;  ///< slots, while others have the bodies
  std::size_t waits_ = 0;
  std::size_t taken_ = 0;
  bool filters_ = false;
  bool sensors_ = false;
};

#define KDS_DECLARE(motion) extern template class Bodies<motion>;
KDS_FOR_ALL_MOTIONS(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
