// Event queue on the two-pass pairing heap of Boost.Heap: the queue of the paper.
#pragma once

#include "kds/events/event_queue.hpp"

#include <boost/heap/pairing_heap.hpp>

#include <cassert>
#include <utility>
#include <vector>

namespace kds {

/// A pairing heap [Stasko87]; amortised O(log n) for pop and clear, O(1) or nearly so for set of an empty slot.
///
/// Paper: section 4.5. Differs: the paper's is the "auxiliary" variant, which gathers insertions in a list of their own
/// until the next pop; Boost's links them to the root at once. A node is allocated for each entry, when it is set and
/// was not there: this queue is here for comparison, and is not the default.
template <QueueRank Rank = SlotRank>
class PairingQueue {
 public:
  explicit PairingQueue(Rank rank = {}) : rank_(rank) {}
  PairingQueue(PairingQueue&& other) noexcept : PairingQueue(other.rank_) { swap(other); }
  PairingQueue& operator=(PairingQueue&& other) noexcept {
    swap(other);
    return *this;
  }
  /// One entry at a time: Boost's own clear() recurses to the depth of the tree, which may be the number of entries.
  ~PairingQueue() { resize(0); }

  void resize(std::size_t slots) {
    for (std::size_t slot = slots; slot < entries_.size(); ++slot) {
      if (contains(static_cast<Slot>(slot))) heap_.erase(entries_[slot].handle);
    }
    entries_.resize(slots);
  }

  void set(Slot slot, double time) {
    assert(slot < entries_.size() && time > -detail::no_event);
    if (time == detail::no_event) return clear(slot);
    ++operations_;
    Entry& entry = entries_[slot];
    const Key key = Key::make(time, slot, rank_);
    if (entry.time == detail::no_event) {
      entry.handle = heap_.push(key);
    } else {
      heap_.update(entry.handle, key);
    }
    entry.time = time;
  }

  void clear(Slot slot) {
    if (!contains(slot)) return;
    ++operations_;
    heap_.erase(entries_[slot].handle);
    entries_[slot].time = detail::no_event;
  }

  void pop() {
    assert(!empty());
    clear(heap_.top().slot);
  }

  QueuedEvent top() const {
    assert(!empty());
    return {heap_.top().time, heap_.top().slot};
  }

  bool contains(Slot slot) const { return time(slot) != detail::no_event; }
  double time(Slot slot) const { return entries_[slot].time; }
  bool empty() const { return heap_.empty(); }
  std::size_t size() const { return heap_.size(); }
  std::size_t slots() const { return entries_.size(); }
  std::uint64_t operations() const { return operations_; }

 private:
  using Key = detail::QueueKey<Rank>;
  using Heap = boost::heap::pairing_heap<Key, boost::heap::compare<detail::LaterKey<Key>>>;
  struct Entry {
    double time = detail::no_event;
    typename Heap::handle_type handle{};
  };

  void swap(PairingQueue& other) noexcept {
    heap_.swap(other.heap_);
    entries_.swap(other.entries_);
    std::swap(operations_, other.operations_);
    std::swap(rank_, other.rank_);
  }

  Heap heap_;
  std::vector<Entry> entries_;  // by slot
  std::uint64_t operations_ = 0;
  [[no_unique_address]] Rank rank_;
};

static_assert(EventQueue<PairingQueue<>>);

}  // namespace kds
