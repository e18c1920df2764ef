// Kinetic tournament: the greatest of moving values.
#pragma once

#include "certificates/order.hpp"
#include "kds/audit.hpp"
#include "kds/default_event_queue.hpp"
#include "kds/failure_time.hpp"
#include "kds/motion.hpp"
#include "kds/statistics.hpp"

#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::structures {

/// Keeps the greatest of moving values, as the winner of a binary tournament.
///
/// Each match holds one certificate, "the loser is not greater than the winner"; when it fails the match is replayed
/// and so are those above it that the old winner had won. Paper: [Basch99] section 3.2.
///
/// Cost: O(log n) certificates an event or a change; an element plays in at most log2 n matches (local), n - 1
/// certificates in all (compact).
///
/// Ties: among values that are equal for good the one of the lower slot wins.
template <int Degree, EventQueue Queue = DefaultEventQueue>
class Tournament {
 public:
  using Id = std::uint32_t;

  std::size_t size() const { return size_; }
  bool contains(Id id) const { return id < capacity_ && entrants_[id].has_value(); }

  /// Id of the greatest value at t+, none if there are no values.
  std::optional<Id> winner() const {
    if (size_ == 0) return std::nullopt;
    return winner_[1];
  }

  const Motion<Degree>& motion(Id id) const { return *entrants_[id]; }

  void insert(Id id, const Motion<Degree>& motion, double now) {
    if (id == nobody) throw std::invalid_argument("Tournament: id " + std::to_string(id) + " is reserved");
    if (contains(id)) throw std::invalid_argument("Tournament: id " + std::to_string(id) + " is used twice");
    require_finite(id, motion);
    if (id >= capacity_) grow(id, now);
    entrants_[id] = motion;
    ++size_;
    replay_from(id, now);
  }

  void remove(Id id, double now) {
    require(id);
    entrants_[id].reset();
    --size_;
    replay_from(id, now);
  }

  void update(Id id, const Motion<Degree>& motion, double now) {
    require(id);
    require_finite(id, motion);
    entrants_[id] = motion;
    replay_from(id, now);
  }

  double next_time() const { return queue_.empty() ? never : queue_.top().time; }

  void process() {
    const auto [time, match] = queue_.top();
    ++counters_.events;
    for (std::size_t node = match; node >= 1; node /= 2) play(node, time);
  }

  void extend_horizon(double now, double horizon) {
    horizon_ = horizon;
    for (std::size_t node = 1; node < capacity_; ++node) certify(node, now);
  }

  void audit(double now) const;

  const Counters& counters() const { return counters_; }

 private:
  static constexpr Id nobody = std::numeric_limits<Id>::max();

  // A complete binary tree in heap order: matches 1 .. capacity - 1, entrant i at capacity + i.
  Id winner_of(std::size_t node) const {
    if (node < capacity_) return winner_[node];
    const auto id = static_cast<Id>(node - capacity_);
    return entrants_[id] ? id : nobody;
  }

  Id loser_of(std::size_t node) const {
    const Id left = winner_of(2 * node);
    return winner_[node] == left ? winner_of(2 * node + 1) : left;
  }

  void play(std::size_t node, double now) {
    const Id left = winner_of(2 * node);
    const Id right = winner_of(2 * node + 1);
    if (left == nobody || right == nobody) {
      winner_[node] = left == nobody ? right : left;
    } else {
      winner_[node] =
          sign_after(certificates::Order<Degree>{*entrants_[right], *entrants_[left]}, now) >= 0 ? left : right;
    }
    certify(node, now);
  }

  void certify(std::size_t node, double now) {
    const Id loser = loser_of(node);
    const auto slot = static_cast<std::uint32_t>(node);
    if (winner_[node] == nobody || loser == nobody) return queue_.clear(slot);
    ++counters_.certificates;
    const double t =
        failure_time(certificates::Order<Degree>{*entrants_[loser], *entrants_[winner_[node]]}, now, horizon_);
    if (t != never) {
      queue_.set(slot, t);
    } else {
      queue_.clear(slot);
    }
  }

  void replay_from(Id id, double now) {
    for (std::size_t node = (capacity_ + id) / 2; node >= 1; node /= 2) play(node, now);
  }

  void grow(Id id, double now) {
    if (capacity_ == 0) capacity_ = 2;
    while (capacity_ <= id) capacity_ *= 2;
    entrants_.resize(capacity_);
    winner_.assign(capacity_, nobody);
    queue_.resize(capacity_);
    for (std::size_t node = capacity_ - 1; node >= 1; --node) play(node, now);
  }

  void require(Id id) const {
    if (!contains(id)) throw std::out_of_range("Tournament: no element with id " + std::to_string(id));
  }

  static void require_finite(Id id, const Motion<Degree>& motion) {
    if (!is_finite(motion)) {
      throw std::invalid_argument("Tournament: the motion of id " + std::to_string(id) + " is not finite");
    }
  }

  std::vector<std::optional<Motion<Degree>>> entrants_;
  std::vector<Id> winner_;
  Queue queue_;
  Counters counters_;
  std::size_t capacity_ = 0;
  std::size_t size_ = 0;
  double horizon_ = never;
};

template <int Degree, EventQueue Queue>
void Tournament<Degree, Queue>::audit(double now) const {
  const auto fail = [](std::size_t node, const char* what) {
    throw AuditFailure("Tournament: match " + std::to_string(node) + ": " + what);
  };
  for (std::size_t node = 1; node < capacity_; ++node) {
    const Id left = winner_of(2 * node);
    const Id right = winner_of(2 * node + 1);
    const auto slot = static_cast<std::uint32_t>(node);
    double t = never;
    if (left == nobody || right == nobody) {
      if (winner_[node] != (left == nobody ? right : left)) fail(node, "the only entrant has not won");
    } else {
      if (winner_[node] != left && winner_[node] != right) fail(node, "the winner did not play");
      const certificates::Order<Degree> match{*entrants_[loser_of(node)], *entrants_[winner_[node]]};
      t = failure_time(match, now, horizon_);
      if (t <= now && !(queue_.contains(slot) && queue_.time(slot) <= now)) fail(node, "the loser is greater");
    }
    if (queue_.contains(slot) != (t != never)) fail(node, "an event is missing or without cause");
    if (queue_.contains(slot) && queue_.time(slot) != t) fail(node, "the scheduled event has the wrong time");
  }
}

}  // namespace kds::structures
