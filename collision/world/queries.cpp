#include "collision/world/queries.hpp"

#include "collision/broad_phase/swept_box.hpp"
#include "collision/motions.hpp"
#include "kds/number_text.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::collision {

template <class Motion>
Queries<Motion>::Queries(const WorldParts<Motion>& parts, const MotionUpdates<Motion>& motions, const Guard& guard,
                         const CallersClock& callers)
    : clock_(parts.clock),
      bodies_(parts.bodies),
      volumes_(parts.volumes),
      resting_(parts.resting),
      pairs_(parts.pairs),
      unbounded_(parts.unbounded),
      self_contacts_(parts.self_contacts),
      parts_(parts),
      motions_(motions),
      guard_(guard),
      callers_(callers) {}

template <class Motion>
bool Queries<Motion>::touching(BodyId a, BodyId b) const {
  const BodySlot of_a = bodies_.slot_of(a);
  const BodySlot of_b = bodies_.slot_of(b);
  if (a == b) return self_contacts_.touching(of_a);
  return pairs_.mode(of_a, of_b) == ContactMode::transparent && pairs_.overlapping(of_a, of_b);
}

/// All are collected first, since `visit` may change the world.
template <class Motion>
void Queries<Motion>::visit_partners(BodyId id, BodyVisitor visit) const {
  guard_.require_whole("World::visit_partners");
  const BodySlot slot = bodies_.slot_of(id);
  std::vector<BodySlot> found = resting_.partners(slot);
  pairs_.visit_overlapped(slot, [&](BodySlot other) { found.push_back(other); });
  std::vector<BodyId> ids;
  for (const BodySlot other : found) ids.push_back(bodies_.id_of(other));
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  for (const BodyId other : ids) visit(other);
}

template <class Motion>
bool Queries<Motion>::resting(BodyId a, BodyId b) const {
  const auto [first, second] = bodies_.in_order(bodies_.slot_of(a), bodies_.slot_of(b));
  return resting_.holds(first, second);
}

template <class Motion>
bool Queries<Motion>::resting_at_wall(BodyId a, int wall) const {
  const BodySlot slot = bodies_.slot_of(a);
  if (wall < 0 || wall > 5) {
    throw std::out_of_range("World::resting_at_wall: there is no wall " + std::to_string(wall) + ", they are 0 to 5");
  }
  return resting_.holds(slot, no_body, wall);
}

/// `ask(look)` queries the broad phase. The bodies that it visits depend on the broad phase; those of them for which
/// meets(slot) is true do not.
template <class Motion>
template <class Ask, class Meets>
void Queries<Motion>::answer(const char* function, const Ask& ask, const Meets& meets, BodyVisitor visit) const {
  guard_.require_whole(function);
  if (guard_.in_box_function()) {
    throw std::logic_error(std::string(function) + ": must not be called from within a box function");
  }
  std::vector<BodySlot> found;
  const auto look = [&](BodySlot slot) {
    if (meets(slot)) found.push_back(slot);
  };
  const bool broad_phase_is_ahead = now() < clock_.now;
  if (!broad_phase_is_ahead) ask(look);
  if (broad_phase_is_ahead || bodies_.filters()) {
    for (BodySlot slot = 0; slot < bodies_.slots(); ++slot) {
      if (bodies_.entered(slot) && (broad_phase_is_ahead || !bodies_.collides(slot))) look(slot);
    }
  }
  for (const BodySlot slot : unbounded_.bodies()) look(slot);
  if (motions_.awaiting_report() != no_body)
    look(motions_.awaiting_report());  // The broad phase knows the motion before.
  for (const BodySlot slot : bodies_.waiting()) {
    if (bodies_.alive(slot) && !bodies_.entered(slot)) look(slot);
  }
  std::vector<BodyId> named;  // all are collected first, since `visit` may change the world
  named.reserve(found.size());
  for (const BodySlot slot : found) named.push_back(bodies_.id_of(slot));
  std::sort(named.begin(), named.end());
  named.erase(std::unique(named.begin(), named.end()), named.end());
  for (const BodyId id : named) visit(id);
}

template <class Motion>
void Queries<Motion>::visit_overlapping(const Eigen::Vector3d& min, const Eigen::Vector3d& max,
                                        BodyVisitor visit) const {
  if (!(min.array() <= max.array()).all()) {
    throw std::invalid_argument("World::visit_overlapping: min must not be above max, and both must be numbers");
  }
  const StaticBox box{min.array(), max.array()};
  const double t = now();
  const auto ask = [&](const auto& look) { parts_.broad_phase->visit_overlapping(box, t, look); };
  answer(
      "World::visit_overlapping", ask, [&](BodySlot slot) { return volumes_.meets(slot, box, t); }, visit);
}

template <class Motion>
void Queries<Motion>::visit_swept(const KineticBox<Motion::degree>& box, double until, BodyVisitor visit) const {
  const double from = now();
  if (!box.min.finite() || !box.max.finite()) {
    throw std::invalid_argument("World::visit_swept: the box is not finite");
  }
  if (!(until >= from && until < never)) {
    throw std::invalid_argument("World::visit_swept: " + number_text(until) + " is not a finite time from now on (" +
                                number_text(from) + ")");
  }
  const StaticBox swept = bounded_swept_box(box, from, until);
  const auto ask = [&](const auto& look) {
    parts_.broad_phase->visit_swept(box, from, until, look);
    // The broad phase knows only the present piece of a mesh that bends.
    for (BodySlot slot = 0; slot < volumes_.end_of_bent(); ++slot) {
      if (volumes_.bends(slot) && bodies_.entered(slot)) look(slot);
    }
  };
  answer(
      "World::visit_swept", ask, [&](BodySlot slot) { return volumes_.meets_swept(slot, swept, from, until); }, visit);
}

#define KDS_INSTANTIATE(motion) template class Queries<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
