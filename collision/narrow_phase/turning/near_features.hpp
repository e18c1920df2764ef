// Which faces and edges of two polytopes that turn a plane between the two may touch.
#pragma once

#include "collision/narrow_phase/turning/seen_polytope.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace kds::collision {

/// Features of a polytope, and how far a point of it is below the planes of its faces.
struct NearFeatures {
  /// By its place in structure().edges.
  struct Edge {
    std::uint32_t number;
    double below;  ///< of its two faces the one that the point is less far below
  };
  std::vector<std::uint32_t> faces;
  std::vector<Edge> edges;
};

/// Those of two polytopes whose planes may be between the two. Of pairs of edges only those of which the sum of `below`
/// is no more than `within`.
struct NearFeaturePair {
  std::array<NearFeatures, 2> of;
  double within;

  template <class Visit>
  void every_pair_of_edges(const Visit& visit) const {
    for (const NearFeatures::Edge& u : of[0].edges) {
      for (const NearFeatures::Edge& v : of[1].edges) {
        if (!(u.below + v.below > within)) visit(u.number, v.number);
      }
    }
  }
};

/// A point that is certainly inside of a polytope.
struct PointInside {
  Eigen::Vector3d point;      ///< in the coordinates of the body
  std::vector<double> below;  ///< by faces, how far it is below their planes: positive, known to 2^-46 of the radius

  std::size_t nearest_face() const {
    return static_cast<std::size_t>(std::min_element(below.begin(), below.end()) - below.begin());
  }
};

/// A point inside of a polytope that is as near to one of its points, which is known up to roundings, as is certain.
/// None where the polytope is flat, or its faces are planes only up to roundings.
inline std::optional<PointInside> point_inside(const TurningPolytope& polytope, const Eigen::Vector3d& place) {
  constexpr double rounding = 0x1p-46;     // of the radius; products of normals, and the place, are known to 2^-49
  constexpr double longest_way = 0x1p-10;  // of that to the middle
  const TurningPolytope::Middle& middle = polytope.middle();
  const double certain = rounding * polytope.radius;
  if (!polytope.has_exact_faces() || !(4 * certain < longest_way * middle.below)) return std::nullopt;
  PointInside inside{place + (middle.point - place) * (4 * certain / middle.below), {}};
  const HullStructure& structure = *polytope.structure;
  inside.below.reserve(structure.faces.size());
  for (std::size_t f = 0; f < structure.faces.size(); ++f) {
    const double below = dot(polytope.normals()[f], polytope.points[structure.faces[f][0]] - inside.point);
    if (!(below > certain)) return std::nullopt;
    inside.below.push_back(below);
  }
  return inside;
}

inline NearFeatures all_features(const HullStructure& structure) {
  NearFeatures all;
  for (std::uint32_t f = 0; f < structure.faces.size(); ++f) all.faces.push_back(f);
  for (std::uint32_t e = 0; e < structure.edges.size(); ++e) all.edges.push_back({e, 0});
  return all;
}

/// The faces that a point is no farther below than that, and their edges.
inline NearFeatures features_near(const HullStructure& structure, const PointInside& inside, double within) {
  NearFeatures near;
  for (std::uint32_t f = 0; f < structure.faces.size(); ++f) {
    if (inside.below[f] <= within) near.faces.push_back(f);
  }
  for (std::uint32_t e = 0; e < structure.edges.size(); ++e) {
    const auto& faces = structure.edges[e].faces;
    const double below = std::min(inside.below[faces[0]], inside.below[faces[1]]);
    if (below <= within) near.edges.push_back({e, below});
  }
  return near;
}

/// Whether the faces at some edge are nearly in one plane.
inline bool has_flat_edge(const TurningPolytope& polytope) {
  constexpr double flat = 1 - 0x1p-33;  // 2^-16 rad
  const auto& normals = polytope.normals();
  return std::any_of(polytope.structure->edges.begin(), polytope.structure->edges.end(),
                     [&](const HullEdge& edge) { return dot(normals[edge.faces[0]], normals[edge.faces[1]]) > flat; });
}

}  // namespace kds::collision
