// Blows that are handed on between bodies in ever shorter flights.
#pragma once

#include "collision/body_id.hpp"
#include "collision/vectors.hpp"
#include "collision/world/image_tools.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <tuple>
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

/// The last contacts of pairs, of each place of a pair one: only those of the interval count.
class Blows {
 public:
  explicit Blows(double interval) : interval_(interval) {}

  /// Two points of a pair that are no farther from each other than `near` are one place.
  void note(const Blow& blow, double near) {
    while (!blows_.empty() && blow.time - blows_.begin()->second.time > interval_) erase(blows_.begin()->first);
    std::vector<Number> same;
    each_link(blow.a, [&](BodySlot other, Number number) {
      if (other == blow.b && norm(blows_.at(number).point - blow.point) <= near) same.push_back(number);
    });
    for (const Number number : same) erase(number);
    add(blow);
  }
  void forget(BodySlot slot) {
    std::vector<Number> gone;
    each_link(slot, [&](BodySlot, Number number) { gone.push_back(number); });
    for (const Number number : gone) erase(number);
  }
  bool any(double now) const { return !blows_.empty() && lasts(blows_.rbegin()->second, now); }
  /// Calls take(other) for each body with which one has a contact that counts, some several times.
  template <class Take>
  void each_partner(BodySlot slot, double now, const Take& take) const {
    if (blows_.empty()) return;
    each_link(slot, [&](BodySlot other, Number number) {
      if (lasts(blows_.at(number), now)) take(other);
    });
  }

  /// Those that are linked with the last one by bodies that can move, the last one first; of many only the last. It
  /// does not depend on any others.
  template <class CanMove>
  std::vector<Blow> of_last(const CanMove& can_move) const {
    std::vector<Number> numbers = linked(can_move, 0);
    if (numbers.size() > most_blows) {
      std::sort(numbers.begin(), numbers.end());
      numbers = linked(can_move, numbers[numbers.size() - most_blows]);
    }
    std::vector<Blow> found;
    for (const Number number : numbers) found.push_back(blows_.at(number));
    return found;
  }

  /// As plain data, in the order of their times: those that matter at a time.
  std::vector<Blow> image(double now) const {
    std::vector<Blow> all;
    if (!any(now)) return all;
    for (const auto& [number, blow] : blows_) all.push_back(blow);
    return all;
  }
  void become(const std::vector<Blow>& blows) {
    blows_.clear(), links_.clear();
    for (const Blow& blow : blows) add(blow);
  }

 private:
  using Number = std::uint64_t;
  using Link = std::tuple<BodySlot, Number, BodySlot>;  ///< a body, a contact, and the other body
  static constexpr std::size_t most_blows = 256;

  bool lasts(const Blow& blow, double now) const { return now - blow.time <= interval_; }
  void add(const Blow& blow) {
    const Number number = blows_.empty() ? 0 : blows_.rbegin()->first + 1;
    blows_.emplace(number, blow);
    links_.insert({blow.a, number, blow.b}), links_.insert({blow.b, number, blow.a});
  }
  void erase(Number number) {
    const Blow& blow = blows_.at(number);
    links_.erase({blow.a, number, blow.b}), links_.erase({blow.b, number, blow.a});
    blows_.erase(number);
  }
  template <class Take>
  void each_link(BodySlot slot, const Take& take) const {
    for (auto it = links_.lower_bound({slot, 0, 0}); it != links_.end() && std::get<0>(*it) == slot; ++it) {
      take(std::get<2>(*it), std::get<1>(*it));
    }
  }
  /// By numbers, in the order in which they are found; none below `first`.
  template <class CanMove>
  std::vector<Number> linked(const CanMove& can_move, Number first) const {
    std::vector<Number> found{blows_.rbegin()->first};
    std::set<Number> taken{found.front()};
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Blow& blow = blows_.at(found[i]);
      std::set<Number> next;
      for (const BodySlot slot : {blow.a, blow.b}) {
        if (!can_move(slot)) continue;
        each_link(slot, [&](BodySlot, Number number) {
          if (number >= first && taken.insert(number).second) next.insert(number);
        });
      }
      found.insert(found.end(), next.begin(), next.end());
    }
    return found;
  }

  double interval_;
  std::map<Number, Blow> blows_;  ///< in the order in which they were noted
  std::set<Link> links_;
};

}  // namespace kds::collision::detail
