// Mass, centre of mass and inertia of solid shapes of uniform density.
#pragma once

#include "collision/shapes/compound.hpp"
#include "collision/shapes/shape.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace kds::collision {

/// Mass, centre of mass and inertia of a body.
struct MassProperties {
  double mass;
  Eigen::Vector3d centre;   ///< of mass, from the origin of the shape; units of length
  Eigen::Matrix3d inertia;  ///< about the centre of mass, in the axes of the shape; mass * length^2
};

/// Mass, centre and inertia of the shape as a uniform solid of the mass given. A mesh is the solid that its triangles
/// bound: space counts as often as they wind around it counterclockwise seen from outside, so cavities are bounded by
/// triangles turned inward, and what two parts share counts twice. Vertices at one place count as one; the scale is
/// included. A compound is all of its parts, of one density: what two of them share counts twice.
///
/// Errors, with u = 2^-53: ball and box, each moment 4 u of itself; capsule 12 u. Mesh: each coordinate of the centre 2
/// u of itself, and each entry of the tensor 4 u of itself; and besides 2^-54 s for the centre and 2^-50 m s^2 for the
/// tensor, where s is the greatest extent of the mesh along an axis, m the mass. These are reached only by meshes that
/// are nearly flat: the integrals are made in double-doubles, from a vertex of the mesh, so for n triangles that make a
/// body of some thickness it is some n 2^-95. (The rounding of the vertices of a mesh far from its origin is not
/// counted.) Compound: besides those of its parts, some roundings of the greatest entry, and of
/// its bounding radius for the centre.
///
/// Throws std::invalid_argument, in one line:
/// - what place() says of the numbers of a shape, and of the mass as of a size;
/// - "mass_properties: the mesh is open: edge 3-7 belongs to one triangle, 5" (numbers of vertices, and of the
///   triangle);
/// - "mass_properties: the mesh is not consistently oriented: triangles 0 and 5 both run along edge 3-7 that way";
/// - "mass_properties: the mesh is inside out: its triangles turn clockwise seen from outside";
/// - "mass_properties: the mesh has no volume beyond rounding": thinner than about n 2^-42 of its extent;
/// - "mass_properties: the mesh is too thin: ...", where its least moment, below 2^-44 of the greatest, is lost in the
///   errors above: a needle some four million times longer than thick;
/// - what checked_inertia() says of the tensor of a mesh some parts of which are inside out;
/// - "compound: part 3: " with any of these, as InvalidCompound.
///
/// Cost: n log n for n triangles. Paper: the integrals are polynomials of the vertices, as in [Mirtich96].
/// Differs: summed over the tetrahedra that triangles make with one vertex of the mesh, not over projected faces, whose
/// quotients lose all digits where a face is seen edge-on.
MassProperties mass_properties(const Shape& shape, double mass);

/// The parts, all moved by one way, so that the origin is the centre of mass of their compound, up to its error above:
/// as a free body is to have it, which turns about its origin. Throws as compound() and mass_properties() do.
std::vector<CompoundPart> about_centre_of_mass(std::span<const CompoundPart> parts);

}  // namespace kds::collision
