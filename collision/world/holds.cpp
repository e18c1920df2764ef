// Contacts that are held: which there are, when the bodies may meet elsewhere, and when they are let go.
#include "collision/vectors.hpp"
#include "collision/world.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// How far a held pair may part before it is let go, relative to the smaller bounding radius: balls that slide over
/// each other part by this from plane to plane, and fall back. Less makes that more exact, and costs more pieces.
constexpr double slack = 0x1p-20;
/// The same relative to the coordinates, which are rounded whenever a motion is restarted.
constexpr double coordinate_slack = 0x1p-40;

/// Normals as near as this are of one and the same place: cosine of the angle between them.
constexpr double same_normal = 1 - 0x1p-20;

template <int Degree>
bool is_mesh(const MovingShape<Degree>& body) {
  return std::holds_alternative<MeshShape>(body.shape.shape);
}

template <int Degree>
certificates::PointMotion<Degree> shifted(certificates::PointMotion<Degree> motion, const Vector3d& by) {
  motion.coefficients[0] += by;
  return motion;
}

template <int Degree>
double slack_of(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t) {
  const double size = std::min(a.shape.bounding_radius, b.shape.bounding_radius);
  const double coordinates = a.motion.position(t).cwiseAbs().maxCoeff() + b.motion.position(t).cwiseAbs().maxCoeff();
  return std::max(slack * size, coordinate_slack * coordinates);
}

}  // namespace

template <int Degree>
typename World<Degree>::HoldSlot World<Degree>::find_hold(BodyId a, BodyId b, int wall) const {
  for (const HoldSlot slot : bodies_[a].holds) {
    const Hold& hold = holds_[slot];
    if (hold.a == a && hold.b == b && hold.wall == wall) return slot;
  }
  return no_hold;
}

/// Between meshes several may hold at once, in a groove, say; one for each normal.
template <int Degree>
void World<Degree>::add_hold(const Hold& hold) {
  for (const HoldSlot slot : bodies_[hold.a].holds) {
    Hold& other = holds_[slot];
    if (other.a != hold.a || other.b != hold.b || !(dot(other.normal, hold.normal) > same_normal)) continue;
    other.normal = hold.normal;
    other.fresh = true;
    return;
  }
  HoldSlot slot;
  if (free_holds_.empty()) {
    slot = static_cast<HoldSlot>(holds_.size());
    holds_.emplace_back();
    if (releases_.slots() < holds_.size()) releases_.resize(2 * holds_.size());
  } else {
    slot = free_holds_.back();
    free_holds_.pop_back();
  }
  holds_[slot] = hold;
  holds_[slot].alive = true;
  holds_[slot].fresh = true;
  bodies_[hold.a].holds.push_back(slot);
  if (hold.b != no_body) bodies_[hold.b].holds.push_back(slot);
}

template <int Degree>
void World<Degree>::drop_hold(HoldSlot slot) {
  Hold& hold = holds_[slot];
  hold.alive = false;
  releases_.clear(slot);
  free_holds_.push_back(slot);
  for (const BodyId id : {hold.a, hold.b}) {
    if (id == no_body) continue;
    auto& list = bodies_[id].holds;
    list.erase(std::find(list.begin(), list.end(), slot));
    disturb(id);
  }
  if (hold.b == no_body) return;
  const PairSlot pair = find_pair(hold.a, hold.b);
  if (pair != no_pair) mark_dirty(pair);
}

template <int Degree>
void World<Degree>::drop_holds(BodyId id) {
  while (!bodies_[id].holds.empty()) drop_hold(bodies_[id].holds.back());
}

/// Convex bodies that are held are on either side of a plane through the touch and stay there, so they cannot meet
/// again before they are let go. A mesh may have something else in the way; where rounding makes it the held touch that
/// is found, that is left behind by some roundings, for as long as the two move as they do: so the answer does not
/// depend on how often it is asked for.
template <int Degree>
double World<Degree>::next_contact_of_held(const Pair& pair) {
  const auto a = moving(pair.a);
  const auto b = moving(pair.b);
  if (!is_mesh(a) && !is_mesh(b)) return never;
  const double began = std::max(a.motion.start, b.motion.start);
  Vector3d out = Vector3d::Zero();
  bool left_behind = false;
  for (const HoldSlot slot : bodies_[pair.a].holds) {
    if (holds_[slot].b != pair.b) continue;
    out += holds_[slot].normal;
    left_behind = left_behind || holds_[slot].left_behind == began;
  }
  if (!left_behind) {
    const double t = first_contact(a, b, now_, horizon_, ContactMode::resolved);
    if (t != now_) return t;
    holds_[find_hold(pair.a, pair.b)].left_behind = began;
  }
  const double coordinates =
      a.motion.position(began).cwiseAbs().maxCoeff() + b.motion.position(began).cwiseAbs().maxCoeff();
  const double size = a.shape.bounding_radius + b.shape.bounding_radius;
  const Motion farther = shifted(b.motion, coordinate_slack * (size + coordinates) * out);
  return first_contact(a, MovingShape<Degree>{b.shape, farther}, now_, horizon_, ContactMode::resolved);
}

/// Held pairs part by sliding off, or by `slack`.
template <int Degree>
void World<Degree>::schedule_release(HoldSlot slot) {
  const Hold& hold = holds_[slot];
  if (hold.b == no_body) return;  // Walls have no edge to slide off.
  const auto a = moving(hold.a);
  const auto b = moving(hold.b);
  bool together = true;
  for (std::size_t i = 1; i <= Degree; ++i) {
    together = together && a.motion.coefficients[i] == b.motion.coefficients[i];
  }
  if (together && (Degree == 1 || a.motion.start == b.motion.start || a.motion.coefficients[Degree].isZero(0))) {
    return releases_.clear(slot);
  }
  const Motion nearer = shifted(b.motion, -slack_of(a, b, now_) * hold.normal);
  const double t = first_separation(a, MovingShape<Degree>{b.shape, nearer}, now_, horizon_);
  releases_.set(slot, t);
}

template <int Degree>
void World<Degree>::release(HoldSlot slot) {
  drop_hold(slot);
  settle();
}

template <int Degree>
bool World<Degree>::held(BodyId a, BodyId b) const {
  body(a), body(b);
  return find_hold(std::min(a, b), std::max(a, b)) != no_hold;
}

template <int Degree>
bool World<Degree>::held_at_wall(BodyId a, int wall) const {
  body(a);
  if (wall < 0 || wall > 5) {
    throw std::out_of_range("World::held_at_wall: there is no wall " + std::to_string(wall) + ", they are 0 to 5");
  }
  return find_hold(a, no_body, wall) != no_hold;
}

template <int Degree>
typename World<Degree>::Motion World<Degree>::free_motion(BodyId id) const {
  const Body& b = body(id);
  if (b.holds.empty()) return movers_[id].motion;
  Motion motion = movers_[id].motion.restarted(now());
  if constexpr (Degree >= 2) motion.coefficients[2] = b.force;
  return motion;
}

template class World<1>;
template class World<2>;

}  // namespace kds::collision
