// The concept of an event queue: numbered slots, each with at most one time, and the least of them.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace kds {

/// Number of a certificate's place in its structure: adjacent pair i of a list, match i of a tournament...
using Slot = std::uint32_t;

namespace detail {
/// The time of a slot without event: what failure_time() gives for a certificate that never fails.
inline constexpr double no_event = std::numeric_limits<double>::infinity();
}  // namespace detail

/// The entry at the top of a queue.
struct QueuedEvent {
  double time = detail::no_event;
  Slot slot = 0;

  friend bool operator==(const QueuedEvent&, const QueuedEvent&) = default;
};

/// The default rank among events of one time: the slot's own number.
struct SlotRank {
  constexpr std::uint64_t operator()(Slot slot) const noexcept { return slot; }
};

/// The order among events of one time: a function that gives each slot a rank, which is a number or another value that
/// has an order and may be copied like one.
template <class R>
concept QueueRank = std::copyable<R> && std::totally_ordered<std::invoke_result_t<const R&, Slot>> &&
    std::is_trivially_copyable_v<std::invoke_result_t<const R&, Slot>>;

/// Of a slot that has an event the rank never changes: declared by a member `lasts`. A queue may read it whenever it is
/// needed, in place of keeping it.
template <class R>
concept LastingRank = QueueRank<R> && requires {
  requires R::lasts;
};

template <QueueRank R>
using RankOf = std::invoke_result_t<const R&, Slot>;

/// A map from slots to times with access to its least entry.
///
/// Laws, for a queue q that has been given resize(n), with slots s < n:
///  1. Order. Entries are ordered by (time, rank, slot). top() is the least. Since no two are equal, the sequence of
///     tops is a function of the entries alone: every queue gives the same one, bit for bit.
///  2. Map. After set(s, t), contains(s) and time(s) == t, whether s was there before or not; nothing else changes.
///     After clear(s), which may be called for an empty slot too, not contains(s) and time(s) is +infinity.
///  3. set(s, +infinity) is clear(s). Any other time is finite: a NaN or -infinity breaks the precondition (asserted).
///  4. Rank. rank(s) is read by set(s, t) and kept, if it is no LastingRank: a slot whose rank changes takes its place
///     when it is set again, and the queue is in order at all times, also while ranks are being changed.
///  5. No clock. set may give a time before earlier tops; the order holds all the same.
///  6. pop() is clear(top().slot). top() and pop() need a queue that is not empty. Though const, top() may rearrange
///     the queue's memory: threads that share a queue must take turns even to read.
///  7. resize(m) keeps the entries of slots below m and drops the rest; a new queue has no slots.
///  8. operations() counts the calls of set, clear and pop that found or left an entry.
template <class Q>
concept EventQueue = std::movable<Q> && requires(Q q, const Q& c, Slot slot, double time, std::size_t n) {
  q.resize(n);
  q.set(slot, time);
  q.clear(slot);
  q.pop();
  { c.top() } -> std::same_as<QueuedEvent>;
  { c.contains(slot) } -> std::same_as<bool>;
  { c.time(slot) } -> std::same_as<double>;
  { c.empty() } -> std::same_as<bool>;
  { c.size() } -> std::same_as<std::size_t>;
  { c.slots() } -> std::same_as<std::size_t>;
  { c.operations() } -> std::same_as<std::uint64_t>;
};

namespace detail {

/// An entry with its place in the order. The rank is kept only where it is not the slot's own number.
template <class Rank>
struct QueueKey {
  double time;
  RankOf<Rank> rank;
  Slot slot;

  static QueueKey make(double time, Slot slot, const Rank& rank) { return {time, rank(slot), slot}; }
  /// The key of a slot without event, whose rank need not be known yet.
  static QueueKey without_event(Slot slot) { return {no_event, {}, slot}; }

  friend bool operator<(const QueueKey& a, const QueueKey& b) {
    if (a.time != b.time) return a.time < b.time;
    if (a.rank != b.rank) return a.rank < b.rank;
    return a.slot < b.slot;
  }
};

template <>
struct QueueKey<SlotRank> {
  double time;
  Slot slot;

  static QueueKey make(double time, Slot slot, const SlotRank&) { return {time, slot}; }
  static QueueKey without_event(Slot slot) { return {no_event, slot}; }

  friend bool operator<(const QueueKey& a, const QueueKey& b) {
    return a.time != b.time ? a.time < b.time : a.slot < b.slot;
  }
};

/// Boost's heaps have the greatest at the top.
template <class Key>
struct LaterKey {
  bool operator()(const Key& a, const Key& b) const { return b < a; }
};

}  // namespace detail
}  // namespace kds
