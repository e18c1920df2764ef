// Kinetic Delaunay triangulation in the plane.
#pragma once

#include "structures/plane_triangulation.hpp"

namespace kds::structures {

/// The Delaunay triangulation of moving points: no point is inside the circle through the corners of a triangle. If
/// four or more points stay on one circle, it is one of the triangulations with this property.
///
/// Papers: [Guibas91], [Basch99]. Certificates of degree 4 for linear, 8 for quadratic paths.
///
/// Cost: an event is a flip, O(1) certificates (responsive: 20 marked at most, 5 in-circle tests among them); at most 5
/// n certificates (compact: 3 n edges, 2 n areas and directions of the hull's edges); an element is in some three for
/// each of its neighbours (not local in the worst case, six neighbours on average); every event is a change of the
/// triangulation, except when an edge of the hull changes its heading (efficient). Insertion O(sqrt n) for the walk and
/// O(neighbours); removal O(neighbours^2); a new motion that keeps the triangles around it O(neighbours), any other a
/// removal and an insertion. Number of events: at most nearly cubic [Guibas91], nearly quadratic where all move at one
/// speed [Rubin15].
template <class Path>
using DelaunayRule = PlaneTriangulationRule<Path, Criterion::delaunay>;

}  // namespace kds::structures
