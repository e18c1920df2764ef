#include "tests/fuzz/random_piles/depth.hpp"

#include "collision/shapes/mesh.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <variant>

namespace kds::piles {
namespace {

using collision::Box;
using collision::Capsule;
using collision::MeshShape;
using collision::Sphere;
using Eigen::Vector3d;

/// Cross products of unit edges below this have no direction to speak of; the axis is not needed for the bound to hold.
constexpr double parallel = 0x1p-30;

struct Segment {
  Vector3d from;
  Vector3d to;
};

double distance(const Vector3d& p, const Segment& s) {
  const Vector3d along = s.to - s.from;
  const double length2 = along.squaredNorm();
  const double at = length2 > 0 ? std::clamp((p - s.from).dot(along) / length2, 0.0, 1.0) : 0;
  return (s.from + at * along - p).norm();
}

/// Where neither end is nearest, both points lie inside, where the common normal meets the segments.
double distance(const Segment& s, const Segment& t) {
  double least = std::min({distance(s.from, t), distance(s.to, t), distance(t.from, s), distance(t.to, s)});
  const Vector3d d = s.to - s.from;
  const Vector3d e = t.to - t.from;
  const Vector3d r = s.from - t.from;
  const double a = d.squaredNorm(), b = d.dot(e), c = e.squaredNorm();
  const double determinant = a * c - b * b;
  if (!(determinant > parallel * parallel * a * c)) return least;
  const double u = (b * e.dot(r) - c * d.dot(r)) / determinant;
  const double v = (a * e.dot(r) - b * d.dot(r)) / determinant;
  if (u > 0 && u < 1 && v > 0 && v < 1) least = std::min(least, (r + u * d - v * e).norm());
  return least;
}

/// What separating axes need: corners, and directions of edges and of the normals of faces, of unit length.
struct Polytope {
  std::vector<Vector3d> corners;
  std::vector<Vector3d> edges;
  std::vector<Vector3d> normals;
};

Polytope polytope(const Segment& s) {
  const Vector3d along = s.to - s.from;
  if (along.isZero(0)) return {{s.from}, {}, {}};
  return {{s.from, s.to}, {along.normalized()}, {}};
}

Polytope polytope(const collision::PlacedShape& box, const Vector3d& at) {
  Polytope result;
  for (int i = 0; i < 8; ++i) {
    Vector3d corner = at;
    for (int d = 0; d < 3; ++d) corner += (i >> d & 1 ? 1 : -1) * box.half_axes[static_cast<std::size_t>(d)];
    result.corners.push_back(corner);
  }
  for (const Vector3d& half : box.half_axes) result.edges.push_back(half.normalized());
  result.normals = result.edges;
  return result;
}

Polytope polytope(const Face& face, const Vector3d& at) {
  Polytope result;
  for (std::size_t i = 0; i < 3; ++i) {
    result.corners.push_back(at + face.corners[i]);
    result.edges.push_back((face.corners[(i + 1) % 3] - face.corners[i]).normalized());
  }
  result.normals.push_back(result.edges[0].cross(result.edges[1]).normalized());
  return result;
}

/// The least overlap of the projections on the axes that can separate convex polytopes: their depth, or less where they
/// are apart.
double depth(const Polytope& a, const Polytope& b) {
  double least = std::numeric_limits<double>::infinity();
  const auto look_along = [&](const Vector3d& axis) {
    constexpr double all = std::numeric_limits<double>::infinity();
    double low_a = all, high_a = -all, low_b = all, high_b = -all;
    for (const Vector3d& corner : a.corners) {
      low_a = std::min(low_a, axis.dot(corner));
      high_a = std::max(high_a, axis.dot(corner));
    }
    for (const Vector3d& corner : b.corners) {
      low_b = std::min(low_b, axis.dot(corner));
      high_b = std::max(high_b, axis.dot(corner));
    }
    least = std::min({least, high_a - low_b, high_b - low_a});
  };
  for (const Vector3d& normal : a.normals) look_along(normal);
  for (const Vector3d& normal : b.normals) look_along(normal);
  for (const Vector3d& e : a.edges) {
    for (const Vector3d& f : b.edges) {
      const Vector3d axis = e.cross(f);
      if (axis.norm() > parallel) look_along(axis.normalized());
    }
  }
  return least;
}

/// Of a point from the outside of a box; below 0 inside.
double signed_distance(const Vector3d& p, const collision::PlacedShape& box, const Vector3d& at) {
  const Vector3d local = box.rotation.transpose() * (p - at);
  const Vector3d out = local.cwiseAbs() - std::get<Box>(box.shape).half_extents;
  if (out.maxCoeff() <= 0) return out.maxCoeff();
  return out.cwiseMax(0).norm();
}

/// The edges of a box that meet at two opposite corners and those between: all twelve.
template <class Visit>
void for_each_edge(const collision::PlacedShape& box, const Vector3d& at, const Visit& visit) {
  for (std::size_t d = 0; d < 3; ++d) {
    const Vector3d& along = box.half_axes[d];
    const Vector3d& u = box.half_axes[(d + 1) % 3];
    const Vector3d& v = box.half_axes[(d + 2) % 3];
    for (const double s : {-1.0, 1.0}) {
      for (const double t : {-1.0, 1.0}) {
        const Vector3d middle = at + s * u + t * v;
        visit(Segment{middle - along, middle + along});
      }
    }
  }
}

/// Of a round shape's core and a box.
double depth(const Segment& core, double radius, const collision::PlacedShape& box, const Vector3d& at) {
  if (core.from == core.to) return radius - signed_distance(core.from, box, at);
  const double inside = depth(polytope(core), polytope(box, at));
  if (inside > 0) return radius + inside;
  double least = std::min(signed_distance(core.from, box, at), signed_distance(core.to, box, at));
  for_each_edge(box, at, [&](const Segment& edge) { least = std::min(least, distance(core, edge)); });
  return radius - std::max(least, 0.0);
}

double distance(const Vector3d& p, const Face& face, const Vector3d& at) {
  std::array<Vector3d, 3> c;
  for (std::size_t i = 0; i < 3; ++i) c[i] = at + face.corners[i];
  const Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
  bool over = true;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d& from = c[i];
    const Vector3d& to = c[(i + 1) % 3];
    over = over && normal.dot((to - from).cross(p - from)) >= 0;
    least = std::min(least, distance(p, Segment{from, to}));
  }
  return over ? std::abs(normal.dot(p - c[0])) : least;
}

double depth(const Segment& core, double radius, const Face& face, const Vector3d& at) {
  double least = std::min(distance(core.from, face, at), distance(core.to, face, at));
  if (core.from != core.to) {
    for (std::size_t i = 0; i < 3; ++i) {
      least = std::min(least, distance(core, Segment{at + face.corners[i], at + face.corners[(i + 1) % 3]}));
    }
    const double pierced = depth(polytope(core), polytope(face, at));
    if (pierced > 0) return radius + pierced;
  }
  return radius - least;
}

double radius_of(const collision::PlacedShape& shape) {
  if (const auto* ball = std::get_if<Sphere>(&shape.shape)) return ball->radius;
  if (const auto* capsule = std::get_if<Capsule>(&shape.shape)) return capsule->radius;
  return 0;
}

bool is_round(const Solid& solid) { return radius_of(solid.shape) > 0; }
bool is_mesh(const Solid& solid) { return !solid.faces.empty(); }

Segment core_of(const collision::PlacedShape& shape, const Vector3d& at) {
  const auto* const capsule = std::get_if<Capsule>(&shape.shape);
  if (!capsule) return {at, at};
  const Vector3d half = shape.rotation.col(2) * capsule->half_length;
  return {at - half, at + half};
}

/// Of a convex shape and the triangles of a mesh that are near it.
double depth_in_mesh(const Solid& mesh, const Vector3d& at, const Solid& other, const Vector3d& at_other) {
  double deepest = -std::numeric_limits<double>::infinity();
  for (const Face& face : mesh.faces) {
    const double apart = (at + face.middle - at_other).norm() - face.radius - other.shape.bounding_radius;
    if (-apart <= deepest) continue;
    if (apart > 0) {
      deepest = std::max(deepest, -apart);
    } else if (is_round(other)) {
      deepest = std::max(deepest, depth(core_of(other.shape, at_other), radius_of(other.shape), face, at));
    } else {
      deepest = std::max(deepest, depth(polytope(face, at), polytope(other.shape, at_other)));
    }
  }
  return deepest;
}

}  // namespace

Solid::Solid(collision::PlacedShape placed) : shape(std::move(placed)) {
  const auto* const mesh = std::get_if<MeshShape>(&shape.shape);
  if (!mesh) return;
  const auto vertices = mesh->mesh->placed_vertices(shape.rotation, mesh->scale);
  for (const auto& [a, b, c] : mesh->mesh->triangles()) {
    Face face{{vertices[a], vertices[b], vertices[c]}, (vertices[a] + vertices[b] + vertices[c]) / 3, 0};
    for (const Vector3d& corner : face.corners) face.radius = std::max(face.radius, (corner - face.middle).norm());
    faces.push_back(face);
  }
}

double depth(const Solid& a, const Vector3d& at_a, const Solid& b, const Vector3d& at_b) {
  const double of_balls = a.shape.bounding_radius + b.shape.bounding_radius - (at_b - at_a).norm();
  if (of_balls < 0) return of_balls;
  if (is_mesh(a) && is_mesh(b)) {
    double deepest = -std::numeric_limits<double>::infinity();
    for (const Face& f : a.faces) {
      for (const Face& g : b.faces) {
        const double apart = (at_a + f.middle - at_b - g.middle).norm() - f.radius - g.radius;
        if (-apart <= deepest) continue;
        deepest = std::max(deepest, apart > 0 ? -apart : depth(polytope(f, at_a), polytope(g, at_b)));
      }
    }
    return deepest;
  }
  if (is_mesh(a)) return depth_in_mesh(a, at_a, b, at_b);
  if (is_mesh(b)) return depth_in_mesh(b, at_b, a, at_a);
  if (is_round(a) && is_round(b)) {
    return radius_of(a.shape) + radius_of(b.shape) - distance(core_of(a.shape, at_a), core_of(b.shape, at_b));
  }
  if (is_round(a)) return depth(core_of(a.shape, at_a), radius_of(a.shape), b.shape, at_b);
  if (is_round(b)) return depth(core_of(b.shape, at_b), radius_of(b.shape), a.shape, at_a);
  return depth(polytope(a.shape, at_a), polytope(b.shape, at_b));
}

}  // namespace kds::piles
