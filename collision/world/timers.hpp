// The timers of a world.
#pragma once

#include "collision/world/image_tools.hpp"
#include "collision/world/world_part.hpp"
#include "collision/world_listener.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "kds/audit.hpp"

#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace kds::collision {

/// Timers that are set, by time, and by the order in which they were set where times are equal.
///
/// Cost: O(log n) each.
class Timers {
 public:
  static constexpr Stage stage = Stage::reported;

  TimerId set(double t) {
    timers_.emplace(t, next_);
    times_.emplace(next_, t);
    return next_++;
  }
  /// False if there is no such timer: it has rung, or was never set.
  bool cancel(TimerId timer) {
    const auto time = times_.extract(timer);
    return !time.empty() && timers_.erase({time.mapped(), timer}) > 0;
  }

  double next_time() const { return timers_.empty() ? never : timers_.begin()->first; }
  static constexpr bool certify() { return false; }
  static void extend_horizon() {}
  /// Precondition: one is set.
  TimerId take_next() {
    const TimerId timer = timers_.extract(timers_.begin()).value().second;
    times_.erase(timer);
    return timer;
  }

  /// Throws AuditFailure unless each timer is known by its number and its time, which is t or later.
  void audit(double t) const {
    if (next_time() < t) throw AuditFailure("World: a timer should have rung");
    bool right = timers_.size() == times_.size();
    for (const auto& [time, timer] : timers_) {
      const auto known = times_.find(timer);
      right = right && known != times_.end() && known->second == time && timer < next_;
    }
    if (!right) throw AuditFailure("World: timers by number and by time are not the same");
  }

  /// All of it, as plain data.
  struct Image {
    struct One {
      double time = 0;
      TimerId timer = 0;
    };
    std::vector<One> timers;  ///< in order
    TimerId next = 0;

    template <class Archive>
    void archive(Archive& archive) {
      archive(next);
      archive.each(timers, [&](One& one) { archive(one.time, one.timer); });
    }
    /// Throws std::runtime_error, naming what is wrong.
    template <class BodiesImage>
    void check(const BodiesImage&, double now, const WorldOptions&) const {
      std::set<TimerId> numbers;
      for (std::size_t i = 0; i < timers.size(); ++i) {
        const auto key = [&](std::size_t k) { return std::pair(timers[k].time, timers[k].timer); };
        image::require(std::isfinite(timers[i].time) && timers[i].time >= now, "timers", i, "is of no time to come");
        image::require(i == 0 || key(i - 1) < key(i), "timers", i, "is out of order");
        image::require(timers[i].timer < next, "timers", i, "has a number that has not been given");
        image::require(numbers.insert(timers[i].timer).second, "timers", i, "is there twice");
      }
    }
  };
  /// Those that ring up to t, in order.
  std::vector<Image::One> due(double t) const {
    std::vector<Image::One> due;
    for (auto timer = timers_.begin(); timer != timers_.end() && timer->first <= t; ++timer)
      due.push_back({timer->first, timer->second});
    return due;
  }
  Image image() const {
    Image image{{}, next_};
    for (const auto& [time, timer] : timers_) image.timers.push_back({time, timer});
    return image;
  }
  void become(const Image& image) {
    timers_.clear(), times_.clear();
    for (const auto& one : image.timers) timers_.emplace(one.time, one.timer), times_.emplace(one.timer, one.time);
    next_ = image.next;
  }

 private:
  std::set<std::pair<double, TimerId>> timers_;
  std::map<TimerId, double> times_;
  TimerId next_ = 0;
};

}  // namespace kds::collision
