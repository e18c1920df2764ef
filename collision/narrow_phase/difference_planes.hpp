// The planes of the difference of two polytopes that keep their orientations, those that are needed.
#pragma once

#include "certificates/polytope_separation.hpp"
#include "collision/degrees.hpp"
#include "collision/narrow_phase/convex_core.hpp"
#include "collision/narrow_phase/quick_motion.hpp"
#include "collision/narrow_phase/zonotope_cells.hpp"
#include "collision/precise_vector.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kds::collision {

/// The planes of the difference A - B of two convex cores: the place of b, seen from a, is inside of it while it is
/// below all of them.
///
/// They are those of the faces of either, and those that an edge of each span, where they touch the difference. Which
/// do need not be known exactly: a plane that touches it elsewhere, or only nearly should have been one of its faces,
/// changes nothing, since its height is the greatest of all points. So all count that doubles cannot exclude, and edges
/// that are exactly parallel are left out.
///
/// There may be as many as pairs of edges, and few of them are ever near the place of b: those are found (find_more()).
///
/// Method: let x be a point of A, and y one of B where it is, at the same point but for roundings. How far the place of
/// b is below a plane across n is how far x is below the plane across n that touches A, and y above the one across n
/// that touches B. Neither is less than zero, so neither is more than the sum. And x is no farther below the planes
/// that an edge allows than below one of those of its two faces. So one look at all faces tells which faces and edges
/// may make a plane that the place is near. The nearest points of the two (nearest_to_origin()) are such points, if
/// there are any; else the planes that are near where the two would touch, moved along what is between them, are found:
/// they keep the two apart.
template <int Degree>
class DifferencePlanes {
 public:
  using Quick = QuickMotion<Degree>;
  using Along = typename Quick::Along;

  /// A range of numbers of points.
  struct Points {
    std::uint32_t begin, end;
  };
  /// One of them: what spans it, and its gap.
  struct Plane {
    std::array<certificates::DifferenceEdge, 2> edges;
    std::array<Points, 2> farthest;  ///< of a and b: see certificates::DifferencePlane
    Eigen::Vector3d normal;          ///< unit, up to some roundings
    bool known;                      ///< it is that
    Along along;                     ///< normal . (b - a)
    double height;
    std::uint64_t number;  ///< in the order of all planes
  };

  /// Refers to all of these; `places`: the points of a and b, turned and rounded.
  DifferencePlanes(const PlacedShape& a, const ConvexCore& core_a, const PlacedShape& b, const ConvexCore& core_b,
                   const certificates::HullDifference& hulls, const std::array<std::vector<Eigen::Vector3d>, 2>& places,
                   const Quick& motion);

  /// Those that are found.
  std::span<const Plane> found() const { return planes_; }
  std::span<const std::uint32_t> points(const Points& of) const {
    return std::span(points_).subspan(of.begin, of.end - of.begin);
  }

  /// Finds all. Calls note(plane) for each that was not found before until it returns false: then the rest is not.
  template <class Note>
  void find_all(const Note& note);

  /// Finds all that the place of b is not certainly below all the time between two times; if the two bodies are apart
  /// at one of them, perhaps only some that keep them apart. Whether any had not been found.
  bool find_more(double from, double until);
  /// The same, so long after the time from which the motion is known.
  bool find_more_at(double tau) { return find_at(tau, 0, false) == Found::some; }

  /// Of all planes that one which b's place is the farthest beyond, or the least deep below, in doubles, so long after
  /// the time from which the motion is known.
  struct Outmost {
    Eigen::Vector3d normal;
    double height;
  };
  Outmost outmost(double tau);

 private:
  static constexpr std::size_t in_a = 0, in_b = 1;
  struct Body {
    const PlacedShape& shape;
    const ConvexCore& core;
    double sign;  ///< of its points in the difference
  };
  /// An edge as doubles see it: its direction in the difference, and those in its two faces that lead away from it,
  /// which for a segment are left out.
  struct SeenEdge {
    Eigen::Vector3d along = Eigen::Vector3d::Zero();
    std::array<Eigen::Vector3d, 2> inward{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    std::size_t faces = 0;
    bool may_support(const Eigen::Vector3d& n) const;
  };
  /// Points of the two, from their centres, that are as near each other as any, up to roundings.
  struct Nearest {
    std::array<Eigen::Vector3d, 2> point;
    double gap;
  };
  struct Near {
    std::vector<std::uint32_t> faces, edges;
  };

  Eigen::Vector3d place(double tau) const;
  double reach(double tau, double last) const;
  double bend(double tau, double last) const;
  Nearest nearest(const Eigen::Vector3d& place) const;
  SeenEdge seen(std::size_t body, std::uint32_t edge) const;
  Near near(std::size_t body, const Eigen::Vector3d& point, double within) const;
  enum class Found : std::uint8_t { none, some, too_many, apart };
  Found find_at(double tau, double below, bool may_be_too_many);
  bool find_between(double tau, double last, int halvings = 0);

  std::uint64_t faces(std::size_t body) const { return bodies_[body].core.structure().faces.size(); }
  std::uint64_t number(std::uint32_t edge_a, std::uint32_t edge_b, double side) const {
    const std::uint64_t edges_b = bodies_[in_b].core.structure().edges.size();
    return faces(in_a) + faces(in_b) + 2 * (edge_a * edges_b + edge_b) + (side < 0 ? 1 : 0);
  }
  bool is_found(std::uint64_t number) const { return std::binary_search(numbers_.begin(), numbers_.end(), number); }
  bool add_face(std::size_t body, std::uint32_t face);
  bool add_edges(std::uint32_t edge_a, std::uint32_t edge_b, double side, const Eigen::Vector3d& product);
  void add(const std::array<certificates::DifferenceEdge, 2>& edges,
           const std::array<std::optional<std::uint32_t>, 2>& on, const Eigen::Vector3d* across, std::uint64_t number);
  Points farthest_points(std::size_t body, const Eigen::Vector3d& along);

  /// Twice what a plane may be found to be lower or higher by than it is, and still not be certainly closed.
  double margin() const { return 4 * motion_.error(); }

  std::array<Body, 2> bodies_;
  const certificates::HullDifference& hulls_;
  const std::array<std::vector<Eigen::Vector3d>, 2>& places_;
  const Quick& motion_;
  std::array<Along, 3> coordinates_;
  std::vector<std::uint32_t> points_;
  std::vector<Plane> planes_;
  std::vector<std::uint64_t> numbers_;  ///< of the planes that are found, ascending
  bool all_ = false;
};

// ---------------------------------------------------------------------------------------------------------------------

template <int Degree>
template <class Note>
void DifferencePlanes<Degree>::find_all(const Note& note) {
  if (all_) return;
  all_ = true;
  const auto added = [&](bool is_new) { return !is_new || note(planes_.back()); };
  for (const std::size_t body : {in_a, in_b}) {
    for (std::uint32_t f = 0; f < faces(body); ++f) {
      if (!added(add_face(body, f))) return;
    }
  }
  const auto all_edges = [&](std::size_t body) {
    std::vector<SeenEdge> edges(bodies_[body].core.structure().edges.size());
    for (std::uint32_t i = 0; i < edges.size(); ++i) edges[i] = seen(body, i);
    return edges;
  };
  const std::vector<SeenEdge> edges_a = all_edges(in_a), edges_b = all_edges(in_b);
  for (std::uint32_t i = 0; i < edges_a.size(); ++i) {
    for (std::uint32_t j = 0; j < edges_b.size(); ++j) {
      const Eigen::Vector3d product = cross(edges_a[i].along, edges_b[j].along);
      for (const double side : {1.0, -1.0}) {
        const Eigen::Vector3d n = side * product;
        if (!edges_a[i].may_support(n) || !edges_b[j].may_support(n)) continue;
        if (!added(add_edges(i, j, side, product))) return;
      }
    }
  }
}

/// A direction of the difference in double-doubles: the difference of points is exact, the matrix makes some 2^-100.
inline PreciseVector precise_direction(const certificates::HullDifference& hulls,
                                       const certificates::DifferenceEdge& edge) {
  const certificates::TurnedPoints& body = edge.of_b ? hulls.b : hulls.a;
  const PreciseVector way = precise_difference(body.points[edge.to], body.points[edge.from]);
  return body.turn * (edge.of_b ? way * -1.0 : way);
}

/// A vector that was made of others, unit up to some roundings; `known`: it is that. `lengths`: the product of the
/// lengths of what was multiplied, whose cancellation leaves 2^-95 of it.
inline Eigen::Vector3d unit_vector(const PreciseVector& v, double lengths, bool& known) {
  const Eigen::Vector3d rounded = v.rounded();
  known = norm(rounded) >= unknown_normal * lengths;
  return known ? normalized(rounded) : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

#define KDS_DECLARE(degree) extern template class DifferencePlanes<degree>;
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
