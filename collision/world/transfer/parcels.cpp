// How the bodies of a world are divided among several processes, which store a part each, and put back into one world.
#include "collision/motions.hpp"
#include "collision/world/transfer/parcel.hpp"
#include "collision/world/transfer/transfer.hpp"

#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace kds::collision {

template <class Motion>
Parcel<Motion> Transfer<Motion>::pack(std::span<const BodySlot> slots,
                                      std::vector<std::shared_ptr<const Mesh>> meshes) const {
  Parcel<Motion> parcel{.bodies = parts_.bodies.image_of(slots, std::move(meshes))};
  for (const BodySlot slot : slots) {
    const auto to_come = parts_.scripts.to_come(slot);
    parcel.numbers.push_back(parts_.bodies.number(slot));
    parcel.to_come.emplace_back(to_come.begin(), to_come.end());
    parcel.turning.push_back(parts_.tumbling.progress(slot));
    parcel.resting.push_back(parts_.resting.kept()[slot]);
  }
  return parcel;
}

/// The later events of a body in a parcel do not change.
template <class Motion>
void Transfer<Motion>::resume(const Parcel<Motion>& parcel, std::size_t place, BodySlot slot) {
  const std::vector<Motion>& to_come = parcel.to_come[place];
  parts_.scripts.add(slot, std::vector<Motion>(to_come.rbegin(), to_come.rend()));
  if constexpr (turns<Motion>) {
    const auto& turning = parcel.turning[place];
    if (turning.body()) parts_.tumbling.add(slot, turning.body()->inertia), parts_.tumbling.go_on_from(slot, turning);
  }
  parts_.resting.kept().keep(slot, parcel.resting[place]);
}

template <class Motion>
std::vector<BodySlot> Transfer<Motion>::store(const Parcel<Motion>& parcel, const Bodies<Motion>& whole) {
  std::vector<BodySlot> slots;
  slots.reserve(parcel.numbers.size());
  for (std::size_t i = 0; i < parcel.numbers.size(); ++i) {
    const BodySlot slot = parts_.bodies.put(parcel.bodies, i, parcel.numbers[i], whole);
    resume(parcel, i, slot);
    if (!parts_.bodies[slot].entered && has_begun(slot)) parts_.bodies.wait(slot);
    slots.push_back(slot);
  }
  return slots;
}

template <class Motion>
void Transfer<Motion>::forget(std::span<const BodySlot> slots) {
  for (const BodySlot slot : slots) {
    parts_.resting.forget(slot);
    parts_.scripts.clear(slot);
    parts_.tumbling.remove(slot);
    parts_.bodies.remove(slot);
  }
}

template <class Motion>
void Transfer<Motion>::lend() {
  parts_.bodies.lend();
  parts_.scripts.become({});
  parts_.tumbling.become({});
  parts_.resting.kept().clear();
}

template <class Motion>
void Transfer<Motion>::put_back(const Parcel<Motion>& parcel) {
  for (std::size_t i = 0; i < parcel.numbers.size(); ++i) {
    const BodySlot slot = parcel.numbers[i];
    parts_.bodies.put_back(parcel.bodies, i, slot);
    resume(parcel, i, slot);
    if (parts_.bodies[slot].shape && has_mesh(parts_.bodies[slot].shape->shape)) parts_.volumes.make_room_for_meshes();
    parts_.volumes.add(slot, {});
  }
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class Transfer<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
