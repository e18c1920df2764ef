// Kinetic sorted list: moving values kept in order. This file has the class and its events; sorted_list_edits.hpp has
// edits, sorted_list_audit.hpp audits, measures and snapshots.
#pragma once

#include "certificates/order.hpp"
#include "kds/arithmetic/strict.hpp"
#include "kds/audit.hpp"
#include "kds/events/place_schedule.hpp"
#include "kds/framework/archived_by.hpp"
#include "kds/framework/measures.hpp"
#include "kds/large_vector.hpp"
#include "kds/motion.hpp"

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::structures {

/// Receives the swaps of a kinetic sorted list, and breaks the ties of values that stay equal. This one ignores swaps.
struct NoSwapListener {
  /// `left` and `right` have just come into this order at time t. The list must not be changed from within this call.
  void swapped(std::uint32_t /*left*/, std::uint32_t /*right*/, double /*t*/) {}

  /// Values that stay equal stand in ascending rank, then in ascending id.
  static std::uint32_t rank(std::uint32_t /*id*/) { return 0; }
};

/// The listener of a sorted list. Law: rank(id) is always the same. With archive(archive) it is saved with the list.
template <class L>
concept SwapListener = requires(L& listener, const L& observed, std::uint32_t id) {
  listener.swapped(id, id, 0.0);
  { observed.rank(id) } -> std::convertible_to<std::uint32_t>;
};

/// Keeps moving values sorted, swap by swap.
///
/// One certificate for each adjacent pair; when it fails, the two swap and up to three pairs are certified again.
/// Paper: [Coming06] sections 4.1-4.3 and Figures 3-5; [Basch99] section 2.
///
/// Elements are known by ids chosen by the caller, small integers used once each. They are stored in list order (motion
/// and id side by side), so a swap touches one or two cache lines; and the event of a pair has the place of its left
/// element for a slot, so that a swap changes three neighbouring slots of a queue made for that (PlaceQueue). Swaps of
/// one time come in the order of the left elements' ids. It is made for the inner loop of kinetic sweep and prune; for
/// another queue or solver, or values that are not a Motion, take a list made of a rule:
/// examples/list_in_forty_lines.hpp.
///
/// Cost: a swap O(1) and three changes of the queue, O(log n) together; a motion change the same plus the swaps that
/// a jump needs; insertion and removal O(n) moves of memory and O(log n) comparisons; `assign` O(n log n). At most one
/// event for each adjacent pair is scheduled: the structure is compact and, with two events for an element, local.
///
/// `now` is always the clock, in seconds: finite, and not before the last change or event. That is not checked.
///
/// All orders are decided by exact signs at t+, so the state between events is exactly that of the motions.
template <int Degree, SwapListener Listener = NoSwapListener>
class SortedList {
 public:
  using Id = std::uint32_t;
  using Element = Motion<Degree>;

  /// A value and its id.
  struct Entry {
    Motion<Degree> motion;
    Id id;

    template <class Archive>
    void archive(Archive& archive) {
      archive(motion, id);
    }
  };

  /// Throws std::runtime_error where arithmetic is not that of kds/arithmetic/strict.hpp.
  explicit SortedList(Listener listener = {}) : listener_(listener) { require_strict_arithmetic("SortedList"); }

  std::size_t size() const { return order_.size(); }
  bool contains(Id id) const { return id < position_.size() && position_[id] != absent; }

  /// Elements in ascending order. The span, and references to motions, hold until the next event or change.
  std::span<const Entry> entries() const { return order_; }

  /// Place of an element in the order, from 0. Precondition: contains(id).
  std::uint32_t position(Id id) const { return position_[id]; }
  /// Precondition: contains(id).
  const Motion<Degree>& motion(Id id) const { return order_[position_[id]].motion; }

  Listener& listener() { return listener_; }

  /// Replaces the content. Swaps are not reported. Throws std::invalid_argument for an id that is used twice or
  /// reserved and for a motion that is not finite, and then changes nothing.
  void assign(std::span<const Entry> entries, double now);

  // Changes throw std::invalid_argument for an id that is used or reserved (the greatest) and for a motion that is not
  // finite, std::out_of_range for an id that is not there, and then change nothing.

  /// Inserts an element; its neighbours are found by binary search. No swap is reported.
  void insert(Id id, const Motion<Degree>& motion, double now);

  /// Removes an element. No swap is reported.
  void remove(Id id, double now);

  /// Changes the motion of an element, continuously or with a jump. The swaps of a jump are reported in turn.
  void update(Id id, const Motion<Degree>& motion, double now);

  /// Time of the next swap, `never` if there is none within the horizon.
  double next_time() const { return schedule_.next_time(); }

  /// Processes the swap due at next_time(). Precondition: there is one.
  void process();

  /// See KineticStructure.
  void extend_horizon(double now, double horizon);

  /// Turns the motions round and certifies them in time that runs backwards: see reverse() in
  /// kds/framework/reverse.hpp.
  void turn_round(double now, double horizon);

  /// Checks order, positions and failure times against the motions, exactly. Throws AuditFailure.
  void audit(double now) const;

  const Counters& counters() const { return schedule_.counters(); }

  /// Every event is external: it changes the order. Three certificates an event at most, two an element.
  Measures measures() const;

  const PlaceQueue& queue() const { return schedule_.queue(); }

  /// Saves or loads the whole state of the list, and its listener if that has archive(). See save() in snapshot.hpp.
  template <class Archive>
  void archive(Archive& archive);

 private:
  static constexpr std::uint32_t absent = std::numeric_limits<std::uint32_t>::max();

  /// Whether a may stand before b at t+.
  bool in_order(const Entry& a, const Entry& b, double t) const {
    const certificates::Order<Degree> order{a.motion, b.motion};
    int s = order.quick_sign(t);
    if (s == 0) s = sign_after(order, t);
    if (s != 0) return s > 0;
    const auto rank_a = listener_.rank(a.id);
    const auto rank_b = listener_.rank(b.id);
    return rank_a != rank_b ? rank_a < rank_b : a.id < b.id;
  }

  certificates::Order<Degree> pair(std::size_t left) const { return {order_[left].motion, order_[left + 1].motion}; }

  /// Certifies the pair whose left element stands at `left`, if there is one.
  void certify(std::size_t left, double now) {
    const auto slot = static_cast<Slot>(left);
    if (left + 1 == order_.size()) return schedule_.clear(slot);
    schedule_.certify(slot, pair(left), now);
    if (now == disturbed_) schedule_tie(slot, now);
  }

  /// Two values that stay equal stand in the wrong order: no certificate fails then. It happens only by changes that
  /// are made before all events of their time have been processed.
  void schedule_tie(Slot left, double now) {
    if (schedule_.contains(left) || in_order(order_[left], order_[left + 1], now)) return;
    schedule_.set(left, now);
  }

  /// Brings the queue up to date (PlaceQueue::settle()). To be called at the end of each change of the schedule.
  void settle() {
    schedule_.settle([this](Slot place) { return order_[place].id; });
    // Fetches the two pairs around it, which will be needed too: in large lists they are not in the nearest cache.
    const std::size_t place = schedule_.queue().candidate();
    if (place + 2 >= order_.size() || place == 0) return;
    __builtin_prefetch(&order_[place - 1]);
    __builtin_prefetch(&order_[place + 2]);
  }

  /// To be called when elements have been added.
  void count_held() { measures_.most_held = std::max<std::uint64_t>(measures_.most_held, pairs()); }

  std::size_t pairs() const { return order_.empty() ? 0 : order_.size() - 1; }

  /// To be called before elements are put in place at a time whose events may not all have been processed: until they
  /// are, the list need not be in order.
  void expect_disorder(double now) {
    if (next_time() <= now) disturbed_ = now;
  }

  void exchange(std::size_t left) {
    std::swap(order_[left], order_[left + 1]);
    position_[order_[left].id] = static_cast<std::uint32_t>(left);
    position_[order_[left + 1].id] = static_cast<std::uint32_t>(left + 1);
  }

  void sort(std::span<const Entry> entries, double now);
  void certify_all(double now);

  void renumber(std::size_t first) {
    for (std::size_t i = first; i < order_.size(); ++i) position_[order_[i].id] = static_cast<std::uint32_t>(i);
  }

  void make_room(Id id) {
    if (id < position_.size()) return;
    position_.resize(std::max<std::size_t>(id + 1, 2 * position_.size()), absent);
  }

  static void require_legal(Id id, const Motion<Degree>& motion) {
    if (id == absent) throw std::invalid_argument("SortedList: id " + std::to_string(id) + " is reserved");
    require_finite(id, motion);
  }

  [[noreturn]] static void refuse_twice(Id id) {
    throw std::invalid_argument("SortedList: id " + std::to_string(id) + " is used twice");
  }

  void require(Id id) const {
    if (!contains(id)) throw std::out_of_range("SortedList: no element with id " + std::to_string(id));
  }

  static void require_finite(Id id, const Motion<Degree>& motion) {
    if (!is_finite(motion)) {
      throw std::invalid_argument("SortedList: the motion of id " + std::to_string(id) + " is not finite");
    }
  }

  LargeVector<Entry> order_;
  LargeVector<std::uint32_t> position_;  // of an id in order_, or `absent`
  PlaceSchedule schedule_;               // slot i: the pair of places i and i + 1
  Listener listener_;
  Measures measures_;          // those that do not follow from pairs and counters: touched, most_touched, most_held
  double disturbed_ = -never;  // the last time at which the list was changed amidst its events
};

// ---------------------------------------------------------------------------------------------------------------

template <int Degree, SwapListener Listener>
void SortedList<Degree, Listener>::process() {
  const auto [time, slot] = schedule_.next();
  const std::size_t left = slot;
  schedule_.failed(slot, pair(left), time);
  exchange(left);
  listener_.swapped(order_[left].id, order_[left + 1].id, time);
  // New certificates: the pair itself, whose sign has just turned, and the two pairs around it.
  const std::uint64_t touched = 1u + (left > 0) + (left + 2 < order_.size());
  if (touched == 3 && time != disturbed_) {
    schedule_.certify_three(slot, pair(left - 1), pair(left), pair(left + 1), time);
  } else {
    if (time == disturbed_) {  // The two may stay equal.
      certify(left, time);
    } else {
      schedule_.certify_turned(slot, pair(left), time);
    }
    if (left > 0) certify(left - 1, time);
    certify(left + 1, time);
  }
  settle();
  measures_.touched += touched;
  measures_.most_touched = std::max(measures_.most_touched, touched);
}

template <int Degree, SwapListener Listener>
void SortedList<Degree, Listener>::extend_horizon(double now, double horizon) {
  if (horizon == schedule_.horizon()) return;
  schedule_.set_horizon(horizon);
  for (std::size_t i = 0; i < order_.size(); ++i) {
    if (schedule_.concerned(static_cast<Slot>(i))) certify(i, now);
  }
  settle();
}

}  // namespace kds::structures

#include "structures/sorted_list_audit.hpp"
#include "structures/sorted_list_edits.hpp"
