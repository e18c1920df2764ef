// Whether and how long surfaces touch or go through each other, at a time and from then on.
#pragma once

#include "certificates/features/closest_point.hpp"
#include "certificates/features/fixed_axis.hpp"
#include "certificates/features/positive_stretch.hpp"
#include "collision/deforming/surface_pair.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

namespace kds::collision {

/// The other side of SurfaceSearch: it proves that surfaces are apart until they may touch, this one that they touch
/// until they may be apart.
///
/// Two surfaces touch at a time if two features are no farther apart than their radii and the tolerance, if an edge
/// goes through a face, or if a vertex lies inside a solid. Proofs that it stays so: of two features that are near, the
/// points that are closest now stay within twice the tolerance (a polynomial of the time); an edge that goes through a
/// face does so while five volumes keep their signs.
template <int Degree>
class SurfaceTouching : private SurfacePair<Degree> {
 public:
  using typename SurfacePair<Degree>::Surface;

  SurfaceTouching(const Surface& a, const Surface& b, const SurfaceQuery& query)
      : SurfacePair<Degree>(a, b, query, false) {}
  /// Of a surface with itself.
  SurfaceTouching(const Surface& surface, const SurfaceQuery& query)
      : SurfacePair<Degree>(surface, surface, query, true) {}

  bool touches(double t) const { return holds_until(a_.part(t), a_.part(t)) >= 0; }

  /// A time from t on at which they do not touch, or infinity if they do until the end of the stretch. Precondition:
  /// they touch at t.
  ///
  /// Each proof leads to where another is looked for. Where they hardly last (surfaces that slide on each other in one
  /// plane) the next place is farther and farther away, up to 2^-10 of the stretch: while they do so a gap that is
  /// shorter than that may be passed over.
  double parts_at(double t) const;

  /// The features that approach fastest at t, or part most slowly, of those within the tolerance; if there are none,
  /// the closest of those within `distance` beyond the radii; or else ones that go through each other. Of features that
  /// move alike the closest come first.
  std::optional<SurfaceContact> closest(double t, double distance) const;

 private:
  using typename SurfacePair<Degree>::Kind;
  using typename SurfacePair<Degree>::NodePair;
  using Point = std::array<Polynomial<Degree>, 3>;

  /// Where the longest proof that they touch at s ends, of some; s if there is none that lasts, -1 if they do not
  /// touch. Content with one until `enough`.
  double holds_until(double s, double enough) const;

  template <class Visit>
  void for_leaves_near(double s, double distance, const Visit& visit) const;

  /// The path of a vertex, less that of a place.
  static Point path(const Surface& surface, std::uint32_t v, const Eigen::Vector3d& origin);
  template <certificates::Patch patch>
  double near_until(Kind kind, const std::array<std::uint32_t, 4>& vertices, double s) const;
  double through_until(Kind kind, const std::array<std::uint32_t, 5>& vertices, double s) const;
  /// From how far features of a pair of this size count as touching.
  double level(double size) const { return tolerance_.thickness + this->band(size); }

  using SurfacePair<Degree>::a_;
  using SurfacePair<Degree>::b_;
  using SurfacePair<Degree>::tolerance_;
};

// ---------------------------------------------------------------------------------------------------------------------

template <int Degree>
template <class Visit>
void SurfaceTouching<Degree>::for_leaves_near(double s, double distance, const Visit& visit) const {
  std::vector<NodePair> stack{{0, 0}};
  while (!stack.empty()) {
    const NodePair n = stack.back();
    stack.pop_back();
    OverlapSpan span{s, s};
    if (!this->overlap(n, span, distance)) continue;
    if (this->are_leaves(n)) {
      if (visit(n)) return;
    } else {
      this->split(n, [&](NodePair half) { stack.push_back(half); });
    }
  }
}

template <int Degree>
double SurfaceTouching<Degree>::holds_until(double s, double enough) const {
  double until = -1;
  const double distance = level(0x1p10 * tolerance_.absolute) * (1 + 0x1p-40);
  for_leaves_near(s, distance, [&](NodePair leaves) {
    this->for_edges_and_faces(leaves, [&](Kind kind, const std::array<std::uint32_t, 5>& vertices, std::uint32_t) {
      if (until <= enough || until < 0) until = std::max(until, through_until(kind, vertices, s));
    });
    this->for_features(leaves, [&](Kind kind, const std::array<std::uint32_t, 4>& vertices, std::uint32_t) {
      if (until > enough) return;
      until =
          std::max(until, kind == Kind::edge_edge ? near_until<certificates::Patch::parallelogram>(kind, vertices, s)
                                                  : near_until<certificates::Patch::triangle>(kind, vertices, s));
    });
    return until > enough;
  });
  if (until < 0 && (a_.solid() || b_.solid())) {
    const double t = a_.begin() + s * (a_.end() - a_.begin());
    if (this->inside(t)) return s;
  }
  return until;
}

template <int Degree>
double SurfaceTouching<Degree>::parts_at(double t) const {
  constexpr double least_step = 0x1p-30, longest_step = 0x1p-10, enough = 0x1p-12;
  double s = a_.part(t);
  double step = least_step;
  while (s < 1) {
    const double until = holds_until(s, s + enough);
    if (until < 0) return std::clamp(a_.begin() + s * (a_.end() - a_.begin()), t, a_.end());
    if (until >= 1) break;
    step = until - s < enough ? std::min(2 * step, longest_step) : least_step;
    s = std::max(until, s + step);
  }
  return std::numeric_limits<double>::infinity();
}

template <int Degree>
typename SurfaceTouching<Degree>::Point SurfaceTouching<Degree>::path(const Surface& surface, std::uint32_t v,
                                                                      const Eigen::Vector3d& origin) {
  Point result;
  for (std::size_t d = 0; d < 3; ++d) {
    const auto at = [&](std::size_t i) {
      return surface.control_points(i)[v][static_cast<Eigen::Index>(d)] - origin[static_cast<Eigen::Index>(d)];
    };
    result[d].c[0] = at(0);
    result[d].c[1] = Degree * (at(1) - at(0));
    if constexpr (Degree == 2) result[d].c[2] = (at(2) - at(1)) - (at(1) - at(0));
  }
  return result;
}

/// -1 where they are not near at s.
template <int Degree>
template <certificates::Patch patch>
double SurfaceTouching<Degree>::near_until(Kind kind, const std::array<std::uint32_t, 4>& vertices, double s) const {
  const auto control = this->control_points(kind, vertices, this->count_of_first(kind));
  const auto paths = certificates::patch_paths<patch, Degree>(control);
  const certificates::PlacedPatch<patch> placed(paths.at(s));
  const auto point = placed.closest();
  const double near = level(paths.size);
  if (!(point.squared_distance <= near * near)) return -1;
  // The points with these weights, beyond the radii by twice the tolerance.
  const auto weights = placed.weights(point);
  const double far = near + (near - tolerance_.thickness);
  Polynomial<2 * Degree> room{};
  room.c[0] = far * far;
  for (std::size_t d = 0; d < 3; ++d) {
    Polynomial<Degree> x;
    for (std::size_t i = 0; i <= Degree; ++i) {
      x.c[i] = 0;
      for (std::size_t k = 0; k < 4; ++k) x.c[i] += weights[k] * paths.c[i][d][k];
    }
    room = room - x * x;
  }
  return certificates::positive_until(room, s, 0);
}

/// -1 where the edge does not go through the face at s.
template <int Degree>
double SurfaceTouching<Degree>::through_until(Kind kind, const std::array<std::uint32_t, 5>& vertices, double s) const {
  const Eigen::Vector3d origin = this->second_of(kind).control_points(0)[vertices[2]];
  std::array<Point, 5> p;
  std::array<Eigen::Vector3d, 5> now;
  for (std::size_t k = 0; k < 5; ++k) {
    p[k] = path(k < 2 ? this->first_of(kind) : this->second_of(kind), vertices[k], origin);
    for (std::size_t d = 0; d < 3; ++d) now[k][static_cast<Eigen::Index>(d)] = p[k][d](s);
  }
  if (!goes_through(now[0], now[1], now[2], now[3], now[4])) return -1;
  const auto minus = [](const Point& x, const Point& y) { return Point{x[0] - y[0], x[1] - y[1], x[2] - y[2]}; };
  double until = 1;
  const auto keep_sign = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    const Point u = minus(p[b], p[a]), v = minus(p[c], p[a]), w = minus(p[d], p[a]);
    const auto volume =
        (u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] + (u[0] * v[1] - u[1] * v[0]) * w[2];
    until = std::min(until, certificates::positive_until(volume(s) < 0 ? -volume : volume, s, 0));
  };
  keep_sign(2, 3, 4, 0), keep_sign(2, 3, 4, 1);
  keep_sign(0, 1, 2, 3), keep_sign(0, 1, 3, 4), keep_sign(0, 1, 4, 2);
  return until;
}

template <int Degree>
std::optional<SurfaceContact> SurfaceTouching<Degree>::closest(double t, double distance) const {
  std::optional<SurfaceContact> best, through;
  std::vector<std::pair<double, SurfaceContact>> within;  // the tolerance, and their rates
  double least_rate = std::numeric_limits<double>::infinity(), noise = 0;
  const auto better = [](const std::optional<SurfaceContact>& old, const SurfaceContact& found) {
    if (!old || found.distance != old->distance) return !old || found.distance < old->distance;
    return std::tie(found.contact.feature_a, found.contact.feature_b) <
           std::tie(old->contact.feature_a, old->contact.feature_b);
  };
  for_leaves_near(a_.part(t), (tolerance_.thickness + distance) * (1 + 0x1p-40), [&](NodePair leaves) {
    this->for_features(leaves, [&](Kind kind, const std::array<std::uint32_t, 4>& vertices, std::uint32_t face) {
      const auto control = this->control_points(kind, vertices, this->count_of_first(kind));
      const auto near = kind == Kind::edge_edge
                            ? this->template nearness<certificates::Patch::parallelogram>(control, t)
                            : this->template nearness<certificates::Patch::triangle>(control, t);
      if (!(near.gap <= distance)) return;
      const SurfaceContact found = this->described(kind, vertices, face, near.touch);
      if (near.gap <= this->band(near.size)) {
        within.emplace_back(near.rate, found);
        least_rate = std::min(least_rate, near.rate);
        noise = std::max(noise, near.noise);
      } else if (better(best, found)) {
        best = found;
      }
    });
    this->for_edges_and_faces(leaves, [&](Kind kind, const std::array<std::uint32_t, 5>& vertices, std::uint32_t face) {
      const auto found = this->crossing(kind, vertices, face, t);
      if (found && better(through, *found)) through = found;
    });
    return false;
  });
  if (!within.empty()) best.reset();
  for (const auto& [rate, found] : within) {
    if (rate <= least_rate + noise && better(best, found)) best = found;
  }
  if (best) return best;
  return through ? through : this->inside(t);
}

}  // namespace kds::collision
