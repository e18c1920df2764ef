// How points are inserted into a kinetic triangulation of the plane, removed and given new motions; and how it is
// built.
#pragma once

#include "structures/plane_triangulation.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace kds::structures {

template <class Path, Criterion What>
void PlaneTriangulationRule<Path, What>::place(Id id, Lawson<Predicates>& lawson) {
  if (near_ >= mesh_.end_triangle() || !mesh_.in_use(near_)) {
    near_ = 0;
    while (!mesh_.in_use(near_)) ++near_;
  }
  same_as_[id] = lawson.insert(id, near_);
  hidden_ += same_as_[id] != nobody;
  near_ = mesh_.from(vertex(id)) / 3;
}

template <class Path, Criterion What>
void PlaneTriangulationRule<Path, What>::insert(Id id, Pen& repair) {
  if (same_as_.size() <= id) same_as_.resize(id + std::size_t{1}, nobody);
  if (flat()) return rebuild(nobody, repair);
  const Predicates is{repair.elements(), repair.now()};
  Lawson<Predicates> lawson(mesh_, is, touched_);
  place(id, lawson);
  certify_touched(repair);
}

/// A motion that leaves the triangles around the vertex as they are: a bounce, say, or a small jump.
template <class Path, Criterion What>
bool PlaneTriangulationRule<Path, What>::keeps(Id id, const Path& next, Pen& repair) {
  if (flat() || hidden_ > 0) return false;
  const Predicates is{repair.elements(), repair.now(), id, &next};
  return Lawson<Predicates>(mesh_, is, touched_).fits(id);
}

template <class Path, Criterion What>
void PlaneTriangulationRule<Path, What>::change(Id id, Pen& repair) {
  const Predicates is{repair.elements(), repair.now()};
  Lawson<Predicates>(mesh_, is, touched_).legalise_around(id);
  certify_touched(repair);
  report_moved(id, repair);
  if (!headings_.go_round_once(mesh_)) rebuild(nobody, repair);
}

template <class Path, Criterion What>
void PlaneTriangulationRule<Path, What>::remove(Id id, Pen& repair) {
  if (same_as_[id] != nobody) {
    same_as_[id] = nobody;
    --hidden_;
    return;
  }
  if (flat()) return;
  const auto heir = hidden_ == 0 ? same_as_.end() : std::find(same_as_.begin(), same_as_.end(), id);
  if (heir != same_as_.end()) {
    const auto next = static_cast<Id>(heir - same_as_.begin());
    mesh_.rename(id, next);
    std::replace(same_as_.begin(), same_as_.end(), id, next);
    same_as_[next] = nobody;
    --hidden_;
    mesh_.for_each_from(next, [&](Edge h) { touched_.push_back(h / 3); });
    return certify_touched(repair);
  }
  const Predicates is{repair.elements(), repair.now()};
  Lawson<Predicates> lawson(mesh_, is, touched_);
  const Edge spoke = mesh_.from(id);
  const Id beside = mesh_.target(spoke) != infinite ? mesh_.target(spoke) : mesh_.apex(spoke);
  if (!lawson.remove(id)) return rebuild(id, repair);
  near_ = mesh_.from(beside) / 3;
  certify_touched(repair);
}

template <class Path, Criterion What>
void PlaneTriangulationRule<Path, What>::rebuild(Id without, Pen& repair) {
  const std::uint32_t before = mesh_.end_triangle();
  rebuilds_ += before != 0;
  mesh_.clear();
  touched_.clear();
  hidden_ = 0;
  same_as_.assign(repair.elements().end_id(), nobody);
  std::vector<Id> ids = repair.elements().ids();
  std::erase(ids, without);
  // In an order that is independent of the points' places, and the same on every machine.
  const auto shuffled = [](Id id) { return (id + 1) * std::uint64_t{0x9e3779b97f4a7c15u} >> 20; };
  std::sort(ids.begin(), ids.end(), [&](Id a, Id b) { return shuffled(a) < shuffled(b); });
  const Predicates is{repair.elements(), repair.now()};
  Lawson<Predicates> lawson(mesh_, is, touched_);
  if (lawson.begin(ids)) {
    for (const Id id : ids) {
      if (!mesh_.contains(id)) place(id, lawson);
    }
  }
  touched_.resize(std::max(before, mesh_.end_triangle()));
  std::iota(touched_.begin(), touched_.end(), 0u);
  report_touched(repair);
  touched_.clear();
  if (!flat()) look_round(is, repair);
  for (Slot slot = 0; slot < 4 * std::max(before, mesh_.end_triangle()); ++slot) repair.certify(slot);
}

/// The edges of triangles that have changed, their areas or headings. At the hull also the areas of their neighbours,
/// which are certified only while they are not at the hull.
template <class Path, Criterion What>
void PlaneTriangulationRule<Path, What>::certify_touched(Pen& repair) {
  const Predicates is{repair.elements(), repair.now()};
  bool at_hull = false;
  for (const std::uint32_t t : touched_) {
    if (!mesh_.in_use(t) || mesh_.finite(t)) continue;
    headings_.find(mesh_, t, is);
    at_hull = true;
  }
  for (const std::uint32_t t : touched_) {
    for (Slot slot = 4 * t; slot < 4 * t + 4; ++slot) repair.certify(slot);
    if (!mesh_.in_use(t)) continue;
    for (Edge h = 3 * t; h < 3 * t + 3; ++h) {
      const Edge twin = mesh_.twin(h);
      repair.certify(twin / 3 * 4 + twin % 3);
      if (at_hull) repair.certify(twin / 3 * 4 + 3);
    }
  }
  report_touched(repair);
  touched_.clear();
}

template <class Path, Criterion What>
void PlaneTriangulationRule<Path, What>::report_touched(Pen& repair) {
  if constexpr (What == Criterion::delaunay) {
    edges_.update(mesh_, touched_, [&](const EdgeChange& change) { repair.report(change); });
  }
  for (const std::uint32_t t : touched_) repair.report(TriangleChange{t});
}

template <class Path, Criterion What>
void PlaneTriangulationRule<Path, What>::report_moved(Id id, Pen& repair) {
  if constexpr (What == Criterion::delaunay) {
    mesh_.for_each_from(id, [&](Edge h) {
      const TriangulationEdges::Number edge = edges_.of(h);
      if (edge == TriangulationEdges::none) return;
      repair.report(EdgeChange{EdgeChange::What::moved, edge, edges_.ends(edge)});
    });
  }
}

}  // namespace kds::structures
