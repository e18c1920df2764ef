#include "collision/drawing/outline.hpp"

#include "collision/shapes/compound.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "collision/shapes/polytope.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>
#include <variant>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

class Outline {
 public:
  Outline(double t, int sides) : t_(t), quarter_(std::max(1, (sides + 3) / 4)) {}

  void operator()(const Sphere& ball) {
    for (int d = 0; d < 3; ++d) {
      arc(Vector3d::Zero(), ball.radius * Vector3d::Unit(d), ball.radius * Vector3d::Unit((d + 1) % 3), 4);
    }
  }
  void operator()(const Box& box) {
    for (int d = 0; d < 3; ++d) {
      for (const double u : {-1.0, 1.0}) {
        for (const double v : {-1.0, 1.0}) {
          Vector3d from;
          from[d] = -1, from[(d + 1) % 3] = u, from[(d + 2) % 3] = v;
          Vector3d to = from;
          to[d] = 1;
          line(from.cwiseProduct(box.half_extents), to.cwiseProduct(box.half_extents));
        }
      }
    }
  }
  void operator()(const Capsule& capsule) {
    const double r = capsule.radius;
    for (const double side : {-1.0, 1.0}) {
      const Vector3d end(0, 0, side * capsule.half_length);
      const Vector3d pole(0, 0, side * r);
      arc(end, {r, 0, 0}, {0, r, 0}, 4);
      arc(end, {r, 0, 0}, pole, 2);
      arc(end, {0, r, 0}, pole, 2);
    }
    for (const Vector3d& at : {Vector3d(r, 0, 0), Vector3d(0, r, 0), Vector3d(-r, 0, 0), Vector3d(0, -r, 0)}) {
      line({at[0], at[1], -capsule.half_length}, {at[0], at[1], capsule.half_length});
    }
  }
  void operator()(const ConvexHull& hull) {
    const auto points = hull.polytope->points();
    for (const HullEdge& edge : hull.polytope->structure().edges) line(points[edge.ends[0]], points[edge.ends[1]]);
  }
  void operator()(const MeshShape& mesh) {
    const auto vertices = mesh.mesh->vertices();
    edges(mesh.mesh->triangles(), [&](std::uint32_t vertex) { return Vector3d(mesh.scale * vertices[vertex]); });
  }
  void operator()(const BendingMesh& mesh) {
    edges(mesh.script->triangles(), [&](std::uint32_t vertex) { return mesh.script->position(vertex, t_); });
  }
  void operator()(const Compound& compound) {
    for (const Shape& part : compound.parts->parts()) std::visit(*this, part);
  }
  /// A square patch of its plane, about the point nearest to the centre of the body, and the way out of it.
  void operator()(const HalfSpace& half_space) {
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

  std::vector<Segment> take() { return std::move(lines_); }

 private:
  static constexpr int patch = 10;  ///< half the side of a patch, in units of length

  void line(const Vector3d& from, const Vector3d& to) { lines_.push_back({from, to}); }

  /// So many quarters of an ellipse, from centre + u through centre + v.
  void arc(const Vector3d& centre, const Vector3d& u, const Vector3d& v, int quarters) {
    const auto at = [&](int i) -> Vector3d {
      const double angle = i * std::numbers::pi / (2 * quarter_);
      return centre + std::cos(angle) * u + std::sin(angle) * v;
    };
    for (int i = 0; i < quarters * quarter_; ++i) line(at(i), at(i + 1));
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
  std::visit(result, shape);
  return result.take();
}

}  // namespace kds::collision
