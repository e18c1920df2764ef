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

  /// The first contact of two features. `at_start`: they may be near at the beginning.
  template <certificates::Patch patch>
  certificates::FeatureContact first_touch(const certificates::ControlPoints<Degree>& control, bool at_start) const;
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

/// Where features have to approach they count as touching at half of the tolerance already, so that they are apart by
/// as much when they are turned back. Those that are within the tolerance then, and part, are watched at a lower level,
/// half of the gap that they have or less: so they do not sink in, should they turn round before they have left. The
/// levels end where roundings are no longer far below them: there features touch unless they are seen to leave, or to
/// stay as they are.
template <int Degree>
template <certificates::Patch patch>
certificates::FeatureContact SurfaceSearch<Degree>::first_touch(const certificates::ControlPoints<Degree>& control,
                                                                bool at_start) const {
  const auto search = [&](const certificates::ContactTolerance& tolerance) {
    if constexpr (patch == certificates::Patch::parallelogram) {
      return certificates::edge_edge_contact<Degree>(control, a_.begin(), a_.end(), query_.from, tolerance);
    } else {
      return certificates::vertex_face_contact<Degree>(control, a_.begin(), a_.end(), query_.from, tolerance);
    }
  };
  if (!query_.approaching) return search(this->tolerance_);
  const auto near = this->template nearness<patch>(control, query_.from);
  certificates::ContactTolerance tolerance = this->tolerance_;
  double level = 0.5 * this->band(near.size);
  if (at_start && near.gap <= 2 * level) {
    if (near.rate < -near.noise) return near.touch;
    const double lowest = 0x1p-37 * near.size;
    while (level >= lowest && !(2 * level <= 0.5 * near.gap)) level *= 0.25;
    if (!(level >= lowest)) {
      return this->template comes_nearer<patch>(control, near) ? near.touch : certificates::FeatureContact{};
    }
  }
  tolerance.thickness += level;
  tolerance.absolute = level;
  tolerance.relative = 1;
  return search(tolerance);
}

template <int Degree>
template <class Found>
void SurfaceSearch<Degree>::test(NodePair leaves, bool at_start, const Found& found) const {
  this->for_features(leaves, [&](Kind kind, const std::array<std::uint32_t, 4>& vertices, std::uint32_t face) {
    const auto control = this->control_points(kind, vertices, this->count_of_first(kind));
    const auto touch = kind == Kind::edge_edge ? first_touch<certificates::Patch::parallelogram>(control, at_start)
                                               : first_touch<certificates::Patch::triangle>(control, at_start);
    if (touch && touch.time <= query_.until) found(this->described(kind, vertices, face, touch));
  });
  if (!at_start || !query_.overlaps) return;
  this->for_edges_and_faces(leaves, [&](Kind kind, const std::array<std::uint32_t, 5>& vertices, std::uint32_t face) {
    if (const auto crossing = this->crossing(kind, vertices, face, query_.from)) found(*crossing);
  });
}

}  // namespace kds::collision
