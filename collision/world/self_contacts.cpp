#include "collision/world/self_contacts.hpp"

#include "collision/narrow_phase/kept_rotation.hpp"
#include "collision/narrow_phase/self_contact.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/shapes/shape_forms.hpp"
#include "collision/world/bodies_image.hpp"
#include "collision/world/queue_room.hpp"
#include "kds/audit.hpp"

#include <string>

namespace kds::collision {
namespace {

const MeshScript& script_in(const PlacedShape& shape) { return *script_of(shape.shape); }

}  // namespace

template <class Motion>
bool SelfContacts<Motion>::enter(BodySlot slot) {
  if (!follows(slot)) return false;
  if (touching_.size() <= slot) touching_.resize(slot + std::size_t{1});
  touching_[slot] = in_self_contact(script_in(*bodies_[slot].shape), clock_.now);
  find_next(slot);
  return touching_[slot];
}

template <class Motion>
void SelfContacts<Motion>::remove(BodySlot slot) {
  clear(times_, slot);
  if (slot < touching_.size()) touching_[slot] = false;
}

template <class Motion>
void SelfContacts<Motion>::find_next(BodySlot slot) {
  make_room(times_, bodies_.slots());
  const MeshScript& script = script_in(*bodies_[slot].shape);
  const double time = touching_[slot] ? first_self_separation(script, clock_.now, clock_.horizon)
                                      : first_self_contact(script, clock_.now, clock_.horizon);
  if (time < never) {
    times_.set(slot, time);
  } else {
    times_.clear(slot);
  }
}

template <class Motion>
typename SelfContacts<Motion>::Event SelfContacts<Motion>::take_next() {
  const BodySlot slot = times_.top().slot;
  const Event event{slot, touching(slot)};
  touching_[slot] = !event.separates;
  find_next(slot);
  return event;
}

template <class Motion>
Contact SelfContacts<Motion>::contact(BodySlot slot) const {
  const PlacedShape& shape = *bodies_[slot].shape;
  Contact contact = self_contact_at(script_in(shape), clock_.now);
  const Eigen::Matrix3d rotation = kept_rotation(shape, bodies_.motion(slot));
  contact.point = bodies_.path(slot).position(clock_.now) + placed_vertex(rotation, 1, contact.point);
  contact.normal = placed_vertex(rotation, 1, contact.normal);
  return contact;
}

template <class Motion>
void SelfContacts<Motion>::extend_horizon() {
  for (BodySlot slot = 0; slot < touching_.size(); ++slot) {
    if (follows(slot) && !times_.contains(slot)) find_next(slot);
  }
}

template <class Motion>
void SelfContacts<Motion>::audit(double t) const {
  for (BodySlot slot = 0; slot < touching_.size(); ++slot) {
    if (!follows(slot) || (times_.contains(slot) && times_.time(slot) <= t)) continue;
    if (in_self_contact(script_in(*bodies_[slot].shape), t) == touching(slot)) continue;
    throw AuditFailure("World: body " + std::to_string(bodies_.id_of(slot)) +
                       ": whether it touches itself is not known");
  }
}

template <class Motion>
void SelfContacts<Motion>::Image::check(const typename Bodies<Motion>::Image& bodies, double,
                                        const WorldOptions&) const {
  for (std::size_t slot = 0; slot < touching.size(); ++slot) {
    const bool may = bodies.entered(static_cast<BodySlot>(slot)) && bodies.bodies[slot].self_contacts;
    image::require(!touching[slot] || may, "self_contacts", slot, "is of no body that meets itself");
  }
}

template <class Motion>
void SelfContacts<Motion>::become(const Image& image) {
  touching_ = image.touching;
  times_.resize(0);
  for (BodySlot slot = 0; slot < bodies_.slots(); ++slot) {
    if (!follows(slot)) continue;
    if (touching_.size() <= slot) touching_.resize(slot + std::size_t{1});
    find_next(slot);
  }
}

#define KDS_INSTANTIATE(motion) template class SelfContacts<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
