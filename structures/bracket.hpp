// A binary tournament: the winner of each match in a complete binary tree.
#pragma once

#include "kds/audit.hpp"
#include "kds/events/event_queue.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace kds::structures {

/// A complete binary tree in heap order: matches 1 .. capacity - 1, entrant i at capacity + i. The winner of match 1
/// has won the tournament. It knows nothing of time: beats(i, j), called with i < j so that ties can go to the lower,
/// says whether entrant i wins against j. played(match) is called for each match that is played again.
class Bracket {
 public:
  using Entrant = std::uint32_t;
  static constexpr Entrant nobody = std::numeric_limits<Entrant>::max();

  bool contains(Entrant entrant) const { return entrant < entrants_.size() && entrants_[entrant] != nobody; }
  /// How many entrants there are.
  std::size_t size() const { return size_; }
  /// Entrants are below this; matches are from 1 to below this.
  std::size_t capacity() const { return entrants_.size(); }
  Entrant winner() const { return capacity() == 0 ? nobody : winners_[1]; }
  Entrant winner(std::size_t match) const {
    return match < capacity() ? winners_[match] : entrants_[match - capacity()];
  }
  /// Precondition: two_play(match).
  Entrant loser(std::size_t match) const {
    const Entrant left = winner(2 * match);
    return winner(match) == left ? winner(2 * match + 1) : left;
  }
  bool two_play(std::size_t match) const {
    return match >= 1 && match < capacity() && winner(2 * match) != nobody && winner(2 * match + 1) != nobody;
  }

  /// Makes room for entrants below n, and plays all matches if the tree has to grow.
  template <class Beats, class Played>
  void reserve(std::size_t n, const Beats& beats, const Played& played) {
    if (n <= capacity()) return;
    std::size_t capacity = entrants_.empty() ? 2 : entrants_.size();
    while (capacity < n) capacity *= 2;
    entrants_.resize(capacity, nobody);
    winners_.assign(capacity, nobody);
    for (std::size_t match = capacity - 1; match >= 1; --match) play(match, beats, played);
  }

  /// Lets one entrant in or out, or plays the matches of one that has changed. O(log n). Precondition: below
  /// capacity().
  template <class Beats, class Played>
  void set(Entrant entrant, bool present, const Beats& beats, const Played& played) {
    put(entrant, present);
    climb((capacity() + entrant) / 2, entrant, beats, played);
  }

  /// Plays a match, and those above as long as their winners have changed, or are `changed`.
  template <class Beats, class Played>
  void climb(std::size_t match, Entrant changed, const Beats& beats, const Played& played) {
    for (; match >= 1; match /= 2) {
      const Entrant before = winners_[match];
      play(match, beats, played);
      if (winners_[match] == before && before != changed && before != nobody) return;
    }
  }

  /// Lets several in or out at once, or has them play again: beats() is called only when all are in place. Makes room
  /// if there is none. O(k log n), or O(n) if the tree grows.
  template <class Present, class Beats, class Played>
  void update(const std::vector<Entrant>& entrants, const Present& present, const Beats& beats, const Played& played) {
    if (entrants.empty()) return;
    std::size_t most = 0;
    for (const Entrant entrant : entrants) most = std::max(most, entrant + std::size_t{1});
    const bool grows = most > capacity();
    std::size_t room = std::max<std::size_t>(capacity(), 2);
    while (room < most) room *= 2;
    entrants_.resize(room, nobody);
    for (const Entrant entrant : entrants) put(entrant, present(entrant));
    if (grows) {
      winners_.assign(room, nobody);
      for (std::size_t match = room - 1; match >= 1; --match) play(match, beats, played);
      return;
    }
    // Matches in descending order: each is played after those below it.
    std::vector<std::size_t> matches;
    for (const Entrant entrant : entrants) matches.push_back((room + entrant) / 2);
    std::make_heap(matches.begin(), matches.end());
    std::vector<Entrant> changed = entrants;
    std::sort(changed.begin(), changed.end());
    std::size_t last = 0;
    while (!matches.empty()) {
      std::pop_heap(matches.begin(), matches.end());
      const std::size_t match = matches.back();
      matches.pop_back();
      if (match == last) continue;
      last = match;
      const Entrant before = winners_[match];
      play(match, beats, played);
      const bool another = winners_[match] != before || std::binary_search(changed.begin(), changed.end(), before);
      if (!another || match == 1) continue;
      matches.push_back(match / 2);
      std::push_heap(matches.begin(), matches.end());
    }
  }

  /// Throws AuditFailure unless every winner has played.
  void audit(const std::string& name) const {
    for (std::size_t match = 1; match < capacity(); ++match) {
      const Entrant left = winner(2 * match), right = winner(2 * match + 1), won = winner(match);
      if ((won != left && won != right) || (won == nobody && left != right)) {
        throw AuditFailure(name + ": match " + std::to_string(match) + ": the winner did not play");
      }
    }
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(entrants_, winners_);
    if constexpr (Archive::loading) {
      archive.require(winners_.size() == entrants_.size(), "a bracket has not one match for each place");
      archive.require(entrants_.empty() || std::has_single_bit(entrants_.size()), "a bracket is no power of two");
      for (std::size_t i = 0; i < entrants_.size(); ++i) {
        archive.require(entrants_[i] == i || entrants_[i] == nobody, "an entrant of a bracket is at another place");
      }
      size_ = entrants_.size() - static_cast<std::size_t>(std::count(entrants_.begin(), entrants_.end(), nobody));
      for (std::size_t match = capacity(); match-- > 1;) {
        const Entrant left = winner(2 * match), right = winner(2 * match + 1), won = winner(match);
        archive.require((won == left || won == right) && (won != nobody || left == right),
                        "the winner of a match did not play");
      }
    }
  }

 private:
  void put(Entrant entrant, bool present) {
    size_ += present;
    size_ -= contains(entrant);
    entrants_[entrant] = present ? entrant : nobody;
  }

  template <class Beats, class Played>
  void play(std::size_t match, const Beats& beats, const Played& played) {
    const Entrant left = winner(2 * match);
    const Entrant right = winner(2 * match + 1);
    if (left == nobody || right == nobody) {
      winners_[match] = left == nobody ? right : left;
    } else {
      winners_[match] = beats(left, right) ? left : right;
    }
    played(match);
  }

  std::vector<Entrant> entrants_;  ///< of a number: itself, or nobody
  std::vector<Entrant> winners_;
  std::size_t size_ = 0;
};

}  // namespace kds::structures
