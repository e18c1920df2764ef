// The resting contacts of a world as plain data: written, read and checked.
#include "collision/motions.hpp"
#include "collision/world/bodies_image.hpp"
#include "collision/world/image_tools.hpp"
#include "collision/world/resting/resting_contacts.hpp"
#include "kds/framework/snapshot.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

namespace kds::collision {

template <class Motion>
template <class Archive>
void RestingContacts<Motion>::Image::archive(Archive& archive) {
  archive(free, disturbed, releases, span_ends, calm_since, met, spans);
  archive.each(of, [&](auto& slots) { archive(slots); });
  archive(contacts);
}

template <class Motion>
void RestingContacts<Motion>::Image::check(const typename Bodies<Motion>::Image& bodies, double now,
                                           const WorldOptions& options) const {
  if (releases.size() != contacts.size()) image::fail("releases: are not as many as resting contacts");
  if (of.size() > bodies.bodies.size()) image::fail("resting: of more bodies than there are");
  if (span_ends.size() != of.size() || calm_since.size() != of.size() || met.size() != of.size()) {
    image::fail("clusters: are not of as many bodies as resting contacts");
  }
  bool spans_go_on = false;
  double first = never;
  for (std::size_t i = 0; i < spans.size(); ++i) {
    image::require(image::is_to_come(spans[i], now) && (spans[i] == never || bodies.entered(static_cast<BodySlot>(i))),
                   "spans", i, "has ended, or is of no body");
    first = std::min(first, spans[i]);
  }
  for (std::size_t i = 0; i < of.size(); ++i) {
    const bool none = span_ends[i] == -never;
    image::require(none || (image::is_to_come(span_ends[i], now) && bodies.entered(static_cast<BodySlot>(i))),
                   "clusters", i, "has ended, or is of no body");
    image::require(none || options.response == Response::elastic, "clusters", i,
                   "is there in a mode without resting contacts");
    image::require(calm_since[i] == never || image::is_past(calm_since[i], now), "clusters", i, "is not calm yet");
    spans_go_on = spans_go_on || (!none && span_ends[i] < never && span_ends[i] < first);
  }
  if (spans_go_on && disturbed.empty()) image::fail("clusters: there is one that never ends");
  for (std::size_t i = 0; i < disturbed.size(); ++i) {
    image::require(bodies.entered(disturbed[i]), "disturbed", i, "is no body in the world");
  }
  std::size_t dead = 0;
  std::size_t sides = 0;
  for (std::size_t slot = 0; slot < contacts.size(); ++slot) {
    const auto& contact = contacts[slot];
    const auto need = [slot](bool right, const char* what) { image::require(right, "resting", slot, what); };
    dead += !contact.alive;
    if (!contact.alive) {
      need(releases[slot] == never, "is over, and is to be let go");
      continue;
    }
    const bool at_wall = contact.b == no_body;
    sides += at_wall ? 1 : 2;
    need(bodies.entered(contact.a), "is not of a body in the world");
    if (at_wall) {
      need(options.walls && contact.wall >= 0 && contact.wall < 6, "is at no wall");
    } else {
      need(bodies.before(contact.a, contact.b) && bodies.entered(contact.b) && contact.wall == -1,
           "is not of two bodies in the world");
      need(bodies.bodies[contact.a].inverse_mass > 0 || bodies.bodies[contact.b].inverse_mass > 0,
           "is of two bodies that are fixed");
      need(options.response == Response::elastic, "is of two bodies in a mode without resting contacts");
    }
    detail::check_numbers(contact, now, need);
    need(image::is_to_come(releases[slot], now), "is to be let go before now");
    if constexpr (Motion::degree >= 3) {
      // In a cluster the spans end it.
      const auto spans = [&](BodySlot id) { return id < span_ends.size() && span_ends[id] != -never; };
      const bool clustered = spans(contact.a) || (!at_wall && spans(contact.b));
      need(clustered || image::is_to_come(contact.ends, now), "is pressed together until before now");
    }
  }
  for (std::size_t id = 0; id < of.size(); ++id) {
    const auto& of_body = of[id];
    for (auto slot = of_body.begin(); slot != of_body.end(); ++slot) {
      const bool known =
          *slot < contacts.size() && contacts[*slot].alive && (contacts[*slot].a == id || contacts[*slot].b == id);
      image::require(known && std::find(of_body.begin(), slot, *slot) == slot, "bodies", id,
                     "lists a contact that is none");
      --sides;
    }
  }
  if (sides != 0) image::fail("resting: there is one that a body does not know");
  std::vector<char> listed(contacts.size());
  for (std::size_t i = 0; i < free.size(); ++i) {
    const Slot slot = free[i];
    image::require(slot < contacts.size() && !contacts[slot].alive && !std::exchange(listed[slot], 1),
                   "free of resting", i, "is no free slot, or listed twice");
  }
  if (free.size() != dead) image::fail("resting: not all that are free are listed");
}

template <class Motion>
typename RestingContacts<Motion>::Image RestingContacts<Motion>::image() const {
  Image image{contacts_, free_, {}, {}, {}, {}, {}, {}, {}};
  // The list may still contain bodies that have been removed, or solved for, since they were disturbed.
  std::copy_if(disturbed_.begin(), disturbed_.end(), std::back_inserter(image.disturbed),
               [&](BodySlot id) { return of_[id].disturbed && bodies_.entered(id); });
  for (BodySlot id = 0; id < of_.size(); ++id) {
    const Member& member = of_[id];
    image.of.push_back(in_order(id));
    image.span_ends.push_back(member.span_ends);
    image.calm_since.push_back(member.calm_since);
    image.met.push_back(member.met);
  }
  for (BodySlot slot = 0; slot < spans_.slots(); ++slot) image.spans.push_back(spans_.time(slot));
  for (Slot slot = 0; slot < contacts_.size(); ++slot) image.releases.push_back(release(slot));
  return image;
}

template <class Motion>
void RestingContacts<Motion>::become(const Image& image) {
  contacts_ = image.contacts, free_ = image.free, disturbed_ = image.disturbed;
  islands_ = 0;
  kept_.clear(), of_.clear();
  for (BodySlot id = 0; id < image.of.size(); ++id) {
    member(id).contacts = image.of[id];
    for (std::uint32_t i = 0; i < image.of[id].size() && bodies_.fixed(id); ++i) contacts_[image.of[id][i]].listed = i;
    member(id).span_ends = image.span_ends[id];
    member(id).calm_since = image.calm_since[id];
    member(id).met = image.met[id] != 0;
  }
  for (const BodySlot id : disturbed_) member(id).disturbed = true;
  for (BodySlot id = 0; id < of_.size(); ++id) {
    Member& member = of_[id];
    const auto at_wall = [this](Slot slot) { return contacts_[slot].wall >= 0; };
    member.carried = bodies_.fixed(id) ? std::any_of(member.contacts.begin(), member.contacts.end(), at_wall)
                                       : member.disturbed || !member.contacts.empty();
  }
  releases_.resize(0);
  releases_.resize(contacts_.size());
  for (Slot slot = 0; slot < contacts_.size(); ++slot) releases_.set(slot, image.releases[slot]);
  spans_.resize(0);
  spans_.resize(image.spans.size());
  for (BodySlot slot = 0; slot < image.spans.size(); ++slot) spans_.set(slot, image.spans[slot]);
  for (Slot slot = 0; slot < contacts_.size(); ++slot) {
    if (contacts_[slot].alive && contacts_[slot].unfinished) schedule_release(slot);
  }
}

#define KDS_INSTANTIATE(motion)                                                \
  KDS_TEMPLATE_PART class RestingContacts<motion>;                             \
  template void RestingContacts<motion>::Image::archive(kds::detail::Writer&); \
  template void RestingContacts<motion>::Image::archive(kds::detail::Reader&);
KDS_FOR_EACH_PATH(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
