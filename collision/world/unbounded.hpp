// The bodies that no box holds, and their pairs.
#pragma once

#include "collision/motions.hpp"
#include "collision/world/bodies.hpp"
#include "collision/world/clock.hpp"
#include "collision/world/pairs/pairs.hpp"
#include "collision/world/world_part.hpp"
#include "kds/audit.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace kds::collision {

/// The unbounded bodies of a world that have entered: half-spaces. The volume of each is all of space, so it is in no
/// broad phase, and makes a pair with each bounded body that it may collide with, from when both have entered until one
/// is removed. Two unbounded bodies are no pair.
///
/// It has no events: which bodies these are changes when bodies enter and are removed.
///
/// Cost: O(1) a body that enters or leaves, for each unbounded one; nothing where there are none.
template <class Motion>
class Unbounded {
 public:
  static constexpr Stage stage = Stage::reported;

  Unbounded(const Bodies<Motion>& bodies, const Clock& clock, Pairs<Motion>& pairs)
      : all_(bodies), clock_(clock), pairs_(pairs) {}

  bool empty() const { return slots_.empty(); }
  std::span<const BodySlot> bodies() const { return slots_; }

  /// An unbounded body has entered.
  void add(BodySlot slot, typename Pairs<Motion>::Begin begin) {
    slots_.push_back(slot);
    pairs_.set_begin(begin);
    begin_pairs(slot);
    pairs_.set_begin(Pairs<Motion>::Begin::moving);
  }
  /// A body is removed: its pairs with unbounded bodies end, or if it is one of them all its pairs.
  void remove(BodySlot slot) {
    end_pairs(slot);
    std::erase(slots_, slot);
  }

  /// Pairs of one body begin or end, since it has entered, or has another filter.
  void begin_pairs(BodySlot slot) {
    every_partner(slot, [&](BodySlot a, BodySlot b) {
      if (!pairs_.listed(a, b)) pairs_.pair_began(a, b, clock_.now);
    });
  }
  void end_pairs(BodySlot slot) {
    every_partner(slot, [&](BodySlot a, BodySlot b) {
      if (pairs_.listed(a, b)) pairs_.pair_ended(a, b, clock_.now);
    });
  }

  /// Finds the unbounded bodies again, after all bodies have been replaced.
  void find() {
    slots_.clear();
    for (BodySlot slot = 0; slot < all_.slots(); ++slot) {
      if (all_.entered(slot) && all_.unbounded(slot)) slots_.push_back(slot);
    }
  }
  /// Calls visit(a, b), a < b, for each pair that may collide.
  template <class Visit>
  void every_pair(const Visit& visit) const {
    for (const BodySlot slot : slots_) {
      every_partner(slot, [&](BodySlot a, BodySlot b) {
        if (all_.may_collide(a, b)) visit(a, b);
      });
    }
  }

  static constexpr double next_time() { return never; }
  static constexpr bool certify() { return false; }
  static void extend_horizon() {}
  /// Throws AuditFailure unless it has all unbounded bodies, and the pairs of these are listed.
  void audit(double) const {
    for (BodySlot slot = 0; slot < all_.slots(); ++slot) {
      const bool is_one = all_.entered(slot) && all_.unbounded(slot);
      if ((std::find(slots_.begin(), slots_.end(), slot) != slots_.end()) != is_one)
        throw AuditFailure("World: body " + std::to_string(all_.id_of(slot)) +
                           ": whether it is unbounded is not known");
    }
    every_pair([&](BodySlot a, BodySlot b) {
      if (pairs_.listed(a, b)) return;
      throw AuditFailure("World: bodies " + std::to_string(all_.id_of(a)) + " and " + std::to_string(all_.id_of(b)) +
                         ": one is unbounded, and the pair is not active");
    });
  }

  /// Which bodies these are is a function of the bodies.
  struct Image : NoImage {};
  static Image image() { return {}; }
  void become(const Image&) { find(); }

 private:
  template <class Visit>
  void every_partner(BodySlot slot, const Visit& visit) const {
    if (slots_.empty()) return;
    if (!all_.unbounded(slot)) {
      for (const BodySlot other : slots_) visit(std::min(slot, other), std::max(slot, other));
    } else if (all_.entered(slot)) {
      for (BodySlot other = 0; other < all_.slots(); ++other) {
        if (all_.entered(other) && !all_.unbounded(other)) visit(std::min(slot, other), std::max(slot, other));
      }
    }
  }

  const Bodies<Motion>& all_;
  const Clock& clock_;
  Pairs<Motion>& pairs_;
  std::vector<BodySlot> slots_;
};

}  // namespace kds::collision
