// Kinetic tournament: the greatest of moving values.
#pragma once

#include "certificates/order.hpp"
#include "kds/audit.hpp"
#include "kds/events/schedule.hpp"
#include "kds/framework/measures.hpp"
#include "kds/motion.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::structures {

/// Maintains the greatest of moving values, as the winner of a binary tournament.
///
/// Each match has one certificate, "the loser is not greater than the winner"; when it fails the match is replayed and
/// so are those above it, up to the first that the old winner had not won. Paper: [Basch99] section 3.2.
///
/// Cost: O(log n) certificates an event or a change; an element plays in at most log2 n matches (local), n - 1
/// certificates in all (compact). Depth and memory are those of the greatest id that there has been, so ids should be
/// small; an insertion for which the tree must grow (to twice the size or more) plays all matches.
///
/// It owns its values and is not made of a rule: made of one, an event takes 33 % more instructions on lines and 18 %
/// more on parabolas (256 values; the same events), since slots are marked and their certificates made one by one.
///
/// Ties: among values that stay equal the one with the lower id wins.
///
/// `now` is always the clock, in seconds: finite, and not before the last change or event. That is not checked.
template <int Degree, EventQueue Queue = DefaultEventQueue, FailureTimeSolver Solver = CertifiedSolver>
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

  /// The matches are the inner nodes of a complete binary tree: the final is node 1, and those who meet in node i come
  /// from 2 i and 2 i + 1. Leaves are elements. Nodes are below this number, half of them leaves.
  std::size_t end_node() const { return 2 * capacity_; }
  /// Who has won a match, or the element of a leaf: `nobody`, the greatest id there is, if no element is below the
  /// node. Precondition: 0 < node < end_node().
  Id winner_of(std::size_t node) const {
    if (node < capacity_) return winner_[node];
    const auto id = static_cast<Id>(node - capacity_);
    return entrants_[id] ? id : nobody;
  }

  /// Precondition: contains(id). The reference holds until the next insertion.
  const Motion<Degree>& motion(Id id) const { return *entrants_[id]; }

  // Changes throw std::invalid_argument for an id that is used or reserved (the greatest) and for a motion that is not
  // finite, std::out_of_range for an id that is not there, and then change nothing.
  void insert(Id id, Motion<Degree> motion, double now) {
    if (id == nobody) throw std::invalid_argument("Tournament: id " + std::to_string(id) + " is reserved");
    if (contains(id)) throw std::invalid_argument("Tournament: id " + std::to_string(id) + " is used twice");
    require_finite(id, motion);
    if (id >= capacity_) grow(id, now);
    entrants_[id] = motion;
    ++size_;
    replay_from(id, now);
    measures_.most_held = std::max<std::uint64_t>(measures_.most_held, held());
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

  /// Time of the next event within the horizon, `never` if there is none.
  double next_time() const { return schedule_.next_time(); }

  /// Processes the event due at next_time(). Precondition: there is one.
  void process() {
    const auto [time, slot] = schedule_.next();
    if (!schedule_.failed(slot, match(slot), time)) return;
    const Id before = winner_[1];
    std::uint64_t touched = 0;
    bool changed = true;
    for (std::size_t node = slot; changed && node >= 1; node /= 2) {
      changed = decide(node, time);
      if (!is_played(node)) continue;
      ++touched;
      if (node == slot && changed) {  // Winner and loser have changed places, since their certificate has failed.
        schedule_.certify_turned(slot, match(node), time);
      } else {
        schedule_.certify(static_cast<Slot>(node), match(node), time);
      }
    }
    measures_.external += winner_[1] != before;
    measures_.touched += touched;
    measures_.most_touched = std::max(measures_.most_touched, touched);
  }

  /// See KineticStructure. O(n) failure times.
  void extend_horizon(double now, double horizon) {
    if (horizon == schedule_.horizon()) return;
    schedule_.set_horizon(horizon);
    for (std::size_t node = 1; node < capacity_; ++node) certify(node, now);
  }

  /// Turns the motions round and plays all matches in time that runs backwards: see reverse() in
  /// kds/framework/reverse.hpp.
  void turn_round(double now, double horizon) {
    for (auto& entrant : entrants_) {
      if (entrant) entrant = reversed(*entrant);
    }
    schedule_.set_horizon(horizon);
    for (std::size_t node = capacity_; node-- > 1;) play(node, now);
  }

  /// Checks winners and failure times against the motions, exactly. Throws AuditFailure.
  void audit(double now) const;

  const Counters& counters() const { return schedule_.counters(); }

  /// An event is external if the greatest changes. Certificates an event and an element: log2 n at most.
  Measures measures() const;

  /// Saves or loads the whole state of the tournament. See save() in snapshot.hpp.
  template <class Archive>
  void archive(Archive& archive) {
    archive.tag("Tournament of degree " + std::to_string(Degree));
    archive(entrants_, winner_, schedule_, capacity_, size_, measures_);
    if constexpr (Archive::loading) check(archive);
  }

 private:
  /// Checks what has been loaded.
  template <class Archive>
  void check(const Archive& archive) const {
    archive.require(capacity_ == 0 || (capacity_ >= 2 && std::has_single_bit(capacity_)),
                    "the size of a tournament is no power of two");
    const bool sizes = entrants_.size() == capacity_ && winner_.size() == capacity_;
    archive.require(sizes && schedule_.queue().slots() == capacity_, "a tournament has not one match for each place");
    std::size_t found = 0;
    for (const auto& entrant : entrants_) {
      found += entrant.has_value();
      archive.require(!entrant || is_finite(*entrant), "the motion of an entrant is not finite");
    }
    archive.require(found == size_, "a tournament has not as many entrants as it says");
    for (std::size_t node = capacity_; node-- > 1;) {  // the matches below come before
      const Id left = winner_of(2 * node);
      const Id right = winner_of(2 * node + 1);
      const bool played = winner_[node] == left || winner_[node] == right;
      archive.require(played && (winner_[node] != nobody || left == right), "the winner of a match did not play");
      archive.require(is_played(node) || !schedule_.contains(static_cast<Slot>(node)), "there is an event of no match");
    }
    archive.require(capacity_ == 0 || !schedule_.contains(0), "there is an event of no match");
  }

  static constexpr Id nobody = std::numeric_limits<Id>::max();

  Id loser_of(std::size_t node) const {
    const Id left = winner_of(2 * node);
    return winner_[node] == left ? winner_of(2 * node + 1) : left;
  }

  /// Returns whether the winner has changed.
  bool play(std::size_t node, double now) {
    const bool changed = decide(node, now);
    certify(node, now);
    return changed;
  }

  bool decide(std::size_t node, double now) {
    const Id before = winner_[node];
    const Id left = winner_of(2 * node);
    const Id right = winner_of(2 * node + 1);
    if (left == nobody || right == nobody) {
      winner_[node] = left == nobody ? right : left;
    } else {
      winner_[node] =
          sign_after(certificates::Order<Degree>{*entrants_[right], *entrants_[left]}, now) >= 0 ? left : right;
    }
    return winner_[node] != before;
  }

  std::size_t held() const { return size_ == 0 ? 0 : size_ - 1; }

  /// Whether two entrants meet at the node.
  bool is_played(std::size_t node) const { return winner_of(2 * node) != nobody && winner_of(2 * node + 1) != nobody; }

  /// "The loser is not greater than the winner." Precondition: is_played(node).
  certificates::Order<Degree> match(std::size_t node) const {
    return {*entrants_[loser_of(node)], *entrants_[winner_[node]]};
  }

  void certify(std::size_t node, double now) {
    const auto slot = static_cast<Slot>(node);
    if (!is_played(node)) return schedule_.clear(slot);
    schedule_.certify(slot, match(node), now);
  }

  void replay_from(Id id, double now) {
    for (std::size_t node = (capacity_ + id) / 2; node >= 1; node /= 2) play(node, now);
  }

  void grow(Id id, double now) {
    if (capacity_ == 0) capacity_ = 2;
    while (capacity_ <= id) capacity_ *= 2;
    entrants_.resize(capacity_);
    winner_.assign(capacity_, nobody);
    schedule_.resize(capacity_);
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
  Schedule<Queue, Solver> schedule_;
  Measures measures_;  // those that do not follow from size and counters
  std::size_t capacity_ = 0;
  std::size_t size_ = 0;
};

template <int Degree, EventQueue Queue, FailureTimeSolver Solver>
Measures Tournament<Degree, Queue, Solver>::measures() const {
  Measures result = measures_;
  result.events = counters().events;
  result.held = held();
  for (Id id = 0; id < capacity_; ++id) {
    if (!contains(id)) continue;
    // It is in the matches on its way up, as long as it wins, and in the one that it loses.
    std::uint64_t matches = 0;
    for (std::size_t node = (capacity_ + id) / 2; node >= 1; node /= 2) {
      matches += is_played(node);
      if (winner_[node] != id) break;
    }
    result.most_per_element = std::max(result.most_per_element, matches);
  }
  return result;
}

template <int Degree, EventQueue Queue, FailureTimeSolver Solver>
void Tournament<Degree, Queue, Solver>::audit(double now) const {
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
      t = failure_time(match(node), now, schedule_.horizon());
      if (t <= now && !(schedule_.contains(slot) && schedule_.time(slot) <= now)) fail(node, "the loser is greater");
    }
    if constexpr (!Solver::certified) continue;  // Its times may be wrong.
    if (schedule_.contains(slot) != (t != never)) fail(node, "an event is missing or without cause");
    if (schedule_.contains(slot) && schedule_.time(slot) != t) fail(node, "the scheduled event has the wrong time");
  }
}

}  // namespace kds::structures
