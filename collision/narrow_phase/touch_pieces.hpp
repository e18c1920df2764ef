// When a shape on a path touches another, from convex pieces of the space of their relative positions.
#pragma once

#include "collision/narrow_phase/convex_touch.hpp"
#include "collision/narrow_phase/curve_spans.hpp"
#include "collision/narrow_phase/time_spans.hpp"

#include <boost/container/static_vector.hpp>

#include <algorithm>
#include <cstddef>
#include <span>

namespace kds::collision {

/// The positions in which two shapes touch as a union of convex pieces, each given by the times at which each of its
/// conditions holds. The shapes touch while all conditions of some piece hold.
template <int Degree, std::size_t MostPieces, std::size_t MostConditions>
class TouchPieces {
 public:
  /// Conditions that hold together: when each of them does.
  struct Piece {
    boost::container::static_vector<SpansOf<Degree>, MostConditions> conditions;

    std::span<const SpansOf<Degree>> spans() const { return {conditions.data(), conditions.size()}; }
    bool contains(double tau) const { return first_inside_all(spans(), tau) == tau; }
  };

  void add(const Piece& piece) { pieces_.push_back(piece); }

  /// The first time from tau on at which they touch, or infinity.
  double first_inside(double tau) const {
    double first = TimeSpans::infinity;
    for (const Piece& piece : pieces_) first = std::min(first, first_inside_all(piece.spans(), tau));
    return first;
  }

  /// The time since which they have touched at tau: back through overlapping pieces as far as they go.
  double enter(double tau) const {
    double begin = TimeSpans::infinity;
    for (const Piece& piece : pieces_) {
      if (piece.contains(tau)) begin = std::min(begin, enter_all(piece.spans(), tau));
    }
    return begin;
  }

  /// The time until which they touch: the end of one piece may lie in another.
  double leave(double tau) const {
    for (bool moved = true; moved;) {
      moved = false;
      for (const Piece& piece : pieces_) {
        if (tau == TimeSpans::infinity) return tau;
        if (!piece.contains(tau)) continue;
        tau = leave_all(piece.spans(), tau);
        moved = true;
      }
    }
    return tau;
  }

 private:
  boost::container::static_vector<Piece, MostPieces> pieces_;
};

}  // namespace kds::collision
