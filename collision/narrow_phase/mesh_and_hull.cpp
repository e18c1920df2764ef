#include "collision/narrow_phase/mesh_and_hull.hpp"

#include "collision/narrow_phase/relative_motion.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/shapes/polytope.hpp"
#include "collision/shapes/rotation.hpp"
#include "collision/shapes/support.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <variant>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

const Polytope& polytope(const PlacedShape& shape) { return *std::get<ConvexHull>(shape.shape).polytope; }

/// Whether a corner of the mesh is inside of the hull, in doubles: asked where the surfaces are apart. Just after they
/// have parted that is by hardly more than the contact gap, which is of the relative motion, so the places are, too:
/// far from the origin the difference of two rounded places is off by many gaps.
template <int Degree>
bool holds_a_corner(const TranslatingShape<Degree>& hull, const TranslatingShape<Degree>& mesh, double t) {
  const MeshShape& shape = std::get<MeshShape>(mesh.shape.shape);
  const Polytope& solid = polytope(hull.shape);
  const RelativeMotion<Degree> motion = relative_to(hull.motion, mesh.motion);
  const Vector3d apart = motion.position(std::max(t - motion.epoch, 0.0));
  const auto inside = [&](std::uint32_t vertex) {
    const Vector3d x = apart + placed_vertex(mesh.shape.rotation, shape.scale, shape.mesh->vertices()[vertex]);
    if ((x.array() > hull.shape.high.array()).any() || (x.array() < hull.shape.low.array()).any()) return false;
    const Vector3d y = rotated_back(hull.shape.rotation, x);
    for (std::size_t f = 0; f < solid.normals().size(); ++f) {
      const Vector3d& n = solid.normals()[f];
      if (!(dot(n, y - solid.points()[solid.structure().faces[f][0]]) < 0)) return false;
    }
    return true;
  };
  const auto triangles = shape.mesh->triangles();
  return std::any_of(triangles.begin(), triangles.end(), [&](const auto& triangle) { return inside(triangle[0]); });
}

}  // namespace

template <int Degree>
double MeshHullContact<Degree>::first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode,
                                              FoundTouch* found) {
  if (!(t0 <= horizon)) return never;
  if (mode == ContactMode::transparent && in_contact(a, b, t0)) return t0;
  return MeshContact<Degree>::first_contact(a, b, t0, horizon, mode, found);
}

template <int Degree>
double MeshHullContact<Degree>::apart_until(const Body& a, const Body& b, double t0, double horizon,
                                            PairMemory& memory) {
  if (!(t0 <= horizon)) return never;
  const double apart = MeshContact<Degree>::apart_until(a, b, t0, horizon, memory);
  return apart > t0 && holds_a_corner(b, a, t0) ? t0 : apart;
}

template <int Degree>
bool MeshHullContact<Degree>::in_contact(const Body& a, const Body& b, double t) {
  return MeshContact<Degree>::in_contact(a, b, t) || holds_a_corner(b, a, t);
}

/// When the mesh no longer touches the surface of the solid it may be inside. Then it separates only after it has
/// passed through the surface once more.
template <int Degree>
double MeshHullContact<Degree>::first_separation(const Body& a, const Body& b, double t0, double horizon) {
  for (double t = t0; t <= horizon;) {
    t = MeshContact<Degree>::first_separation(a, b, t, horizon);
    if (t == never || !holds_a_corner(b, a, t)) return t;
    t = MeshContact<Degree>::first_contact(a, b, t, horizon, ContactMode::transparent, nullptr);
  }
  return never;
}

template <int Degree>
Contact MeshHullContact<Degree>::contact_at(const Body& a, const Body& b, double t, const FoundTouch& found) {
  Contact contact = MeshContact<Degree>::contact_at(a, b, t, found);
  contact.feature_b = polytope(b.shape).feature_of(contact.feature_b);
  // The test of two triangles may have found an edge or a corner of the triangle next to the face that touches. Then
  // the face is meant.
  const Feature whole = supporting_feature(b.shape, -contact.normal).feature;
  if (polytope(b.shape).is_part_of(contact.feature_b, whole)) contact.feature_b = whole;
  return contact;
}

#define KDS_INSTANTIATE(degree) template struct MeshHullContact<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
