// Kinetic heap: moving values in heap order, the greatest on top.
#pragma once

#include "kds/audit.hpp"
#include "kds/framework/kinetic.hpp"
#include "structures/ranking.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kds::structures {

/// Another element is on top, or the one that is there has got a new motion.
struct TopChange {
  Id top;  ///< nobody if there are no elements

  friend bool operator==(const TopChange&, const TopChange&) = default;
};

/// Maintains a binary heap of moving values: no element is greater than its parent.
///
/// One certificate for each element but the top; when it fails, parent and child change places. Papers: [Basch99]
/// section 3.1, [daFonseca03] for the number of events.
///
/// Cost: an event O(1), five certificates at most (responsive); an element is in three certificates at most (local);
/// n - 1 certificates (compact); insertion, removal and a new motion O(log n). n values that move on lines make at most
/// O(n log n) events [daFonseca03], of which at most n - 1 change the top.
///
/// If values stay equal any of them may be on top. It reports what comes to be on top (TopChange), so that other rules
/// may stand on it.
template <Ranking Rank>
class HeapRule {
 public:
  using Element = typename Rank::Element;
  using Change = TopChange;
  using Pen = Repair<Element, Change>;
  static constexpr const char* name = "Heap";

  HeapRule() = default;
  explicit HeapRule(Rank rank) : rank_(std::move(rank)) {}

  std::size_t size() const { return heap_.size(); }
  /// Id of a greatest element at t+, none if there are no elements.
  std::optional<Id> top() const { return heap_.empty() ? std::nullopt : std::optional(heap_.front()); }
  /// Ids in heap order: the children of place i stand at 2 i + 1 and 2 i + 2.
  const std::vector<Id>& heap() const { return heap_; }

  // Slot i, from 1: the element at place i is not greater than its parent.
  auto certificate(Slot i, const MovingSet<Element>& elements) const {
    using C = decltype(rank_.in_order(elements[0], elements[0]));
    return i > 0 && i < heap_.size() ? std::optional<C>(rank_.in_order(elements[heap_[i]], elements[heap_[parent(i)]]))
                                     : std::nullopt;
  }
  std::array<Id, 2> members(Slot i) const { return {heap_[i], heap_[parent(i)]}; }

  Effect repair(Slot i, Pen& repair) {
    exchange(i, parent(i), repair);
    if (parent(i) != 0) return Effect::internal;
    tell_top(repair);
    return Effect::external;
  }

  void insert(Id id, Pen& repair) {
    if (place_.size() <= id) place_.resize(repair.elements().end_id(), absent);
    place_[id] = heap_.size();
    heap_.push_back(id);
    sift(place_[id], repair);
    if (place_[id] == 0) tell_top(repair);
  }
  void remove(Id id, Pen& repair) {
    const std::size_t hole = place_[id];
    const std::size_t last = heap_.size() - 1;
    if (hole != last) exchange(hole, last, repair);
    heap_.pop_back();
    place_[id] = absent;
    repair.certify(static_cast<Slot>(last));
    if (hole != last) sift(hole, repair);
    if (hole == 0) tell_top(repair);
  }
  void change(Id id, Pen& repair) {
    const bool was_top = place_[id] == 0;
    sift(place_[id], repair);
    if (was_top || place_[id] == 0) tell_top(repair);
  }

  std::vector<TopChange> changes_from_nothing() const {
    if (heap_.empty()) return {};
    return {{heap_.front()}};
  }

  void audit(const MovingSet<Element>& elements, double /*now*/) const {
    if (heap_.size() != elements.size()) throw AuditFailure("Heap: it does not hold the elements of the set");
    for (std::size_t i = 0; i < heap_.size(); ++i) {
      if (!elements.contains(heap_[i]) || place_[heap_[i]] != i) {
        throw AuditFailure("Heap: place " + std::to_string(i) + ": the element's recorded place is another");
      }
    }
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(heap_, place_);
    if constexpr (Archive::loading) {
      for (std::size_t i = 0; i < heap_.size(); ++i) {
        archive.require(heap_[i] < place_.size() && place_[heap_[i]] == i, "an element of a heap is at another place");
      }
      const auto absentees = static_cast<std::size_t>(std::count(place_.begin(), place_.end(), absent));
      archive.require(place_.size() - absentees == heap_.size(), "a heap knows the place of an element it has not");
    }
  }

 private:
  static constexpr std::size_t absent = static_cast<std::size_t>(-1);
  static std::size_t parent(std::size_t i) { return (i - 1) / 2; }

  void tell_top(Pen& repair) const { repair.report({heap_.empty() ? nobody : heap_.front()}); }

  void exchange(std::size_t i, std::size_t j, Pen& repair) {
    std::swap(heap_[i], heap_[j]);
    place_[heap_[i]] = i;
    place_[heap_[j]] = j;
    certify_around(i, repair);
    certify_around(j, repair);
  }

  /// The certificates that the occupant of a place is in.
  void certify_around(std::size_t i, Pen& repair) {
    if (i > 0) repair.certify(static_cast<Slot>(i));
    for (std::size_t child = 2 * i + 1; child <= 2 * i + 2 && child < heap_.size(); ++child) {
      repair.certify(static_cast<Slot>(child));
    }
  }

  bool greater(std::size_t i, std::size_t j, const Pen& repair) const {
    return repair.sign(rank_.in_order(repair[heap_[i]], repair[heap_[j]])) < 0;
  }

  /// Brings the element at a place up or down to where it belongs.
  void sift(std::size_t i, Pen& repair) {
    certify_around(i, repair);
    while (i > 0 && greater(i, parent(i), repair)) {
      exchange(i, parent(i), repair);
      i = parent(i);
    }
    for (;;) {
      std::size_t greatest = i;
      for (std::size_t child = 2 * i + 1; child <= 2 * i + 2 && child < heap_.size(); ++child) {
        if (greater(child, greatest, repair)) greatest = child;
      }
      if (greatest == i) return;
      exchange(i, greatest, repair);
      i = greatest;
    }
  }

  Rank rank_;
  std::vector<Id> heap_;
  std::vector<std::size_t> place_;
};

/// A heap of values: Heap<2> heap(values, now).
template <int Degree>
using Heap = Kinetic<HeapRule<ByValue<Motion<Degree>>>>;

}  // namespace kds::structures
