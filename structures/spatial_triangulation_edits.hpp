// How a kinetic triangulation in space is changed: flips and local rebuilds, insertion, removal and new motions; and
// which certificates it needs then.
#pragma once

#include "structures/spatial_triangulation.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace kds::structures {

/// Flips the facet whose certificate has failed; of a tetrahedron that has turned over, a facet of the hull.
template <class Path>
bool SpatialTriangulationRule<Path>::flip(Slot slot, const Predicates& is, Pen& repair) {
  const std::uint32_t t = slot / stride;
  const Slot part = slot % stride;
  Replaced replaced;
  for (Facet f = 4 * t; f < 4 * t + 4; ++f) {
    const bool failed = part == 4 ? mesh_.apex(mesh_.twin(f)) == infinite : f % 4 == part;
    if (!failed || !Mesher(mesh_, is).flip(f, replaced)) continue;
    complete_change(replaced, nobody, is, repair);
    return true;
  }
  return false;
}

/// False if everything has to be built anew.
template <class Path>
bool SpatialTriangulationRule<Path>::build_around(std::vector<std::uint32_t> wrong, Id without, const Predicates& is,
                                                  Pen& repair) {
  const auto hidden = [this](std::uint32_t t, const auto& take) { hidden_.for_each(t, take); };
  const std::optional<Replaced> replaced = LocalRebuild<Predicates>(mesh_, is)(std::move(wrong), without, hidden);
  if (replaced) complete_change(*replaced, without, is, repair);
  return replaced.has_value();
}

/// Makes a vertex of a point, or hides it.
template <class Path>
void SpatialTriangulationRule<Path>::place(Id id, std::uint32_t near, const Predicates& is, Pen& repair) {
  Mesher mesher(mesh_, is);
  const std::uint32_t t = mesher.locate(id, near);
  // In an invalid mesh points may drive each other out without end.
  lost_ = lost_ || t == TetrahedronMesh::none || ++places_ > 64 + mesh_.size();
  if (lost_) return;
  if (!mesher.conflict(t, id)) return hide(id, t, is, repair);
  const Replaced replaced = mesher.insert(id, t);
  // Always so in a valid mesh. A hidden point may appear while other events of the same time are not yet repaired.
  for (const std::uint32_t created : replaced.created) {
    lost_ = lost_ || (mesh_.finite(created) && is.orientation(mesh_.corners(created)) <= 0);
  }
  complete_change(replaced, nobody, is, repair);
}

/// Completes a change of the mesh: finds a place for the points that were hidden in the tetrahedra that have been
/// replaced, and for the vertices that are gone, and marks the new certificates.
template <class Path>
void SpatialTriangulationRule<Path>::complete_change(const Replaced& replaced, Id without, const Predicates& is,
                                                     Pen& repair) {
  lost_ = lost_ || !replaced.sound;
  if (lost_) return;  // Everything will be built anew.
  std::vector<Id> orphans;
  for (const Id id : replaced.gone) {
    if (id != without) orphans.push_back(id);
  }
  for (const std::uint32_t t : replaced.removed) {
    hidden_.for_each(t, [&](Id id) {
      reveal(id, repair);
      if (!mesh_.contains(id)) orphans.push_back(id);
    });
    for (Slot part = 0; part < 5; ++part) repair.certify(stride * t + part);
    touched_.push_back(t);
  }
  touched_.insert(touched_.end(), replaced.created.begin(), replaced.created.end());
  prove(replaced.created, is, repair);
  near_ = replaced.created.front();
  for (const Id id : orphans) {
    const std::uint32_t home = home_of(id, replaced.created, is);
    home != TetrahedronMesh::none ? hide(id, home, is, repair) : place(id, near_, is, repair);
  }
}

/// A tetrahedron for a point that is still hidden: one of those given, or at a vertex of theirs that it moves with.
template <class Path>
std::uint32_t SpatialTriangulationRule<Path>::home_of(Id id, const std::vector<std::uint32_t>& tetrahedra,
                                                      const Predicates& is) const {
  for (const std::uint32_t t : tetrahedra) {
    if (mesh_.finite(t) && (moves_along(id, t, is) || is.is_in(mesh_, t, id))) return t;
  }
  for (const std::uint32_t t : tetrahedra) {
    if (!moves_along(id, t, is)) continue;
    for (const Id corner : mesh_.corners(t)) {
      if (corner == infinite) continue;
      for (const std::uint32_t home : mesh_.star(corner)) {
        if (mesh_.finite(home) && moves_along(id, home, is)) return home;
      }
    }
  }
  return TetrahedronMesh::none;
}

template <class Path>
void SpatialTriangulationRule<Path>::hide(Id id, std::uint32_t t, const Predicates& is, Pen& repair) {
  hidden_.put(id, t);
  if constexpr (weighted) {
    if (hidden_kind_.size() <= id) hidden_kind_.resize(id + std::size_t{1}, none);
    hidden_kind_[id] = hidden_kind(id, is);
    for (Slot part = 5; part < 10; ++part) repair.certify(stride * id + part);
  } else {
    if (same_as_.size() <= id) same_as_.resize(id + std::size_t{1}, nobody);
    same_as_[id] = companion(id, t, is);
  }
}

template <class Path>
void SpatialTriangulationRule<Path>::reveal(Id id, Pen& repair) {
  hidden_.remove(id);
  if constexpr (weighted) {
    for (Slot part = 5; part < 10; ++part) repair.certify(stride * id + part);
  }
}

/// Finds out by which certificates these tetrahedra and their facets are proved, and marks their slots.
template <class Path>
void SpatialTriangulationRule<Path>::prove(const std::vector<std::uint32_t>& tetrahedra, const Predicates& is,
                                           Pen& repair) {
  kind_.resize(5 * std::size_t{mesh_.end_tetrahedron()}, none);
  for (const std::uint32_t t : tetrahedra) {
    repair.certify(stride * t + 4);
    if (mesh_.finite(t)) continue;
    hull_.find(mesh_, t, is);
    at_hull_ = true;
  }
  for (const std::uint32_t t : tetrahedra) {
    for (Facet f = 4 * t; f < 4 * t + 4; ++f) prove_facet(f, is, repair);
  }
}

/// The same for a facet, from both sides.
template <class Path>
void SpatialTriangulationRule<Path>::prove_facet(Facet f, const Predicates& is, Pen& repair) {
  if (at_hull(f) && hull_.in_outline(mesh_, f)) hull_.find_edge(mesh_, f, is);
  for (const Facet side : {f, mesh_.twin(f)}) {
    kind_[5 * (side / 4) + side % 4] = facet_kind(side, is);
    repair.certify(stride * (side / 4) + side % 4);
  }
}

template <class Path>
std::uint8_t SpatialTriangulationRule<Path>::sphere_kind(const TetrahedronMesh::Corners& abcd, Id e,
                                                         const Predicates& is) {
  if (is.unperturbed(abcd, e) != 0) return plain;
  for (int rank = 0; rank < 5; ++rank) {
    const auto [p, q, r, s] = Predicates::cofactor(abcd, e, rank);
    if (is.orientation(p, q, r, s) != 0) return static_cast<std::uint8_t>(perturbed + rank);
  }
  return none;
}

/// The corner of a tetrahedron that a point moves with, one of a greater id, which the perturbation leaves lower;
/// nobody if there is none. The point is hidden as long as that is a vertex.
template <class Path>
Id SpatialTriangulationRule<Path>::companion(Id id, std::uint32_t t, const Predicates& is) const {
  const TetrahedronMesh::Corners corners = mesh_.corners(t);
  const auto found = std::find_if(corners.begin(), corners.end(), [&](Id c) {
    return c != infinite && id < c && (is.x[c] == is.x[id] || (!weighted && is.same(c, id)));
  });
  return found == corners.end() ? nobody : *found;
}

template <class Path>
std::uint8_t SpatialTriangulationRule<Path>::hidden_kind(Id id, const Predicates& is) const {
  const std::uint32_t t = hidden_.place(id);
  return moves_along(id, t, is) ? std::uint8_t{none} : sphere_kind(mesh_.corners(t), id, is);
}

template <class Path>
std::uint8_t SpatialTriangulationRule<Path>::facet_kind(Facet f, const Predicates& is) const {
  const Facet twin = mesh_.twin(f);
  if (at_hull(f)) {
    if (f > twin) return hull_.in_outline(mesh_, f) ? plain : none;
    const auto [a, b, c, d] = hinge(f);
    return is.orientation(a, b, c, d) != 0 ? plain : none;
  }
  const bool finite = mesh_.finite(f / 4) && mesh_.finite(twin / 4);
  return finite && f < twin ? sphere_kind(mesh_.corners(f / 4), mesh_.apex(twin), is) : std::uint8_t{none};
}

/// Whether the certificates of a facet and of the tetrahedron behind it hold.
template <class Path>
bool SpatialTriangulationRule<Path>::holds(Facet f, const Predicates& is) const {
  if (mesh_.finite(f / 4)) {
    if (is.orientation(mesh_.corners(f / 4)) <= 0) return false;
    return !mesh_.finite(mesh_.twin(f) / 4) || is.in_sphere(mesh_.corners(f / 4), mesh_.apex(mesh_.twin(f))) > 0;
  }
  if (!at_hull(f)) return true;
  const auto [a, b, c, d] = hinge(f);
  return is.orientation(a, b, c, d) >= 0;
}

template <class Path>
void SpatialTriangulationRule<Path>::insert(Id id, Pen& repair) {
  if (flat()) {
    rebuild(nobody, repair);
  } else {
    const Predicates is{repair.elements(), repair.now()};
    begin();
    place(id, near_, is, repair);
    if (!sound()) rebuild(nobody, repair);
  }
  report_touched(repair);
}

template <class Path>
void SpatialTriangulationRule<Path>::remove(Id id, Pen& repair) {
  if (hidden_.contains(id)) return reveal(id, repair);
  if (flat()) return;
  const Predicates is{repair.elements(), repair.now()};
  begin();
  if (!build_around(mesh_.star(id), id, is, repair) || !sound()) rebuild(id, repair);
  report_touched(repair);
}

/// A motion that leaves the tetrahedra around the vertex as they are: a bounce, say, or a small jump.
template <class Path>
bool SpatialTriangulationRule<Path>::keeps(Id id, const Path& next, Pen& repair) {
  if (flat() || hidden_.contains(id)) return false;
  const Predicates is{repair.elements(), repair.now(), id, &next};
  for (const std::uint32_t t : mesh_.star(id)) {
    bool hides = false;
    hidden_.for_each(t, [&](Id) { hides = true; });
    if (hides) return false;
    for (Facet f = 4 * t; f < 4 * t + 4; ++f) {
      if (!holds(f, is)) return false;
    }
  }
  return true;
}

template <class Path>
void SpatialTriangulationRule<Path>::change(Id id, Pen& repair) {
  const Predicates is{repair.elements(), repair.now()};
  begin();
  touched_ = mesh_.star(id);
  prove(touched_, is, repair);
  for (const Id other : neighbours(id)) {
    if (other == infinite) continue;
    const SpatialEdges::Number edge = edges_.between(id, other);
    repair.report(EdgeChange{EdgeChange::What::moved, edge, edges_.ends(edge)});
  }
  if (!sound()) rebuild(nobody, repair);
  report_touched(repair);
}

/// Numbers the edges of what has changed, and tells.
template <class Path>
void SpatialTriangulationRule<Path>::report_touched(Pen& repair) {
  std::sort(touched_.begin(), touched_.end());
  touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
  edges_.update(mesh_, touched_, [&repair](const EdgeChange& change) { repair.report(change); });
  for (const std::uint32_t t : touched_) repair.report(TetrahedronChange{t});
  touched_.clear();
}

/// Updates what HullFacings stores: more of it may have changed at this time. False if the hull does not go round once.
template <class Path>
bool SpatialTriangulationRule<Path>::look_round(const Predicates& is, Pen& repair) {
  prove(mesh_.star(infinite), is, repair);
  return hull_.goes_round_once(mesh_);
}

template <class Path>
void SpatialTriangulationRule<Path>::rebuild(Id without, Pen& repair) {
  const std::uint32_t before = mesh_.end_tetrahedron();
  rebuilds_ += before != 0;
  mesh_.clear();
  hidden_.clear();
  std::vector<Id> ids = repair.elements().ids();
  std::erase(ids, without);
  // In an order that is independent of the points' places, and the same on every machine.
  const auto shuffled = [](Id id) { return (id + 1) * std::uint64_t{0x9e3779b97f4a7c15u} >> 20; };
  std::sort(ids.begin(), ids.end(), [&](Id a, Id b) { return shuffled(a) < shuffled(b); });
  const Predicates is{repair.elements(), repair.now()};
  Mesher mesher(mesh_, is);
  if (mesher.begin(ids)) {
    for (const Id id : ids) {
      if (mesh_.contains(id)) continue;
      const std::uint32_t t = mesher.locate(id, near_ < mesh_.end_tetrahedron() && mesh_.in_use(near_) ? near_ : 0);
      if (mesher.conflict(t, id)) {
        near_ = mesher.insert(id, t).created.front();
      }
    }
  }
  std::vector<std::uint32_t> all;
  for (std::uint32_t t = 0; t < mesh_.end_tetrahedron(); ++t) {
    if (mesh_.in_use(t)) all.push_back(t);
  }
  prove(all, is, repair);
  if (!flat()) {
    near_ = all.front();
    for (const Id id : ids) {
      if (!mesh_.contains(id)) hide(id, mesher.locate(id, near_), is, repair);
    }
  }
  for (std::uint32_t t = 0; t < std::max(before, mesh_.end_tetrahedron()); ++t) {
    for (Slot part = 0; part < 5; ++part) repair.certify(stride * t + part);
    touched_.push_back(t);
  }
  if constexpr (weighted) {
    for (Id id = 0; id < hidden_kind_.size(); ++id) {
      for (Slot part = 5; part < 10; ++part) repair.certify(stride * id + part);
    }
  }
}

}  // namespace kds::structures
