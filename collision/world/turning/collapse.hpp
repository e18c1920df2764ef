// Blows that are handed on between bodies in ever shorter flights.
#pragma once

#include "collision/body_id.hpp"
#include "collision/vectors.hpp"
#include "collision/world/image_tools.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace kds::collision::detail {

/// One contact of a collapse.
struct Blow {
  BodySlot a = 0, b = 0;   ///< in their order
  Eigen::Vector3d point;   ///< in the world
  Eigen::Vector3d normal;  ///< unit, from a to b
  double time = 0;         ///< s
  double least = 0;        ///< with this speed the two part for a shortest flight, if no other body strikes them
};

template <class Archive>
void archive_members(Archive& archive, Blow& blow) {
  archive(blow.a, blow.b, blow.time, blow.least);
  image::vector(archive, blow.point), image::vector(archive, blow.normal);
}

/// A body that is pinched between two others, and that gives too little back, hands on the blows of each to the other,
/// infinitely many in finite time: an inelastic collapse [McNamara92]. Each pair parts fast enough for a shortest
/// flight, but the next blow of a neighbour ends that at once. So where bodies have each met others this often within
/// ZenoPolicy::interval, and approach no faster than a few shortest flights make them, the contacts of the interval are
/// resolved together. After more than ZenoPolicy::contacts they are however fast two bodies approach; and two that
/// cannot be parted then, between bodies that close in, are let through each other.
///
/// If this is larger, each collapse takes more contacts; if it is less, heaps have more of them, whose contacts would
/// end by themselves. Bodies that precess are not led back to their free rotations either after so many.
inline constexpr std::uint64_t collapse_meetings = 16;
/// They approach no faster than this times the greatest Blow::least. So only what is about a shortest flight is lost:
/// chains of balls that strike each other fast are not concerned, however close their contacts follow each other.
inline constexpr double collapse_speed = 2;

/// After more than ZenoPolicy::contacts each pair parts with at least this part of the greatest speed with which two of
/// them approach each other, so that they are apart for some time though nothing presses them together.
inline constexpr double parting_share = 0x1p-3;

/// The last contacts of pairs, in the order of their times, of each place of a pair one: only those of the interval are
/// kept.
class Blows {
 public:
  explicit Blows(double interval) : interval_(interval) {}

  /// Two points of a pair that are no farther from each other than `near` are one place.
  void note(const Blow& blow, double near) {
    std::erase_if(blows_, [&](const Blow& other) {
      const bool same = other.a == blow.a && other.b == blow.b && norm(other.point - blow.point) <= near;
      return same || blow.time - other.time > interval_;
    });
    if (blows_.size() >= most_blows) blows_.erase(blows_.begin());
    blows_.push_back(blow);
  }
  void forget(BodySlot slot) {
    std::erase_if(blows_, [slot](const Blow& blow) { return blow.a == slot || blow.b == slot; });
  }
  bool any(double now) const { return !blows_.empty() && now - blows_.back().time <= interval_; }

  /// Those that are linked with the last one by bodies that can move, the last one first.
  template <class CanMove>
  std::vector<Blow> of_last(const CanMove& can_move) const {
    std::vector<Blow> found{blows_.back()};
    std::vector<char> taken(blows_.size());
    taken.back() = 1;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const auto links = [&](BodySlot slot) { return (slot == found[i].a || slot == found[i].b) && can_move(slot); };
      for (std::size_t k = 0; k < blows_.size(); ++k) {
        if (taken[k] || !(links(blows_[k].a) || links(blows_[k].b))) continue;
        taken[k] = 1;
        found.push_back(blows_[k]);
      }
    }
    return found;
  }

  /// As plain data: those that matter at a time.
  std::vector<Blow> image(double now) const { return any(now) ? blows_ : std::vector<Blow>(); }
  void become(std::vector<Blow> blows) { blows_ = std::move(blows); }

 private:
  static constexpr std::size_t most_blows = 256;

  double interval_;
  std::vector<Blow> blows_;
};

}  // namespace kds::collision::detail
