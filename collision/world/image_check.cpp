// Whether an image is one that a world could have made of itself: whatever else is loaded would be read out of bounds,
// or never end.
#include "collision/world/image.hpp"

#include "collision/shapes/shape.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

namespace kds::collision {
namespace {

[[noreturn]] void fail(const std::string& what) { throw std::runtime_error("snapshot: " + what); }

void require(bool right, const char* list, std::size_t index, const char* what) {
  if (!right) fail(std::string(list) + "[" + std::to_string(index) + "]: " + what);
}

/// Since the beginning of time, but not from now on.
bool is_past(double time, double now) { return time <= now; }
/// Perhaps never, but not before now.
bool is_to_come(double time, double now) { return time >= now; }

/// A shape as place() makes it of some orientation.
void check_shape(const PlacedShape& placed, std::size_t id) {
  try {
    const PlacedShape again = place_turned(placed.shape, placed.rotation);
    const bool same_axes = !std::holds_alternative<Box>(placed.shape) || again.half_axes == placed.half_axes;
    require(same_axes && again.low == placed.low && again.high == placed.high &&
                again.bounding_radius == placed.bounding_radius,
            "bodies", id, "its bounds are not those of its shape");
  } catch (const std::invalid_argument& error) {
    require(false, "bodies", id, error.what());
  }
}

}  // namespace

/// Precondition: the shapes have been placed by Image::shape(), so that meshes are there.
template <int Degree>
void World<Degree>::Image::check(const WorldOptions& options) const {
  if (!std::isfinite(now)) fail("now: is not finite");
  if (!is_to_come(horizon, now)) fail("horizon: is before now");
  if (!std::isfinite(clock) || clock > now) fail("clock: is after now, or not finite");
  if (!edits.began_by(now)) fail("edits: are counted from a time after now");
  if (!is_past(removed_at, now)) fail("removed_at: is after now");
  check_bodies();
  check_pairs(options);
  check_resting(options);
  check_reports();
}

template <int Degree>
bool World<Degree>::Image::is_alive(BodyId id) const {
  return id < bodies.size() && bodies[id].alive;
}

template <int Degree>
bool World<Degree>::Image::is_entered(BodyId id) const {
  return is_alive(id) && bodies[id].entered;
}

template <int Degree>
void World<Degree>::Image::check_bodies() const {
  if (bodies.size() > no_body) fail("bodies: there are more than there are ids");
  std::vector<char> enters(bodies.size());
  for (std::size_t i = 0; i < entering.size(); ++i) {
    require(is_alive(entering[i]) && !bodies[entering[i]].entered, "entering", i, "is no body that waits to enter");
    require(bodies[entering[i]].motion.start <= now, "entering", i, "its motion begins after now");
    enters[entering[i]] = 1;
  }
  std::size_t dead = 0;
  for (std::size_t id = 0; id < bodies.size(); ++id) {
    const BodyImage& body = bodies[id];
    const auto need = [id](bool right, const char* what) { require(right, "bodies", id, what); };
    dead += !body.alive;
    if (!body.alive) continue;
    check_shape(body.placed, id);
    need(body.motion.finite(), "its motion is not finite");
    need(!body.entered || body.motion.start <= now, "its motion begins after now");
    need(body.entered || enters[id] || !body.script.empty(), "it never enters");
    double next = never;  // pieces are listed last first
    for (const Motion& piece : body.script) {
      need(piece.finite(), "a piece of its motion to come is not finite");
      need(is_to_come(piece.start, now) && piece.start < next, "pieces of its motion to come are out of order");
      next = piece.start;
    }
    const bool has_mass = std::isfinite(body.mass) && body.mass > 0 && body.inverse_mass == 1 / body.mass;
    need(has_mass || body.inverse_mass == 0, "its mass is not > 0, or not that of its inverse");
    need(body.restitution >= 0 && body.restitution <= 1, "its restitution is not in [0, 1]");
    need(body.volume == BoundingVolume::shape || body.volume == BoundingVolume::sphere, "its volume is unknown");
    need(is_past(body.burst_start, now), "its meetings are counted from a time after now");
    need(body.force.allFinite(), "its acceleration is not finite");
  }
  std::vector<char> listed(bodies.size());
  const auto check_free = [&](const std::vector<BodyId>& ids, const char* list) {
    for (std::size_t i = 0; i < ids.size(); ++i) {
      require(ids[i] < bodies.size() && !bodies[ids[i]].alive && !std::exchange(listed[ids[i]], 1), list, i,
              "is no free id, or listed twice");
    }
  };
  check_free(free_bodies, "free_bodies");
  check_free(removed, "removed");
  if (free_bodies.size() + removed.size() != dead) fail("free_bodies: not all that are free are listed");
}

template <int Degree>
void World<Degree>::Image::check_pairs(const WorldOptions& options) const {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Pair& pair = pairs[i].pair;
    const auto need = [i](bool right, const char* what) { require(right, "pairs", i, what); };
    need(pair.a < pair.b && is_entered(pair.a) && is_entered(pair.b), "is not of two bodies in the world");
    const BodyImage& a = bodies[pair.a];
    const BodyImage& b = bodies[pair.b];
    need((a.category & b.collides_with) != 0 && (b.category & a.collides_with) != 0, "is of bodies that never meet");
    need(is_to_come(pairs[i].contact, now) && is_to_come(pairs[i].boxes, now), "is due before now");
    need(is_past(pair.passes_at, now), "passes at a time after now");
    need(pair.passes_at == -never || options.response != Response::none, "passes where contacts are not resolved");
    need(pair.listed || pair.overlapping || pair.dirty, "is neither listed nor overlapping");
    if (i == 0) continue;
    const Pair& before = pairs[i - 1].pair;
    need(std::pair(before.a, before.b) < std::pair(pair.a, pair.b), "is out of order, or there twice");
  }
}

template <int Degree>
void World<Degree>::Image::check_resting(const WorldOptions& options) const {
  const auto& [contacts, free, disturbed, of, releases] = resting;
  if (releases.size() != contacts.size()) fail("releases: are not as many as resting contacts");
  if (of.size() > bodies.size()) fail("resting: of more bodies than there are");
  for (std::size_t i = 0; i < disturbed.size(); ++i) {
    require(is_entered(disturbed[i]), "disturbed", i, "is no body in the world");
  }
  std::size_t dead = 0;
  std::size_t sides = 0;
  for (std::size_t slot = 0; slot < contacts.size(); ++slot) {
    const auto& hold = contacts[slot];
    const auto need = [slot](bool right, const char* what) { require(right, "resting", slot, what); };
    dead += !hold.alive;
    if (!hold.alive) {
      need(releases[slot] == never, "is over, and is to be let go");
      continue;
    }
    const bool at_wall = hold.b == no_body;
    sides += at_wall ? 1 : 2;
    need(is_entered(hold.a), "is not of a body in the world");
    if (at_wall) {
      need(options.walls && hold.wall >= 0 && hold.wall < 6, "is at no wall");
    } else {
      need(hold.a < hold.b && is_entered(hold.b) && hold.wall == -1, "is not of two bodies in the world");
      need(options.response == Response::elastic, "is of two bodies where none are held");
    }
    need(std::abs(hold.normal.norm() - 1) <= normal_rounding, "its normal has no unit length");
    need(std::isfinite(hold.push) && std::isfinite(hold.solved), "its push or rate is not finite");
    need(is_to_come(releases[slot], now), "is to be let go before now");
  }
  for (std::size_t id = 0; id < of.size(); ++id) {
    const auto& of_body = of[id];
    for (auto slot = of_body.begin(); slot != of_body.end(); ++slot) {
      const bool known =
          *slot < contacts.size() && contacts[*slot].alive && (contacts[*slot].a == id || contacts[*slot].b == id);
      require(known && std::find(of_body.begin(), slot, *slot) == slot, "bodies", id, "is held by what is none");
      --sides;
    }
  }
  if (sides != 0) fail("resting: there is one that a body does not know");
  std::vector<char> listed(contacts.size());
  for (std::size_t i = 0; i < free.size(); ++i) {
    const detail::HoldSlot slot = free[i];
    require(slot < contacts.size() && !contacts[slot].alive && !std::exchange(listed[slot], 1), "free of resting", i,
            "is no free slot, or listed twice");
  }
  if (free.size() != dead) fail("resting: not all that are free are listed");
}

template <int Degree>
void World<Degree>::Image::check_reports() const {
  using Report = Reports::Report;
  using Kind = Report::Kind;
  for (std::size_t i = 0; i < pending.size(); ++i) {
    const Report& event = pending[i];
    const auto need = [i](bool right, const char* what) { require(right, "pending", i, what); };
    need(event.kind >= Kind::held && event.kind <= Kind::overlap, "is of an unknown kind");
    if (event.kind == Kind::moved) {
      need(is_entered(event.a) && event.b == no_body && !event.removed, "is not of a body in the world");
    } else {
      need(event.a < event.b && event.b < bodies.size(), "is of no pair");
      need(event.removed || (is_entered(event.a) && is_entered(event.b)), "is not of two bodies in the world");
      need(!event.removed || event.kind != Kind::overlap, "is an overlap of a body that has been removed");
    }
    const Contact& contact = event.contact;
    need(std::isfinite(contact.time) && contact.time <= now, "is of no time up to now");
    need(!contact.point.hasNaN() && !contact.normal.hasNaN(), "its point or normal is not a number");
    for (const Feature& feature : {contact.feature_a, contact.feature_b}) {
      need(feature.kind <= Feature::Kind::face, "has a feature of an unknown kind");
    }
  }
}

template void World<1>::Image::check(const WorldOptions&) const;
template void World<2>::Image::check(const WorldOptions&) const;

}  // namespace kds::collision
