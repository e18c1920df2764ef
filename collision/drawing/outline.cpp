#include "collision/drawing/outline.hpp"

#include "collision/shapes/shape_kinds.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// What shapes draw themselves with, those that have a function outline() (ShapeKind), and how all others are drawn.
class Outline {
 public:
  Outline(double t, int sides) : t_(t), quarter_(std::max(1, (sides + 3) / 4)) {}

  void line(const Vector3d& from, const Vector3d& to) { lines_.push_back({from, to}); }

  /// So many quarters of an ellipse, from centre + u through centre + v.
  void arc(const Vector3d& centre, const Vector3d& u, const Vector3d& v, int quarters) {
    const auto at = [&](int i) -> Vector3d {
      const double angle = i * std::numbers::pi / (2 * quarter_);
      return centre + std::cos(angle) * u + std::sin(angle) * v;
    };
    for (int i = 0; i < quarters * quarter_; ++i) line(at(i), at(i + 1));
  }

  void draw(const Shape& shape) {
    ask_kind(shape, [&](auto kind, const auto& each) {
      if constexpr (requires { kind.outline(each, *this); }) {
        kind.outline(each, *this);
      } else {
        draw_form(form_of(kind, each));
      }
    });
  }

  std::vector<Segment> take() { return std::move(lines_); }

 private:
  static constexpr int patch = 10;  ///< half the side of a patch, in units of length

  void draw_form(const Polytope& hull) {
    const auto points = hull.points();
    for (const HullEdge& edge : hull.structure().edges) line(points[edge.ends[0]], points[edge.ends[1]]);
  }
  void draw_form(const MeshShape& mesh) {
    const auto vertices = mesh.mesh->vertices();
    edges(mesh.mesh->triangles(), [&](std::uint32_t vertex) { return Vector3d(mesh.scale * vertices[vertex]); });
  }
  void draw_form(const BendingMesh& mesh) {
    edges(mesh.script->triangles(), [&](std::uint32_t vertex) { return mesh.script->position(vertex, t_); });
  }
  void draw_form(const Compound& compound) {
    for (const Shape& part : compound.parts->parts()) draw(part);
  }
  /// A square patch of its plane, about the point nearest to the centre of the body, and the way out of it.
  void draw_form(const HalfSpace& half_space) {
    const Vector3d out = half_space.normal.normalized();
    const Vector3d middle = half_space.offset * out;
    int least = 0;
    out.cwiseAbs().minCoeff(&least);
    const Vector3d u = out.cross(Vector3d::Unit(least)).normalized();
    const Vector3d v = out.cross(u);
    for (int i = -patch; i <= patch; ++i) {
      line(middle + i * u - patch * v, middle + i * u + patch * v);
      line(middle + i * v - patch * u, middle + i * v + patch * u);
    }
    line(middle, middle + out);
  }

  template <class At>
  void edges(std::span<const Mesh::Triangle> triangles, const At& at) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> all;
    for (const Mesh::Triangle& triangle : triangles) {
      for (std::size_t i = 0; i < 3; ++i) all.push_back(std::minmax(triangle[i], triangle[(i + 1) % 3]));
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    for (const auto& [from, to] : all) line(at(from), at(to));
  }

  double t_;
  int quarter_;  ///< lines of a quarter of a circle
  std::vector<Segment> lines_;
};

}  // namespace

std::vector<Segment> outline(const Shape& shape, double t, int sides) {
  Outline result(t, sides);
  result.draw(shape);
  return result.take();
}

}  // namespace kds::collision
