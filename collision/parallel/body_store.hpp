// The bodies that a process stores while the scene is divided.
#pragma once

#include "collision/parallel/slots_by_number.hpp"
#include "collision/world.hpp"
#include "collision/world/engine.hpp"
#include "collision/world/transfer/parcel.hpp"

#include <memory>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

namespace kds::collision {

namespace detail {

/// The engine behind a world.
template <class Motion>
struct EngineOf {
  static Engine<Motion>& of(BasicWorld<Motion>& world) { return *world.engine_; }
};

}  // namespace detail

/// Some bodies of a scene, in a world that is not run.
template <class Motion>
struct BodyPart {
  explicit BodyPart(const WorldOptions& options) : world(options) {}
  Engine<Motion>& engine() { return detail::EngineOf<Motion>::of(world); }

  BasicWorld<Motion> world;  ///< whose slots are not those of the scene
  SlotsByNumber slots{};
};

/// The bodies that a process stores, each as it was at the end of the last step that was committed. A process that is
/// alone stores all of them, where they are: in the world of the whole scene, whose slots are their numbers. Several
/// processes store a part each; then the whole world has lent its bodies, and keeps only attachments and ignored pairs.
template <class Motion>
class BodyStore {
 public:
  /// `whole` must outlive this.
  BodyStore(const WorldOptions& options, Engine<Motion>& whole) : options_(options), whole_(whole) {}

  bool is_part() const { return part_ != nullptr; }
  Engine<Motion>& whole() { return whole_; }
  Engine<Motion>& engine() { return part_ ? part_->engine() : whole_; }
  const Engine<Motion>& engine() const { return part_ ? part_->engine() : whole_; }
  const Bodies<Motion>& bodies() const { return engine().bodies(); }
  /// The ignored pairs, by numbers.
  const IgnoredPairs& ignored() const { return whole_.bodies().ignored(); }
  /// Null where slots are numbers.
  const SlotsByNumber* slots() const { return part_ ? &part_->slots : nullptr; }
  /// The slot of a body; `no_body` if it is not stored here.
  BodySlot find(BodySlot number) const { return part_ ? part_->slots.find(number) : number; }

  /// Calls take(number) for what each body rests or leans on, unless these are walls.
  template <class Take>
  void each_carrier(const Take& take) const {
    for (BodySlot slot = 0; slot < bodies().slots(); ++slot) {
      if (bodies().alive(slot)) engine().transfer().kept_resting(slot).each_other(bodies().number(slot), take);
    }
  }

  /// From now on this stores a part, without bodies at first. Returns the part that it has stored before, if there is
  /// one.
  std::unique_ptr<BodyPart<Motion>> begin_part(double now) {
    WorldOptions options = options_;
    options.start_time = now, options.threads = 1;
    return std::exchange(part_, std::make_unique<BodyPart<Motion>>(options));
  }
  /// The bodies that have been added to the part's world have these numbers, in the order of their slots.
  void number_from(BodySlot first) {
    engine().transfer().number_from(first);
    for (BodySlot slot = 0; slot < bodies().slots(); ++slot) part_->slots.add(first + slot, slot);
  }
  /// Stores this part again, or the whole if it is null.
  void put_part(std::unique_ptr<BodyPart<Motion>> part) { part_ = std::move(part); }
  /// Adds the bodies of a parcel, without attachments. Throws std::runtime_error for a body that is here already.
  /// Precondition: it stores a part.
  void store(const Parcel<Motion>& parcel) {
    const std::vector<BodySlot> slots = engine().transfer().store(parcel, whole_.bodies());
    for (std::size_t i = 0; i < slots.size(); ++i) {
      if (part_->slots.find(parcel.numbers[i]) != no_body) throw std::runtime_error("snapshot: a body is there twice");
      part_->slots.add(parcel.numbers[i], slots[i]);
    }
  }
  /// Adds the bodies of a parcel, none of which is here. Precondition: it stores a part.
  void add(const Parcel<Motion>& parcel) {
    store(parcel);
    const Attachments& attachments = whole_.bodies().attachments();
    if (attachments.empty()) return;
    for (const BodySlot number : parcel.numbers) {
      const BodySlot owner = attachments.owner(number);
      if (owner != no_body) attach(number, owner);
      for (const BodySlot sensor : attachments.sensors(number)) attach(sensor, number);
    }
  }
  /// Forgets bodies, by their numbers. Precondition: it stores a part that has them.
  void forget(std::span<const BodySlot> numbers) {
    std::vector<BodySlot> slots;
    for (const BodySlot number : numbers) slots.push_back(find(number)), part_->slots.remove(number);
    engine().transfer().forget(slots);
  }
  /// As Transfer::note_passed().
  void note_passed(double t) {
    if (part_) part_->engine().transfer().note_passed(t);
    whole_.transfer().note_passed(t);
  }

 private:
  /// Attaches a sensor if both bodies are stored; called for each of the two.
  void attach(BodySlot sensor, BodySlot owner) {
    const BodySlot sensors_slot = find(sensor), owners_slot = find(owner);
    if (sensors_slot == no_body || owners_slot == no_body) return;
    if (bodies().attachments().owner(sensors_slot) == no_body) engine().transfer().attach(sensors_slot, owners_slot);
  }

  const WorldOptions options_;
  Engine<Motion>& whole_;
  std::unique_ptr<BodyPart<Motion>> part_;
};

}  // namespace kds::collision
