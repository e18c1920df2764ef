// The motions that bodies are given in a window, as domains compare them.
#pragma once

#include "certificates/point_motion.hpp"
#include "certificates/turning/rigid_motion.hpp"
#include "collision/body_id.hpp"
#include "collision/world/resting/resting_contacts.hpp"
#include "collision/world/turning/tumbling.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

namespace kds::collision {

/// A body, by its number, has another motion from a time on, or something of it begins or ceases to rest.
template <class Motion>
struct MotionChange {
  BodySlot number;
  Motion motion;
  double time;  ///< s
  [[no_unique_address]] typename Tumbling<Motion>::Progress turning{};
  [[no_unique_address]] typename RestingPart<Motion>::Progress resting{};

  template <class Archive>
  void archive(Archive& archive) {
    archive(number, motion, time, turning, resting);
  }
};

/// Whether two motions have the same bits. Equality does not suffice: 0 and -0 are equal, and may have different
/// consequences.
template <int Degree>
bool same_bits(const certificates::PointMotion<Degree>& a, const certificates::PointMotion<Degree>& b) {
  return std::memcmp(static_cast<const void*>(&a), static_cast<const void*>(&b), sizeof(a)) == 0;
}
template <int Degree>
bool same_bits(const certificates::RigidMotion<Degree>& a, const certificates::RigidMotion<Degree>& b) {
  const auto same = [](const auto& x, const auto& y) { return std::memcmp(x.data(), y.data(), sizeof(x)) == 0; };
  return same_bits(a.path, b.path) && same(a.orientation.coeffs(), b.orientation.coeffs()) &&
         same(a.angular_velocity, b.angular_velocity);
}
template <class Motion>
bool same_bits(const MotionChange<Motion>& a, const MotionChange<Motion>& b) {
  return a.time == b.time && same_bits(a.motion, b.motion) && same_bits(a.turning, b.turning) &&
         same_bits(a.resting, b.resting);
}

template <class Motion>
bool has_lower_number(const MotionChange<Motion>& a, const MotionChange<Motion>& b) {
  return a.number < b.number;
}

/// Sorts changes by the numbers of bodies; the changes of one body stay in their order.
template <class Motion>
void sort_by_number(std::vector<MotionChange<Motion>>& changes) {
  std::stable_sort(changes.begin(), changes.end(), has_lower_number<Motion>);
}

/// The changes of a window, by the numbers of bodies, and those of one body in the order of time.
template <class Motion>
class MotionChanges {
 public:
  void clear() { all_.clear(); }
  /// Adds those of a step, which must be sorted.
  void append(std::span<const MotionChange<Motion>> fresh) {
    const auto before = static_cast<std::ptrdiff_t>(all_.size());
    all_.insert(all_.end(), fresh.begin(), fresh.end());
    std::inplace_merge(all_.begin(), all_.begin() + before, all_.end(), has_lower_number<Motion>);
  }
  std::span<const MotionChange<Motion>> all() const { return all_; }

 private:
  std::vector<MotionChange<Motion>> all_;
};

}  // namespace kds::collision
