// When the bodies of a world reach its walls.
#pragma once

#include "collision/broad_phase/broad_phase.hpp"
#include "collision/motions.hpp"
#include "collision/world/bodies.hpp"
#include "collision/world/clock.hpp"
#include "collision/world/world_part.hpp"
#include "collision/world_options.hpp"
#include "kds/events/calendar_queue.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace kds::collision {

/// For each body that has entered a world with walls, a time before which the ball around it goes through none of them:
/// a cheap bound, and the exact time only for the body that is first.
///
/// A ball reaches a wall when it is outside and still going outward. Walls have the numbers of WallEvent.
///
/// Cost: nothing where there are no walls; O(1) for a change of motion.
template <class Motion>
class WallTimes {
 public:
  static constexpr Stage stage = Stage::reported;

  using Entry = typename BroadPhase<Motion::degree>::Entry;

  WallTimes(const Bodies<Motion>& bodies, const std::optional<Walls>& walls, const Clock& clock)
      : bodies_(bodies), walls_(walls), clock_(clock), times_(BodyRank{&bodies.keys()}) {}

  /// Bodies have entered, or one has another motion.
  void schedule(std::span<const Entry> entries);
  void schedule(BodySlot slot);
  void remove(BodySlot slot);
  /// A hint: the body will soon have another motion.
  void prefetch(BodySlot slot) const {
    if (slot < times_.slots()) times_.prefetch(slot);
  }
  void reserve(std::size_t bodies);
  /// Gives back memory that fewer bodies do not need.
  void fit() { times_.fit(); }

  /// A time up to which no body reaches a wall.
  double next_time() const { return times_.empty() ? never : times_.top().time; }
  /// The body to which next_time() belongs. Precondition: next_time() < never.
  BodySlot next_body() const { return times_.top().slot; }
  /// If next_time() is only a bound, replaces it by the exact time, which may be later; true if it was one.
  bool certify();
  /// The wall that the next body reaches then. Precondition: certify() has returned false.
  int next_wall() const { return wall_[next_body()]; }
  void extend_horizon();
  /// Throws AuditFailure if a body reaches a wall before its time, or should have reached one before t.
  void audit(double t) const;

  /// Forgets all times.
  void forget_all() {
    times_.resize(0);
    wall_.clear();
  }
  /// Times are not saved or loaded: they are functions of the motions.
  struct Image : NoImage {};
  static Image image() { return {}; }
  void become(const Image& = {});

 private:
  static constexpr signed char none_yet = -1;

  void make_room(std::size_t slots);
  void note(BodySlot slot, double earliest);
  double exact_time(BodySlot slot, int wall, double horizon) const;

  const Bodies<Motion>& bodies_;
  const std::optional<Walls>& walls_;
  const Clock& clock_;
  CalendarQueue<BodyRank> times_;  ///< slots are bodies
  /// By body: the wall that it reaches at its time, or `none_yet` if that is only a bound.
  std::vector<signed char> wall_;
};

#define KDS_DECLARE(motion) extern template class WallTimes<motion>;
KDS_FOR_ALL_MOTIONS(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
