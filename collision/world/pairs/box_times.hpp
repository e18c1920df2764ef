// When the boxes of pairs meet and part.
#pragma once

#include "collision/world/world_part.hpp"
#include "kds/audit.hpp"
#include "kds/events/dary_queue.hpp"

namespace kds::collision {

/// When the boxes of each pair next meet or part, where that is to be reported and the broad phase does not report it.
/// A part by itself, since these events come before walls and resting contacts, and those of the pairs after them; the
/// pairs (pairs.hpp) set the times, and save them.
template <class Rank>
class BoxTimes : public DaryQueue<Rank> {  // slots are pairs
 public:
  static constexpr Stage stage = Stage::boxes;

  using DaryQueue<Rank>::DaryQueue;

  double next_time() const { return this->empty() ? never : this->top().time; }
  static constexpr bool certify() { return false; }
  static void extend_horizon() {}
  void audit(double t) const {
    if (next_time() < t) throw AuditFailure("World: the boxes of a pair should have met or parted");
  }

  /// None: the times are those that Pairs saves.
  struct Image : NoImage {};
  static Image image() { return {}; }
  static void become(const Image&) {}
};

}  // namespace kds::collision
