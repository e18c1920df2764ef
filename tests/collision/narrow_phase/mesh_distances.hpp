// Distances of surfaces at rest, in long double: they share no code with the tests over time.
#pragma once

#include "collision/narrow_phase/mesh_contact.hpp"
#include "collision/narrow_phase/placed_surface.hpp"
#include "collision/narrow_phase/separating_axes.hpp"
#include "tests/collision/sample_meshes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace kds::collision::samples {

using Long = long double;
using Vector3l = Eigen::Matrix<Long, 3, 1>;
using Corners = std::array<Vector3l, 3>;

inline Long segment_distance(const Vector3l& p, const Vector3l& u, const Vector3l& q, const Vector3l& v) {
  const Vector3l w = p - q;
  const Long uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), uw = u.dot(w), vw = v.dot(w);
  Long best = std::numeric_limits<Long>::infinity();
  const auto consider = [&](Long s, Long t) {
    best = std::min(best, (w + std::clamp<Long>(s, 0, 1) * u - std::clamp<Long>(t, 0, 1) * v).norm());
  };
  const Long determinant = uu * vv - uv * uv;
  if (determinant > 0) {
    const Long s = (uv * vw - vv * uw) / determinant;
    if (s >= 0 && s <= 1) consider(s, (uv * s + vw) / vv);
  }
  for (const Long s : {0.0L, 1.0L}) consider(s, (uv * s + vw) / vv);
  for (const Long t : {0.0L, 1.0L}) consider((uv * t - uw) / uu, t);
  return best;
}

inline Long point_distance(const Vector3l& p, const Corners& t) {
  const Vector3l normal = (t[1] - t[0]).cross(t[2] - t[0]);
  bool inside = true;
  Long best = std::numeric_limits<Long>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3l edge = t[(i + 1) % 3] - t[i];
    inside = inside && normal.cross(edge).dot(p - t[i]) >= 0;
    const Long along = std::clamp<Long>(edge.dot(p - t[i]) / edge.dot(edge), 0, 1);
    best = std::min(best, (p - t[i] - along * edge).norm());
  }
  return inside ? std::abs(normal.dot(p - t[0])) / normal.norm() : best;
}

inline bool crosses(const Vector3l& p, const Vector3l& q, const Corners& t) {
  const auto volume = [](const Vector3l& a, const Vector3l& b, const Vector3l& c, const Vector3l& d) {
    return (b - a).cross(c - a).dot(d - a);
  };
  if ((volume(t[0], t[1], t[2], p) > 0) == (volume(t[0], t[1], t[2], q) > 0)) return false;
  const bool first = volume(p, q, t[0], t[1]) > 0;
  return (volume(p, q, t[1], t[2]) > 0) == first && (volume(p, q, t[2], t[0]) > 0) == first;
}

inline Long triangle_distance(const Corners& a, const Corners& b) {
  Long best = std::numeric_limits<Long>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    if (crosses(a[i], a[(i + 1) % 3], b) || crosses(b[i], b[(i + 1) % 3], a)) return 0;
    best = std::min({best, point_distance(a[i], b), point_distance(b[i], a)});
    for (std::size_t j = 0; j < 3; ++j) {
      best = std::min(best, segment_distance(a[i], a[(i + 1) % 3] - a[i], b[j], b[(j + 1) % 3] - b[j]));
    }
  }
  return best;
}

/// All triangles of a mesh, and what is around them.
class PlacedTriangles {
 public:
  explicit PlacedTriangles(const PlacedShape& shape) : PlacedTriangles(std::get<MeshShape>(shape.shape), shape) {}
  PlacedTriangles(const PlacedTriangles&) = delete;
  PlacedTriangles& operator=(const PlacedTriangles&) = delete;

  std::size_t size() const { return triangles_.size(); }
  const PlacedTriangle& operator[](std::size_t i) const { return triangles_[i]; }
  auto begin() const { return triangles_.begin(); }
  auto end() const { return triangles_.end(); }

 private:
  PlacedTriangles(const MeshShape& shape, const PlacedShape& placed)
      : surface_(*shape.mesh, shape.scale, placed.rotation) {
    for (std::uint32_t i = 0; i < shape.mesh->triangles().size(); ++i) triangles_.push_back(surface_.triangle(i));
  }

  PlacedSurface surface_;
  std::vector<PlacedTriangle> triangles_;
};
inline PlacedTriangles triangles_of(const PlacedShape& shape) { return PlacedTriangles(shape); }

template <int Degree>
Vector3l exact_place(const RelativeMotion<Degree>& motion, Long tau) {
  Vector3l place = motion.coefficients[Degree].template cast<Long>();
  for (std::size_t i = Degree; i-- > 0;) place = place * tau + motion.coefficients[i].template cast<Long>();
  return place;
}

inline Corners corners(const PlacedTriangle& t, const Vector3l& offset) {
  return {t.vertices[0].cast<Long>() + offset, t.vertices[1].cast<Long>() + offset,
          t.vertices[2].cast<Long>() + offset};
}

/// Distance of the surfaces of two meshes; of a mesh and a ball's surface, 0 inside the ball.
inline Long distance(const PlacedShape& a, const PlacedShape& b, const Vector3l& offset) {
  Long best = std::numeric_limits<Long>::infinity();
  const Vector3l nowhere = Vector3l::Zero();
  if (const auto* ball = std::get_if<Sphere>(&b.shape)) {
    for (const auto& t : triangles_of(a)) best = std::min(best, point_distance(offset, corners(t, nowhere)));
    return std::max<Long>(best - ball->radius, 0);
  }
  const auto of_b = triangles_of(b);
  for (const auto& t : triangles_of(a)) {
    for (const auto& u : of_b) best = std::min(best, triangle_distance(corners(t, nowhere), corners(u, offset)));
  }
  return best;
}

inline PlacedShape random_shape(Random& random, int kind) {
  const double scale = random.uniform(0.5, 1.5);
  switch (kind) {
    case 0:
      return placed(torus(8, 4), scale, random.orientation());
    case 1:
      return placed(cuboid({0.5, 0.7, 0.3}), scale, random.orientation());
    case 2:
      return placed(ball_mesh(1), scale, random.orientation());
    case 3:
      return place(Box{{0.5 * scale, 0.3 * scale, 0.8 * scale}}, random.orientation());
    default:
      return place(Sphere{0.6 * scale}, Eigen::Quaterniond::Identity());
  }
}

}  // namespace kds::collision::samples
