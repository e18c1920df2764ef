// Whether resting contacts are as they must be.
#include "collision/motions.hpp"
#include "collision/vectors.hpp"
#include "collision/world/resting/resting_contacts.hpp"
#include "kds/audit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

namespace kds::collision {

/// Each contact is of two bodies that are there (or one and a wall), is listed with them and no others, and lasts:
/// along its normal the two have no relative velocity up to rounding, as drop_broken() measures it, and accelerations
/// that cancel. The times at which contacts end lie ahead.
template <class Motion>
void RestingContacts<Motion>::audit(double t) const {
  if (!solved()) return;
  const auto fail = [](Slot slot, const char* what) {
    throw AuditFailure("World: resting contact " + std::to_string(slot) + ": " + what);
  };
  std::size_t listed = 0;
  std::size_t expected = 0;
  for (BodySlot id = 0; id < of_.size(); ++id) {
    const double ends = of_[id].span_ends;
    if (ends == -never || ends == never) continue;
    if (ends < t) throw AuditFailure("World: the span of body " + std::to_string(id) + "'s cluster should have ended");
    if (spans_.empty() || spans_.top().time > ends) {
      throw AuditFailure("World: no span ends when that of body " + std::to_string(id) + "'s cluster does");
    }
  }
  for (BodySlot id = 0; id < of_.size(); ++id) {
    for (const Slot slot : of_[id].contacts) {
      ++listed;
      if (slot >= contacts_.size() || !contacts_[slot].alive) fail(slot, "a body lists a contact that is none");
      if (contacts_[slot].a != id && contacts_[slot].b != id) fail(slot, "a body lists it that has no part in it");
    }
  }
  for (Slot slot = 0; slot < contacts_.size(); ++slot) {
    const Contact& contact = contacts_[slot];
    if (!contact.alive) {
      if (releases_.contains(slot)) fail(slot, "it has ended, but has a time at which it ends");
      continue;
    }
    const bool at_wall = contact.b == no_body;
    expected += at_wall ? 1 : 2;
    for (const BodySlot id : {contact.a, at_wall ? contact.a : contact.b}) {
      if (!bodies_.entered(id)) fail(slot, "a body is not there");
      const auto& known = of_[id].contacts;
      if (std::count(known.begin(), known.end(), slot) != 1) fail(slot, "a body does not know it");
    }
    if (at_wall && (contact.wall < 0 || contact.wall > 5 || !gaps_.any_walls())) fail(slot, "there is no such wall");
    if (std::abs(norm(contact.normal) - 1) > 0x1p-40) fail(slot, "its normal has no unit length");
    if (releases_.time(slot) < t) fail(slot, "it should have ended");
    if (contact.fresh) continue;
    if ((!at_wall || clustered(contact.a)) && gaps_.deeper(contact, contact.depth + gaps_.deepest_overlap(contact)))
      fail(slot, "its bodies overlap");
    if (clustered(contact.a) || (!at_wall && clustered(contact.b))) continue;
    const Eigen::Vector3d a = bodies_.path(contact.a).velocity(t);
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    if (!at_wall) b = bodies_.path(contact.b).velocity(t);
    double largest = std::max({a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), contact.solved});
    if constexpr (Motion::degree >=
                  2) {  // Accelerations cancel along the normal, up to rounding, and act since the start.
      for (const BodySlot id : {contact.a, at_wall ? contact.a : contact.b}) {
        largest += 2 * bodies_.free_term(id, 2, t).cwiseAbs().maxCoeff() * (1 + t - bodies_.path(id).start);
      }
    }
    if constexpr (Motion::degree >= 3) {
      for (const BodySlot id : {contact.a, at_wall ? contact.a : contact.b})
        largest += velocity_terms(bodies_.path(id), t);
    }
    if (std::abs(dot(contact.normal, b - a)) > 16 * rate_rounding * largest) {
      fail(slot, "the bodies part or press on along its normal");
    }
  }
  if (listed != expected) fail(static_cast<Slot>(contacts_.size()), "bodies list more contacts than there are");
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class RestingContacts<motion>;
KDS_FOR_EACH_PATH(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
