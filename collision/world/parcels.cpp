// How the bodies of a world are divided among several processes, which store a part each, and put back into one world.
#include "collision/motions.hpp"
#include "collision/world/engine.hpp"
#include "collision/world/parcel.hpp"

#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace kds::collision {

template <class Motion>
Parcel<Motion> Engine<Motion>::pack(std::span<const BodySlot> slots,
                                    std::vector<std::shared_ptr<const Mesh>> meshes) const {
  Parcel<Motion> parcel{.bodies = bodies_.image_of(slots, std::move(meshes))};
  for (const BodySlot slot : slots) {
    const auto to_come = scripts_.to_come(slot);
    parcel.numbers.push_back(bodies_.number(slot));
    parcel.to_come.emplace_back(to_come.begin(), to_come.end());
    parcel.turning.push_back(tumbling_.progress(slot));
    parcel.met.push_back(resting_.has_met(slot));
  }
  return parcel;
}

/// The later events of a body in a parcel do not change.
template <class Motion>
void Engine<Motion>::resume(const Parcel<Motion>& parcel, std::size_t place, BodySlot slot) {
  const std::vector<Motion>& to_come = parcel.to_come[place];
  scripts_.add(slot, std::vector<Motion>(to_come.rbegin(), to_come.rend()));
  if constexpr (turns<Motion>) {
    const auto& turning = parcel.turning[place];
    if (turning.body()) tumbling_.add(slot, turning.body()->inertia), tumbling_.go_on_from(slot, turning);
  }
  if (parcel.met[place]) resting_.note_meeting(slot);
}

template <class Motion>
std::vector<BodySlot> Engine<Motion>::store(const Parcel<Motion>& parcel, const Engine& whole) {
  std::vector<BodySlot> slots;
  slots.reserve(parcel.numbers.size());
  for (std::size_t i = 0; i < parcel.numbers.size(); ++i) {
    const BodySlot slot = bodies_.put(parcel.bodies, i, parcel.numbers[i], whole.bodies_);
    resume(parcel, i, slot);
    if (!bodies_[slot].entered && has_begun(slot)) bodies_.wait(slot);
    slots.push_back(slot);
  }
  return slots;
}

template <class Motion>
void Engine<Motion>::forget(std::span<const BodySlot> slots) {
  for (const BodySlot slot : slots) {
    resting_.forget(slot);
    scripts_.clear(slot);
    tumbling_.remove(slot);
    bodies_.remove(slot);
  }
}

template <class Motion>
void Engine<Motion>::lend() {
  bodies_.lend();
  scripts_.become({});
  tumbling_.become({});
}

template <class Motion>
void Engine<Motion>::put_back(const Parcel<Motion>& parcel) {
  for (std::size_t i = 0; i < parcel.numbers.size(); ++i) {
    const BodySlot slot = parcel.numbers[i];
    bodies_.put_back(parcel.bodies, i, slot);
    resume(parcel, i, slot);
    if (bodies_[slot].shape && has_mesh(bodies_[slot].shape->shape)) volumes_.make_room_for_meshes();
    volumes_.add(slot, {});
  }
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class Engine<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
