// Which sensors move with which bodies.
#pragma once

#include "collision/body_id.hpp"

#include <algorithm>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace kds::collision {

/// Sensors that are attached to bodies, by slot. A sensor has one owner, which is not attached itself.
///
/// Cost: O(log n) each, and O(k) for a body of k sensors.
class Attachments {
 public:
  bool empty() const { return owner_.empty(); }
  /// The body that a sensor moves with, no_body if it is not attached.
  BodySlot owner(BodySlot sensor) const {
    const auto found = owner_.find(sensor);
    return found == owner_.end() ? no_body : found->second;
  }
  /// The sensors of a body, ascending. Valid until one is attached or detached.
  std::span<const BodySlot> sensors(BodySlot owner) const {
    const auto found = sensors_.find(owner);
    return found == sensors_.end() ? std::span<const BodySlot>() : found->second;
  }
  /// Whether both are parts of one body: it and its sensors, which never meet each other.
  bool together(BodySlot a, BodySlot b) const {
    const BodySlot of_a = owner(a), of_b = owner(b);
    return (of_a == no_body ? a : of_a) == (of_b == no_body ? b : of_b);
  }

  void attach(BodySlot sensor, BodySlot owner) {
    owner_[sensor] = owner;
    std::vector<BodySlot>& sensors = sensors_[owner];
    sensors.insert(std::upper_bound(sensors.begin(), sensors.end(), sensor), sensor);
  }
  /// A body is removed: it is attached to no other from then on. Precondition: no sensors are attached to it.
  void detach(BodySlot sensor) {
    const auto found = owner_.find(sensor);
    if (found == owner_.end()) return;
    const auto of_owner = sensors_.find(found->second);
    std::erase(of_owner->second, sensor);
    if (of_owner->second.empty()) sensors_.erase(of_owner);
    owner_.erase(found);
  }
  /// All of them, sensor and owner, ascending.
  std::vector<std::pair<BodySlot, BodySlot>> all() const { return {owner_.begin(), owner_.end()}; }
  void clear() { owner_.clear(), sensors_.clear(); }

 private:
  std::map<BodySlot, BodySlot> owner_;
  std::map<BodySlot, std::vector<BodySlot>> sensors_;
};

}  // namespace kds::collision
