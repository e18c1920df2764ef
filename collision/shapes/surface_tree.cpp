#include "collision/shapes/surface_tree.hpp"

#include "kds/audit.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

namespace kds::collision {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

Edge edge_of(const SurfaceElement& element, std::size_t k) {
  const std::uint32_t a = element.vertices[k];
  const std::uint32_t b = element.vertices[(k + 1) % 3];
  return {std::min(a, b), std::max(a, b)};
}

/// Each vertex and edge goes to the first element that has it.
void share_out(std::vector<SurfaceElement>& elements, std::size_t vertices) {
  std::vector<bool> taken(vertices);
  std::vector<std::pair<Edge, std::uint32_t>> edges;  // and 4 times the element, plus the side
  edges.reserve(3 * elements.size());
  for (std::uint32_t i = 0; i < elements.size(); ++i) {
    SurfaceElement& element = elements[i];
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (!taken[element.vertices[k]]) element.owned_vertices |= static_cast<std::uint8_t>(1U << k);
      taken[element.vertices[k]] = true;
      edges.emplace_back(edge_of(element, k), 4 * i + k);
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i > 0 && edges[i].first == edges[i - 1].first) continue;
    elements[edges[i].second / 4].owned_edges |= static_cast<std::uint8_t>(1U << (edges[i].second % 4));
  }
}

}  // namespace

SurfaceTree::SurfaceTree(std::span<const Eigen::Vector3d> positions, std::span<const Mesh::Triangle> triangles)
    : vertices_(positions.size()) {
  check_vertices(positions);
  check_triangle_indices(positions.size(), triangles);
  elements_.reserve(triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i) elements_.push_back({triangles[i], i, 3, 0, 0});
  share_out(elements_, vertices_);
  build(positions);
}

SurfaceTree::SurfaceTree(std::size_t vertices, SurfaceElement element)
    : vertices_(vertices), elements_{element}, nodes_{{0, true}} {}

SurfaceTree SurfaceTree::point() { return {1, {{0, 0, 0}, 0, 1, 1, 0}}; }
SurfaceTree SurfaceTree::segment() { return {2, {{0, 1, 1}, 0, 2, 3, 1}}; }

void SurfaceTree::join_pairs_of_triangles() {
  for (SurfaceElement& element : elements_) {
    const std::size_t diagonal = element.index % 2 == 0 ? 2 : 0;  // from the last to the first; from that to the second
    const auto [a, b] = edge_of(element, diagonal);
    diagonals_.push_back({a, b});
    element.owned_edges &= static_cast<std::uint8_t>(~(1U << diagonal));
    element.index /= 2;
  }
}

bool SurfaceTree::is_diagonal(std::uint32_t a, std::uint32_t b) const {
  return std::find(diagonals_.begin(), diagonals_.end(), std::array{std::min(a, b), std::max(a, b)}) !=
         diagonals_.end();
}

void SurfaceTree::build(std::span<const Eigen::Vector3d> positions) {
  struct Part {
    std::uint32_t node, begin, end;
  };
  std::vector<Eigen::Vector3d> centres;
  for (const SurfaceElement& e : elements_) {
    centres.push_back((positions[e.vertices[0]] + positions[e.vertices[1]] + positions[e.vertices[2]]) / 3);
  }
  std::vector<std::uint32_t> order(elements_.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  nodes_.resize(1);
  nodes_.reserve(2 * elements_.size());
  std::vector<Part> parts{{0, 0, static_cast<std::uint32_t>(order.size())}};
  while (!parts.empty()) {
    const auto [node, begin, end] = parts.back();
    parts.pop_back();
    if (end - begin == 1) {
      nodes_[node] = {begin, true};
      continue;
    }
    Eigen::Array3d low = centres[order[begin]];
    Eigen::Array3d high = low;
    for (std::uint32_t i = begin; i < end; ++i) {
      low = low.min(centres[order[i]].array());
      high = high.max(centres[order[i]].array());
    }
    int axis = 0;
    (high - low).maxCoeff(&axis);
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end,
                     [&](std::uint32_t i, std::uint32_t j) {
                       return std::pair(centres[i][axis], i) < std::pair(centres[j][axis], j);
                     });
    const auto child = static_cast<std::uint32_t>(nodes_.size());
    nodes_[node] = {child, false};
    nodes_.resize(nodes_.size() + 2);
    parts.push_back({child + 1, middle, end});
    parts.push_back({child, begin, middle});
  }
  // Elements in the order of the leaves, so that the leaves below a node lie side by side.
  std::vector<SurfaceElement> sorted;
  for (const std::uint32_t i : order) sorted.push_back(elements_[i]);
  elements_ = std::move(sorted);
}

void SurfaceTree::audit() const {
  const auto fail = [](const std::string& what) { throw AuditFailure("SurfaceTree: " + what); };
  std::vector<int> leaves(elements_.size());
  std::vector<int> parents(nodes_.size());
  for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
    const auto& [first, is_leaf] = nodes_[i];
    if (is_leaf) {
      if (first >= elements_.size() || ++leaves[first] > 1)
        fail("element " + std::to_string(first) + ": in two leaves");
    } else {
      if (first <= i || first + 1 >= nodes_.size()) fail("node " + std::to_string(i) + ": children before it");
      ++parents[first], ++parents[first + 1];
    }
  }
  if (nodes_.size() != 2 * elements_.size() - 1) fail("the nodes are not as many as a binary tree has");
  for (std::size_t i = 1; i < parents.size(); ++i) {
    if (parents[i] != 1) fail("node " + std::to_string(i) + ": has not one parent");
  }
  std::vector<int> owners(vertices_, 0);
  std::set<Edge> edges;
  for (const SurfaceElement& e : elements_) {
    for (std::size_t k = 0; k < e.corners; ++k) {
      if (e.owned_vertices >> k & 1 && ++owners[e.vertices[k]] > 1) fail("a vertex is owned twice");
      if (e.owned_edges >> k & 1 && !edges.insert(edge_of(e, k)).second) fail("an edge is owned twice");
    }
  }
  for (const SurfaceElement& e : elements_) {
    for (std::size_t k = 0; k < e.corners; ++k) {
      if (owners[e.vertices[k]] != 1) fail("vertex " + std::to_string(e.vertices[k]) + ": is owned by no element");
    }
  }
}

}  // namespace kds::collision
