#include "io/pictures/body_surface.hpp"

#include "collision/shapes/mesh.hpp"
#include "collision/shapes/shape_forms.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace kds::io {
namespace {

using namespace kds::collision;
using Eigen::Vector3d;

/// Of radius 1 about the z axis, from -half_length to half_length; a ball if that is 0.
Surface round_surface(double half_length, const Roundness& roundness) {
  const auto [around, quarter] = roundness;
  Surface surface;
  for (int ring = 0; ring < 2 * quarter + 2; ++ring) {
    const bool upper = ring > quarter;
    const double height = (ring - (upper ? quarter + 1 : quarter)) * std::numbers::pi / (2 * quarter);
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      const Vector3d normal(std::cos(height) * std::cos(angle), std::cos(height) * std::sin(angle), std::sin(height));
      append_floats(surface.normals, normal);
      append_floats(surface.places, normal + Vector3d(0, 0, upper ? half_length : -half_length));
    }
  }
  const auto n = static_cast<std::uint32_t>(around);
  for (std::uint32_t ring = 0; ring < 2 * static_cast<std::uint32_t>(quarter) + 1; ++ring) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = ring * n + i, b = ring * n + (i + 1) % n;
      for (const std::uint32_t corner : {a, b, b + n, a, b + n, a + n}) surface.triangles.push_back(corner);
    }
  }
  return surface;
}

Surface box_surface() {
  Surface surface;
  for (int d = 0; d < 3; ++d) {
    for (const double side : {-1.0, 1.0}) {
      const auto first = static_cast<std::uint32_t>(surface.places.size() / 3);
      for (const auto& [u, v] : {std::pair(-1.0, -1.0), {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
        Vector3d corner;
        corner[d] = side, corner[(d + 1) % 3] = side * u, corner[(d + 2) % 3] = v;
        append_floats(surface.places, corner);
        append_floats(surface.normals, side * Vector3d::Unit(d));
      }
      for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) surface.triangles.push_back(first + k);
    }
  }
  return surface;
}

Surface mesh_surface(const Mesh& mesh) {
  Surface surface;
  for (const Vector3d& v : mesh.vertices()) append_floats(surface.places, v);
  for (const auto& triangle : mesh.triangles()) {
    surface.triangles.insert(surface.triangles.end(), triangle.begin(), triangle.end());
  }
  return surface;
}

/// Of what is round: half of its length without the ends, in radii.
double slenderness(const Shape& shape) {
  const auto box = rounded_box_of(shape);
  return box && box->radius > 0 ? box->half_extents[2] / box->radius : 0;
}

}  // namespace

Surface surface_of(const Shape& shape, const Roundness& roundness) {
  if (const auto triangles = triangles_of(shape)) return mesh_surface(*triangles);
  return rounding_radius(shape) > 0 ? round_surface(slenderness(shape), roundness) : box_surface();
}

Surface surface_of(const MeshScript& script) {
  Surface surface;
  for (const Vector3d& v : script.keyframes()[0].positions) append_floats(surface.places, v);
  for (const auto& triangle : script.triangles()) {
    surface.triangles.insert(surface.triangles.end(), triangle.begin(), triangle.end());
  }
  return surface;
}

SurfaceKey surface_key(const Shape& shape) {
  return {shape.index(), static_cast<const void*>(triangles_of(shape).get()), slenderness(shape)};
}

Vector3d surface_scale(const Shape& shape) {
  const double radius = rounding_radius(shape);
  return radius > 0 ? Vector3d(Vector3d::Constant(radius)) : measures(shape);
}

void append_floats(std::vector<float>& to, const Vector3d& v) {
  for (int d = 0; d < 3; ++d) to.push_back(static_cast<float>(v[d]));
}

}  // namespace kds::io
