#include "collision/shapes/convex_hull.hpp"

#include "collision/vectors.hpp"
#include "kds/number_text.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace kds::collision::detail {

using Eigen::Vector3d;

void ShapeKind<ConvexHull>::place(const ConvexHull& hull, PlacedShape& placed) {
  if (!hull.polytope) throw std::invalid_argument("hull: is missing");
  const Polytope& polytope = *hull.polytope;
  if (const double edge = polytope.surface()->shortest_edge(); !(edge >= shortest_edge)) {
    throw std::invalid_argument("hull: has an edge that is " + number_text(edge) + " long; at least " +
                                power_text(shortest_edge) + " is supported");
  }
  polytope.surface()->extents(placed.rotation, 1, placed.low, placed.high);
  const double radius = polytope.bounding_radius();
  if (!is_signed_permutation(placed.rotation)) grow(placed, rotation_margin * radius);
  placed.bounding_radius = radius * (1 + rotation_margin);
}

std::array<double, 2> ShapeKind<ConvexHull>::extent(const ConvexHull& hull, const PlacedShape& placed,
                                                    const Vector3d& direction) {
  const std::array<double, 2> ends = hull.polytope->surface()->extent(placed.rotation, 1, direction);
  const double margin = rotation_margin * placed.bounding_radius * (norm(direction) * (1 + rotation_margin));
  return {ends[0] - margin, ends[1] + margin};
}

SupportingFeature ShapeKind<ConvexHull>::support(const ConvexHull& hull, const PlacedShape& placed,
                                                 const Vector3d& direction) {
  const HullStructure& structure = hull.polytope->structure();
  const auto place = [&](std::uint32_t i) { return placed_vertex(placed.rotation, 1, hull.polytope->points()[i]); };
  std::uint32_t top = structure.corners.front();
  Vector3d farthest = place(top);
  for (const std::uint32_t i : structure.corners) {
    const Vector3d x = place(i);
    if (dot(direction, x) > dot(direction, farthest)) farthest = x, top = i;
  }
  const auto as_far = [&](std::uint32_t i) {
    const Vector3d way = farthest - place(i);
    return dot(direction, way) <= parallel_sine * norm(way);
  };
  for (std::uint32_t f = 0; f < structure.faces.size(); ++f) {
    const std::vector<std::uint32_t>& face = structure.faces[f];
    if (std::find(face.begin(), face.end(), top) == face.end() || !std::all_of(face.begin(), face.end(), as_far)) {
      continue;
    }
    SupportingFeature support{Feature::face(f), {}};
    for (const std::uint32_t i : face) support.vertices.push_back(place(i));
    return support;
  }
  for (const HullEdge& edge : structure.edges) {
    const auto& [from, to] = edge.ends;
    if ((from == top || to == top) && as_far(from) && as_far(to)) {
      return {Feature::edge(from, to), {place(from), place(to)}};
    }
  }
  return {Feature::vertex(top), {farthest}};
}

}  // namespace kds::collision::detail
