// What the world keeps of bodies, pairs and contacts that last.
#pragma once

#include "certificates/balls_together.hpp"
#include "collision/body_description.hpp"
#include "collision/narrow_phase/contact.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/response/least_constraint.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/world/list_arena.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

namespace kds::collision::detail {

using PairSlot = std::uint32_t;
using HoldSlot = std::uint32_t;
inline constexpr PairSlot no_pair = ~PairSlot{0};
inline constexpr HoldSlot no_hold = ~HoldSlot{0};
inline constexpr BodyId no_body = ~BodyId{0};

/// What the tests of balls read of a body.
template <int Degree>
using Mover = certificates::MovingBall<Degree>;

/// What few bodies have.
template <int Degree>
struct Extras {
  std::vector<certificates::PointMotion<Degree>> script;  ///< pieces to come, last first
  typename BodyDescription<Degree>::BoxFunction box_function;
  KineticBox<Degree> box;  ///< the last it gave
};

/// A pair as one of its bodies sees it.
struct Link {
  BodyId other;
  PairSlot slot;
};

/// Half the acceleration that callers gave. At degree 1 there is none.
struct Force {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
};
struct NoForce {};

template <int Degree>
struct Body : std::conditional_t<Degree >= 2, Force, NoForce> {
  Body() {}  // not the implicit one, for which all is set to zero first

  double inverse_mass = 1;
  double restitution = 1;
  double mass = 1;
  double bounding_radius = 0;
  ListArena<Link>::List pairs;
  std::uint32_t category = 1;
  std::uint32_t collides_with = ~0u;
  BoundingVolume volume = BoundingVolume::shape;
  bool alive = false;
  bool entered = false;         ///< is in the broad phase
  bool wall_estimated = false;  ///< its time in walls_ is a lower bound
  std::uint64_t meetings = 0;   ///< contacts since burst_start (Zeno)
  double burst_start = -never;
  std::shared_ptr<const PlacedShape> shape;  ///< none if it is placed_ball(bounding_radius)
  std::unique_ptr<Extras<Degree>> extras;
};

/// A body for the narrow phase; the shape of a ball is made for the occasion.
template <int Degree>
class Moving : private std::optional<PlacedShape>, public MovingShape<Degree> {
 public:
  Moving(const Body<Degree>& body, const certificates::PointMotion<Degree>& motion)
      : std::optional<PlacedShape>(body.shape ? std::nullopt : std::optional(placed_ball(body.bounding_radius))),
        MovingShape<Degree>{body.shape ? *body.shape : **this, motion} {}
  Moving(const Moving&) = delete;
  Moving& operator=(const Moving&) = delete;
};

/// Two bodies, or a body (a) and a wall, that stay in touch.
struct Hold {
  BodyId a = 0;
  BodyId b = no_body;  ///< of a wall
  int wall = -1;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, from a to b or out of the domain
  double push = 0;                                   ///< half the relative acceleration that it gives
  bool alive = false;
  bool fresh = false;           ///< its approach is still to be taken out
  double left_behind = -never;  ///< s, the epoch of a pair of motions: until it is another, rounding feigns a contact
};

struct HoldRank {
  const std::vector<Hold>* holds = nullptr;
  std::uint64_t operator()(std::uint32_t slot) const {
    return std::uint64_t{(*holds)[slot].a} << 32 | (*holds)[slot].b;
  }
};

/// Two bodies that may meet. It is there while the broad phase lists it, and while they overlap: so what it knows is a
/// function of what has happened to the two, whatever the broad phase.
struct Pair {
  BodyId a = 0, b = 0;
  std::uint32_t place_in_a = 0, place_in_b = 0;
  bool alive = false;
  bool listed = false;  ///< by the broad phase
  bool dirty = false;
  bool fresh = false;  ///< one of the bodies has entered or jumped at this instant
  /// In contact, in mode `none`; in the modes that resolve contacts, let pass. Its next event is that they separate.
  bool overlapping = false;
  bool boxes_overlap = false;
  bool estimated = false;  ///< its time in contacts_ is a lower bound
  PairMemory memory;
  double passes_at = -never;  ///< it overlaps at this time at least, whatever else happens at it
};

struct PairRank {
  const std::vector<Pair>* pairs = nullptr;
  std::uint64_t operator()(std::uint32_t slot) const {
    return std::uint64_t{(*pairs)[slot].a} << 32 | (*pairs)[slot].b;
  }
};

}  // namespace kds::collision::detail
