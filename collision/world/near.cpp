// The queries of a world.
#include "collision/broad_phase/swept_box.hpp"
#include "collision/motions.hpp"
#include "collision/world/engine.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::collision {

/// `ask(look)` queries the broad phase. The bodies that it visits depend on the broad phase; those of them for which
/// meets(slot) is true do not.
template <class Motion>
template <class Ask, class Meets>
void Engine<Motion>::answer(const char* function, const Ask& ask, const Meets& meets, BodyVisitor visit) const {
  require_whole(function);
  if (volumes_.calling()) {
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
  if (bounced_ != no_body) look(bounced_);  // The broad phase knows the motion before.
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
void Engine<Motion>::visit_overlapping(const Eigen::Vector3d& min, const Eigen::Vector3d& max,
                                       BodyVisitor visit) const {
  if (!(min.array() <= max.array()).all()) {
    throw std::invalid_argument("World::visit_overlapping: min must not be above max, and both must be numbers");
  }
  const StaticBox box{min.array(), max.array()};
  const double t = now();
  const auto ask = [&](const auto& look) { broad_phase_->visit_overlapping(box, t, look); };
  answer(
      "World::visit_overlapping", ask, [&](BodySlot slot) { return volumes_.meets(slot, box, t); }, visit);
}

template <class Motion>
void Engine<Motion>::visit_swept(const KineticBox<Motion::degree>& box, double until, BodyVisitor visit) const {
  const double from = now();
  if (!box.min.finite() || !box.max.finite()) {
    throw std::invalid_argument("World::visit_swept: the box is not finite");
  }
  if (!(until >= from && until < never)) {
    throw std::invalid_argument("World::visit_swept: " + std::to_string(until) + " is not a finite time from now on (" +
                                std::to_string(from) + ")");
  }
  const StaticBox swept = bounded_swept_box(box, from, until);
  const auto ask = [&](const auto& look) {
    broad_phase_->visit_swept(box, from, until, look);
    // The broad phase knows only the present piece of a mesh that bends.
    for (BodySlot slot = 0; slot < volumes_.end_of_bent(); ++slot) {
      if (volumes_.bends(slot) && bodies_.entered(slot)) look(slot);
    }
  };
  answer(
      "World::visit_swept", ask, [&](BodySlot slot) { return volumes_.meets_swept(slot, swept, from, until); }, visit);
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class Engine<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
