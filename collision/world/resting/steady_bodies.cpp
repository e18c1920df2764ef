// Bodies that lie steady on fixed ones: to solve for them again changes nothing.
#include "collision/motions.hpp"
#include "collision/world/resting/resting_contacts.hpp"

#include <algorithm>
#include <vector>

namespace kds::collision {

/// Whether to solve for a body again changes nothing as long as its motion and those of what carries it stay as they
/// are: nothing accelerates it, and normals are along axes, where no rate is rounded (least_constraint.hpp).
template <class Motion>
bool RestingContacts<Motion>::steady(BodySlot id) const {
  if (Motion::degree > 2 || clustered(id) || of_[id].disturbed) return false;
  const auto uniform = [this](BodySlot slot) {
    if constexpr (Motion::degree == 2) return bodies_.path(slot).coefficients[2].isZero(0);
    return true;
  };
  const auto& contacts = of_[id].contacts;
  return uniform(id) && std::all_of(contacts.begin(), contacts.end(), [&](Slot slot) {
           const Contact& contact = contacts_[slot];
           const auto sizes = contact.normal.cwiseAbs();
           if (contact.fresh || sizes.maxCoeff() != 1 || sizes.sum() != 1) return false;
           if (contact.b == no_body) return true;
           const BodySlot carrier = contact.a == id ? contact.b : contact.a;
           return bodies_.fixed(carrier) && uniform(carrier);
         });
}

/// Whether all later events of a body, as far as contacts that last are concerned, follow from its own state: no other
/// is solved for with it, nor because of it.
template <class Motion>
bool RestingContacts<Motion>::is_complete(BodySlot id) const {
  const auto& contacts = of_[id].contacts;
  const auto at_wall = [this](Slot slot) { return contacts_[slot].b == no_body; };
  return bodies_.fixed(id) || std::all_of(contacts.begin(), contacts.end(), at_wall) || steady(id);
}

template <class Motion>
bool RestingContacts<Motion>::is_carried(BodySlot id) const {
  const auto& contacts = of_[id].contacts;
  return !bodies_.fixed(id) && std::any_of(contacts.begin(), contacts.end(), [&](Slot slot) {
    const Contact& contact = contacts_[slot];
    return contact.b != no_body && bodies_.fixed(contact.a == id ? contact.b : contact.a);
  });
}

template <class Motion>
void RestingContacts<Motion>::note_carried(BodySlot id) {
  if (bodies_.numbered() || of_[id].listed || !is_carried(id)) return;
  of_[id].listed = true;
  carried_.push_back(id);
}

/// Whether a fixed body carries one that is not steady and waits for no solution. Cost: that of all bodies that rest on
/// fixed ones and are not steady; of those that have become so, once.
template <class Motion>
bool RestingContacts<Motion>::carries_unsteady(BodySlot id) {
  bool any = false;
  std::erase_if(carried_, [&](BodySlot carried) {
    if (!is_carried(carried) || steady(carried)) {
      of_[carried].listed = false;
      return true;
    }
    const auto& contacts = of_[carried].contacts;
    any = any || (!of_[carried].disturbed && std::any_of(contacts.begin(), contacts.end(), [&](Slot slot) {
            return contacts_[slot].a == id || contacts_[slot].b == id;
          }));
    return false;
  });
  return any;
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class RestingContacts<motion>;
KDS_FOR_EACH_PATH(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
