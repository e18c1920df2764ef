// Kinetic convex hull in the plane.
#pragma once

#include "structures/plane_triangulation.hpp"

namespace kds::structures {

/// The convex hull of moving points, including points that stay on its edges.
///
/// Proved by any triangulation of the points whose triangles have positive area and whose outline is convex: a
/// deformable tiling as in [Agarwal02]. Differs: the hull of [Basch99] section 4 is proved by a hierarchy of merged
/// envelopes, which bounds the events that do not change the hull; here they are cheap and of low degree, but every
/// three points may cause one.
///
/// Certificates of degree 2 for linear, 4 for quadratic paths. Cost: an event is a flip, O(1) certificates
/// (responsive); at most 2 n + (points of the hull) certificates (compact); an element is in as many as it has
/// neighbours (not local in the worst case). External events are changes of the hull, all others are internal: not
/// efficient in general.
template <class Path>
using ConvexHullRule = PlaneTriangulationRule<Path, Criterion::hull>;

}  // namespace kds::structures
