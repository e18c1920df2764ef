// How points are inserted into a kinetic periodic triangulation, removed and given new motions; and how it is built.
#pragma once

#include "structures/periodic_delaunay.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace kds::structures {

template <class Path>
void PeriodicDelaunayRule<Path>::place(Id id, const Predicates& is, Lawson& lawson) {
  if (near_ >= mesh_.end_triangle() || !mesh_.in_use(near_)) {
    near_ = 0;
    while (!mesh_.in_use(near_)) ++near_;
  }
  const Edge near = 3 * near_;
  // The copy of the near vertex that is about the nearest to the point.
  const auto found = lawson.insert(id, near, is.periods_between(mesh_.origin(near), is.x[id]));
  if (found.same) {
    same_as_[id] = found.vertex;
    ++hidden_;
  }
  near_ = mesh_.from(vertex(id)) / 3;
}

template <class Path>
void PeriodicDelaunayRule<Path>::insert(Id id, Pen& repair) {
  if (same_as_.size() <= id) same_as_.resize(id + std::size_t{1}, nowhere);
  if (mesh_.empty()) return rebuild(nobody, repair);
  const Predicates is{repair.elements(), periods_, repair.now()};
  Lawson lawson(mesh_, is, touched_, changed_);
  place(id, is, lawson);
  certify_touched(repair);
}

/// A motion that leaves the triangles around the vertex as they are: a bounce, say, a small jump, or one by whole
/// periods.
template <class Path>
bool PeriodicDelaunayRule<Path>::keeps(Id id, const Path& next, Pen& repair) {
  if (hidden_ > 0) return false;
  jump_ = Predicates{repair.elements(), periods_, repair.now()}.periods_between(id, next);
  const Predicates is{repair.elements(), periods_, repair.now(), id, &next, jump_};
  return Lawson(mesh_, is, touched_, changed_).fits(id);
}

template <class Path>
void PeriodicDelaunayRule<Path>::change(Id id, Pen& repair) {
  mesh_.displace(id, jump_);
  const Predicates is{repair.elements(), periods_, repair.now()};
  Lawson(mesh_, is, touched_, changed_).legalise_around(id);
  certify_touched(repair);
  mesh_.for_each_from(id, [&](Edge h) {
    repair.report(EdgeChange{EdgeChange::What::moved, mesh_.edge(h), ends_[mesh_.edge(h)]});
  });
}

template <class Path>
void PeriodicDelaunayRule<Path>::remove(Id id, Pen& repair) {
  if (hidden(id)) {
    same_as_[id] = nowhere;
    --hidden_;
    return;
  }
  const Predicates is{repair.elements(), periods_, repair.now()};
  Lawson lawson(mesh_, is, touched_, changed_);
  const auto of_id = [id](const VertexCopy& vertex) { return vertex.id == id; };
  const auto heir = hidden_ == 0 ? same_as_.end() : std::find_if(same_as_.begin(), same_as_.end(), of_id);
  if (heir != same_as_.end()) {
    const auto next = static_cast<Id>(heir - same_as_.begin());
    const PeriodOffset at = heir->offset;  // of the vertex where the heir is
    mesh_.displace(id, at);
    mesh_.rename(id, next);
    *heir = nowhere;
    --hidden_;
    for (VertexCopy& other : same_as_) {
      if (of_id(other)) other = {next, other.offset - at};
    }
    lawson.touch(next);
    return certify_touched(repair);
  }
  if (mesh_.size() == 2) return rebuild(id, repair);
  const Edge spoke = mesh_.from(id);
  const Id beside = mesh_.target(spoke);
  if (!lawson.remove(id)) return rebuild(id, repair);
  near_ = mesh_.from(beside) / 3;
  certify_touched(repair);
}

template <class Path>
void PeriodicDelaunayRule<Path>::rebuild(Id without, Pen& repair) {
  const std::uint32_t triangles_before = mesh_.end_triangle();
  rebuilds_ += mesh_.size() > 2;
  mesh_.clear();
  touched_.clear();
  changed_.clear();
  hidden_ = 0;
  same_as_.assign(repair.elements().end_id(), nowhere);
  std::vector<Id> ids = repair.elements().ids();
  std::erase(ids, without);
  // In an order that is independent of the points' places, and the same on every machine.
  const auto shuffled = [](Id id) { return (id + 1) * std::uint64_t{0x9e3779b97f4a7c15u} >> 20; };
  std::sort(ids.begin(), ids.end(), [&](Id a, Id b) { return shuffled(a) < shuffled(b); });
  const Predicates is{repair.elements(), periods_, repair.now()};
  Lawson lawson(mesh_, is, touched_, changed_);
  if (!ids.empty()) mesh_.begin(ids[0]);
  for (std::size_t i = 1; i < ids.size(); ++i) place(ids[i], is, lawson);
  touched_.resize(std::max(triangles_before, mesh_.end_triangle()));
  std::iota(touched_.begin(), touched_.end(), 0u);
  changed_.resize(std::max<std::size_t>(ends_.size(), mesh_.end_edge()));
  std::iota(changed_.begin(), changed_.end(), 0u);
  certify_touched(repair);
}

/// The areas of triangles that have changed, and their edges; and reports them.
template <class Path>
void PeriodicDelaunayRule<Path>::certify_touched(Pen& repair) {
  for (const std::uint32_t t : touched_) {
    repair.certify(area_slot(t));
    repair.report(TriangleChange{t});
    if (t >= mesh_.end_triangle() || !mesh_.in_use(t)) continue;
    for (Edge h = 3 * t; h < 3 * t + 3; ++h) repair.certify(edge_slot(mesh_.edge(h)));
  }
  std::sort(changed_.begin(), changed_.end());
  changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
  ends_.resize(std::max<std::size_t>(ends_.size(), mesh_.end_edge()), no_edge);
  for (const PeriodicMesh::Number edge : changed_) {
    repair.certify(edge_slot(edge));
    if (ends_[edge] != no_edge) repair.report(EdgeChange{EdgeChange::What::went, edge, ends_[edge]});
  }
  for (const PeriodicMesh::Number edge : changed_) {
    ends_[edge] = mesh_.contains_edge(edge) ? edges().ends(edge) : no_edge;
    if (ends_[edge] != no_edge) repair.report(EdgeChange{EdgeChange::What::came, edge, ends_[edge]});
  }
  touched_.clear();
  changed_.clear();
}

}  // namespace kds::structures
