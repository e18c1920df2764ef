// The walk over pairs of nodes of two surfaces, and the tests of the features in their leaves.
#pragma once

#include "collision/deforming/surface_pair.hpp"

#include <algorithm>
#include <compare>
#include <functional>
#include <queue>
#include <vector>

namespace kds::collision {

/// When two surfaces, or one and itself, touch. See surface_contact.hpp for laws and method.
template <int Degree>
class SurfaceSearch : private SurfacePair<Degree> {
 public:
  using typename SurfacePair<Degree>::Surface;

  SurfaceSearch(const Surface& a, const Surface& b, const SurfaceQuery& query)
      : SurfacePair<Degree>(a, b, query, false) {}
  SurfaceSearch(const Surface& surface, const SurfaceQuery& query)
      : SurfacePair<Degree>(surface, surface, query, true) {}

  /// Calls found(contact) for contacts of features, pairs of leaves in the order in which their boxes may begin to
  /// overlap, until that is later than the time that it last returned.
  template <class Found>
  void earliest_first(const Found& found) const;

  /// Calls found(contact) for each pair of features that touch, and each overlap at the start.
  template <class Found>
  void all(const Found& found) const;

 private:
  using typename SurfacePair<Degree>::Kind;
  using typename SurfacePair<Degree>::NodePair;
  struct Waiting {
    double begin;
    NodePair nodes;
    friend auto operator<=>(const Waiting&, const Waiting&) = default;
  };

  /// Calls found(contact) for the pairs of features of two leaves.
  template <class Found>
  void test(NodePair leaves, bool at_start, const Found& found) const;

  using SurfacePair<Degree>::a_;
  using SurfacePair<Degree>::b_;
  using SurfacePair<Degree>::query_;
  using SurfacePair<Degree>::span_;
  using SurfacePair<Degree>::box_reach_;
};

// ---------------------------------------------------------------------------------------------------------------------

template <int Degree>
template <class Found>
void SurfaceSearch<Degree>::earliest_first(const Found& found) const {
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> queue;
  double last = span_.end;  // no contact after this is of interest
  const auto report = [&](const SurfaceContact& contact) {
    const double t = found(contact);
    last = std::min(last, std::max(a_.part(t) * (1 + 0x1p-50), span_.begin));
  };
  const auto wait = [&](NodePair n) {
    OverlapSpan span = span_;
    if (this->overlap(n, span, box_reach_) && span.begin <= last) queue.push({span.begin, n});
  };
  wait({0, 0});
  if (query_.overlaps && !queue.empty() && queue.top().begin == span_.begin) {
    if (const auto inside = this->inside(query_.from)) report(*inside);
  }
  while (!queue.empty()) {
    const Waiting next = queue.top();
    if (next.begin > last) return;
    queue.pop();
    if (this->are_leaves(next.nodes)) {
      test(next.nodes, next.begin == span_.begin, report);
    } else {
      this->split(next.nodes, wait);
    }
  }
}

template <int Degree>
template <class Found>
void SurfaceSearch<Degree>::all(const Found& found) const {
  std::vector<NodePair> stack{{0, 0}};
  OverlapSpan whole = span_;
  if (query_.overlaps && this->overlap({0, 0}, whole, box_reach_) && whole.begin == span_.begin) {
    if (const auto inside = this->inside(query_.from)) found(*inside);
  }
  while (!stack.empty()) {
    const NodePair n = stack.back();
    stack.pop_back();
    OverlapSpan span = span_;
    if (!this->overlap(n, span, box_reach_)) continue;
    if (this->are_leaves(n)) {
      test(n, span.begin == span_.begin, found);
    } else {
      this->split(n, [&](NodePair half) { stack.push_back(half); });
    }
  }
}

template <int Degree>
template <class Found>
void SurfaceSearch<Degree>::test(NodePair leaves, bool at_start, const Found& found) const {
  this->for_features(leaves, [&](Kind kind, const std::array<std::uint32_t, 4>& vertices, std::uint32_t face) {
    const auto control = this->control_points(kind, vertices, this->count_of_first(kind));
    const auto touch =
        kind == Kind::edge_edge
            ? certificates::edge_edge_contact<Degree>(control, a_.begin(), a_.end(), query_.from, this->tolerance_)
            : certificates::vertex_face_contact<Degree>(control, a_.begin(), a_.end(), query_.from, this->tolerance_);
    if (touch && touch.time <= query_.until) found(this->described(kind, vertices, face, touch));
  });
  if (!at_start || !query_.overlaps) return;
  this->for_edges_and_faces(leaves, [&](Kind kind, const std::array<std::uint32_t, 5>& vertices, std::uint32_t face) {
    if (const auto crossing = this->crossing(kind, vertices, face, query_.from)) found(*crossing);
  });
}

}  // namespace kds::collision
