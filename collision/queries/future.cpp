#include "collision/queries/future.hpp"

#include "collision/body_description.hpp"
#include "collision/broad_phase/kinetic_box.hpp"
#include "collision/broad_phase/swept_box.hpp"
#include "collision/motion_range.hpp"
#include "collision/narrow_phase/mesh_margins.hpp"
#include "collision/queries/standing_body.hpp"
#include "collision/vectors.hpp"
#include "collision/world/edits/checked_pieces.hpp"
#include "kds/number_text.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// Throws unless a query can look from now until then.
template <class Motion>
void require_span(const char* function, const BasicWorld<Motion>& world, double until) {
  if (until >= world.now() && until < never) return;
  throw std::invalid_argument(std::string(function) + ": " + number_text(until) +
                              " is not a finite time from now on (" + number_text(world.now()) + ")");
}

/// A box that moves with a shape and contains it in any orientation that it takes, with room for the margin within
/// which a mesh meets it.
template <class Motion>
KineticBox<Motion::degree> box_of(const MovingShape<Motion>& body) {
  const auto& path = path_of(body.motion);
  const double radius = body.shape.bounding_radius;
  KineticBox<Motion::degree> box;
  if constexpr (turns<Motion>) {
    box = box_around(path, Vector3d::Constant(-radius), Vector3d::Constant(radius));
  } else {
    box = box_around(path, body.shape.low, body.shape.high);
  }
  grow(box, MeshClearance<Motion::degree>(path, radius).growing(), path.start);
  return box;
}

/// Throws unless the shape is placed, and can move so.
template <class Motion>
void require_shape(const PlacedShape& shape) {
  if (!is_placed(shape)) throw std::invalid_argument("next_contact: the shape is not what place() makes of it");
  if (!can_move_by<Motion>(shape.shape)) {
    throw std::invalid_argument(std::string("next_contact: no shape of this kind moves so: ") + kind_name(shape.shape));
  }
  if (turns<Motion> && shape.rotation != Eigen::Matrix3d::Identity()) {
    throw std::invalid_argument(
        "next_contact: the shape is turned; of bodies that turn the motion has the orientation");
  }
}

template <class Motion>
std::optional<Contact> meeting(const MovingShape<Motion>& a, const MovingShape<Motion>& b, double now, double until,
                               ContactMode mode) {
  FoundTouch found;
  const double t = first_contact(a, b, now, until, mode, &found);
  if (t == never) return std::nullopt;
  return contact_at(a, b, t, found);
}

/// Calls visit(id) for each body in the box around the way.
template <class Motion, class Visit>
void visit_on_way(const BasicWorld<Motion>& world, const MovingShape<Motion>& mover, double until, const Visit& visit) {
  if (unbounded(mover.shape.shape)) {
    world.visit_overlapping(Vector3d::Constant(-never), Vector3d::Constant(never), visit);
  } else {
    world.visit_swept(box_of(mover), until, visit);
  }
}

template <class Motion>
std::optional<Hit> hit(const BasicWorld<Motion>& world, const MovingShape<Motion>& mover, BodyId id, double until,
                       ContactMode mode) {
  const PlacedShape shape = world.shape(id);
  const MovingShape<Motion> body{shape, world.motion(id)};
  const auto contact = meeting(mover, body, world.now(), until, mode);
  return contact ? std::optional(Hit{id, *contact}) : std::nullopt;
}

/// The first of the bodies that are accepted.
template <class Motion, class Accept>
std::optional<Hit> first_met(const BasicWorld<Motion>& world, const MovingShape<Motion>& mover, double until,
                             ContactMode mode, const Accept& accept) {
  std::optional<Hit> first;
  visit_on_way(world, mover, until, [&](BodyId id) {
    if (!accept(id)) return;
    const auto met = hit(world, mover, id, first ? first->contact.time : until, mode);
    if (met && (!first || detail::sooner(*met, *first))) first = met;
  });
  return first;
}

/// All of the bodies that are accepted, by time.
template <class Motion, class Accept>
std::vector<Hit> all_met(const BasicWorld<Motion>& world, const MovingShape<Motion>& mover, double until,
                         ContactMode mode, const Accept& accept) {
  std::vector<Hit> all;
  visit_on_way(world, mover, until, [&](BodyId id) {
    if (!accept(id)) return;
    if (const auto met = hit(world, mover, id, until, mode)) all.push_back(*met);
  });
  std::sort(all.begin(), all.end(), detail::sooner);
  return all;
}

/// Throws unless next_contact() can look for what such a shape meets.
template <class Motion>
void require_mover(const BasicWorld<Motion>& world, const PlacedShape& shape, const Motion& motion, double until) {
  require_span("next_contact", world, until);
  require_shape<Motion>(shape);
  if (!in_range(motion) || !(path_of(motion).start <= world.now())) {
    throw std::invalid_argument("next_contact: the motion is out of the range of shape.hpp, or begins after now (" +
                                number_text(world.now()) + ")");
  }
  if constexpr (turns<Motion>) {
    require_no_spin(shape.shape, motion, "next_contact: motion");
  }
}

}  // namespace

template <class Motion>
std::optional<Hit> next_contact(const BasicWorld<Motion>& world, const PlacedShape& shape, const Motion& motion,
                                double until, const BodyFilter& filter) {
  require_mover(world, shape, motion, until);
  return first_met(world, MovingShape<Motion>{shape, motion}, until, ContactMode::transparent,
                   [&](BodyId id) { return detail::accepts(filter, id); });
}

template <class Motion>
std::vector<Hit> next_contacts(const BasicWorld<Motion>& world, const PlacedShape& shape, const Motion& motion,
                               double until, const BodyFilter& filter) {
  require_mover(world, shape, motion, until);
  return all_met(world, MovingShape<Motion>{shape, motion}, until, ContactMode::transparent,
                 [&](BodyId id) { return detail::accepts(filter, id); });
}

template <class Motion>
std::optional<Hit> next_contact_of(const BasicWorld<Motion>& world, BodyId body, double until, const BodyFilter& filter,
                                   ContactMode mode) {
  require_span("next_contact_of", world, until);
  if (!detail::entered(world, body)) return std::nullopt;
  const PlacedShape shape = world.shape(body);
  const Motion motion = world.motion(body);
  return first_met(world, MovingShape<Motion>{shape, motion}, until, mode,
                   [&](BodyId id) { return id != body && detail::accepts(filter, id); });
}

template <class Motion>
std::vector<Hit> next_contacts_of(const BasicWorld<Motion>& world, BodyId body, double until, const BodyFilter& filter,
                                  ContactMode mode) {
  require_span("next_contacts_of", world, until);
  if (!detail::entered(world, body)) return {};
  const PlacedShape shape = world.shape(body);
  const Motion motion = world.motion(body);
  return all_met(world, MovingShape<Motion>{shape, motion}, until, mode,
                 [&](BodyId id) { return id != body && detail::accepts(filter, id); });
}

template <class Motion>
std::optional<Contact> next_contact_between(const BasicWorld<Motion>& world, BodyId a, BodyId b, double until,
                                            ContactMode mode) {
  require_span("next_contact_between", world, until);
  if (a == b) throw std::invalid_argument("next_contact_between: a body does not meet itself");
  if (!detail::entered(world, a) || !detail::entered(world, b)) return std::nullopt;
  const PlacedShape shape_a = world.shape(a);
  const PlacedShape shape_b = world.shape(b);
  return meeting(MovingShape<Motion>{shape_a, world.motion(a)}, MovingShape<Motion>{shape_b, world.motion(b)},
                 world.now(), until, mode);
}

template <class Motion>
Approach closest_approach(const BasicWorld<Motion>& world, BodyId a, BodyId b, double until) {
  require_span("closest_approach", world, until);
  for (const BodyId id : {a, b}) detail::require_entered("closest_approach", world, id);
  return closest_approach(path_of(world.motion(a)), path_of(world.motion(b)), world.now(), until);
}

#define KDS_INSTANTIATE(motion)                                                                                  \
  template std::optional<Hit> next_contact(const BasicWorld<motion>&, const PlacedShape&, const motion&, double, \
                                           const BodyFilter&);                                                   \
  template std::optional<Hit> next_contact_of(const BasicWorld<motion>&, BodyId, double, const BodyFilter&,      \
                                              ContactMode);                                                      \
  template std::vector<Hit> next_contacts(const BasicWorld<motion>&, const PlacedShape&, const motion&, double,  \
                                          const BodyFilter&);                                                    \
  template std::vector<Hit> next_contacts_of(const BasicWorld<motion>&, BodyId, double, const BodyFilter&,       \
                                             ContactMode);                                                       \
  template std::optional<Contact> next_contact_between(const BasicWorld<motion>&, BodyId, BodyId, double,        \
                                                       ContactMode);                                             \
  template Approach closest_approach(const BasicWorld<motion>&, BodyId, BodyId, double);
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
