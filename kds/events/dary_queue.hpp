// Event queue on the d-ary heap of Boost.Heap.
#pragma once

#include "kds/events/event_queue.hpp"

#include <boost/heap/d_ary_heap.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace kds {

/// An implicit heap whose nodes have Arity children; O(log n) for set, clear and pop.
///
/// A cleared slot is not taken out of the heap but parked in it at the time +infinity, so that after resize() no
/// operation allocates. Four children fit a cache line and are the quickest of 2, 4 and 8.
template <QueueRank Rank = SlotRank, unsigned Arity = 4>
class DaryQueue {
 public:
  explicit DaryQueue(Rank rank = {}) : rank_(rank) {}
  DaryQueue(DaryQueue&&) noexcept = default;
  DaryQueue& operator=(DaryQueue&&) noexcept = default;
  ~DaryQueue() = default;

  void resize(std::size_t slots) {
    if (slots > handles_.capacity()) {  // doubled, so that slots that come one by one do not copy all others each time
      handles_.reserve(std::max(slots, 2 * handles_.capacity()));
      heap_.reserve(handles_.capacity());
    }
    while (handles_.size() > slots) {
      if (contains(static_cast<Slot>(handles_.size() - 1))) --size_;
      heap_.erase(handles_.back());
      handles_.pop_back();
    }
    while (handles_.size() < slots) handles_.push_back(heap_.push(parked(static_cast<Slot>(handles_.size()))));
  }

  void set(Slot slot, double time) {
    assert(slot < handles_.size() && time > -detail::no_event);
    if (time == detail::no_event) return clear(slot);
    size_ += !contains(slot);
    ++operations_;
    heap_.update(handles_[slot], Key::make(time, slot, rank_));
  }

  void clear(Slot slot) {
    if (!contains(slot)) return;
    --size_;
    ++operations_;
    heap_.decrease(handles_[slot], parked(slot));  // lower in priority, later in time
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
  double time(Slot slot) const { return (*handles_[slot]).time; }
  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }
  std::size_t slots() const { return handles_.size(); }
  std::uint64_t operations() const { return operations_; }

 private:
  using Key = detail::QueueKey<Rank>;
  using Heap = boost::heap::d_ary_heap<Key, boost::heap::arity<Arity>, boost::heap::mutable_<true>,
                                       boost::heap::compare<detail::LaterKey<Key>>>;

  static Key parked(Slot slot) { return Key::without_event(slot); }

  Heap heap_;
  std::vector<typename Heap::handle_type> handles_;  // by slot
  std::size_t size_ = 0;
  std::uint64_t operations_ = 0;
  [[no_unique_address]] Rank rank_;
};

static_assert(EventQueue<DaryQueue<>>);

}  // namespace kds
