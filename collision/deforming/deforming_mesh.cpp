#include "collision/deforming/deforming_mesh.hpp"

#include "kds/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace kds::collision {
namespace {

[[noreturn]] void refuse(const char* function, const std::string& what) {
  throw std::invalid_argument(std::string("DeformingMesh.") + function + ": " + what);
}

bool within_limits(const Eigen::Vector3d& p) {
  bool all = true;
  for (int d = 0; d < 3; ++d) all = all && std::abs(p[d]) <= Mesh::largest_coordinate;
  return all;
}

}  // namespace

template <int Degree>
DeformingMesh<Degree>::DeformingMesh(Positions positions, std::span<const Mesh::Triangle> triangles, double start,
                                     double thickness)
    : tree_(std::make_shared<const SurfaceTree>(positions, triangles)),
      triangles_(std::make_shared<const std::vector<Mesh::Triangle>>(triangles.begin(), triangles.end())),
      surface_(*tree_) {
  if (!(thickness >= 0 && thickness <= Mesh::largest_coordinate)) {
    throw std::invalid_argument("DeformingMesh: the thickness must be finite and >= 0");
  }
  if (!std::isfinite(start)) throw std::invalid_argument("DeformingMesh: the start must be finite");
  surface_.set_radius(0.5 * thickness);
  for (std::size_t i = 0; i <= Degree; ++i) fill(i, positions);
  surface_.refit(start, start);
}

template <int Degree>
void DeformingMesh<Degree>::check_step(const char* function, double t0, double t1) const {
  if (!(std::isfinite(t0) && std::isfinite(t1) && t0 < t1)) {
    refuse(function, "from " + number_text(t0) + " to " + number_text(t1) + " is no stretch of time");
  }
}

template <int Degree>
void DeformingMesh<Degree>::check_positions(const char* function, Positions positions) const {
  if (positions.size() != vertices()) {
    refuse(function, std::to_string(positions.size()) + " positions for " + std::to_string(vertices()) + " vertices");
  }
  const auto bad = std::find_if_not(positions.begin(), positions.end(), within_limits);
  if (bad != positions.end()) {
    refuse(function, "vertex " + std::to_string(bad - positions.begin()) +
                         ": its position must be finite, and at most 2^100 in magnitude");
  }
}

template <int Degree>
void DeformingMesh<Degree>::set_control_points(double t0, double t1,
                                               const std::array<Positions, std::size_t{Degree} + 1>& control) {
  check_step("set_control_points", t0, t1);
  for (const Positions positions : control) check_positions("set_control_points", positions);
  for (std::size_t i = 0; i <= Degree; ++i) fill(i, control[i]);
  finish(t0, t1);
}

template <int Degree>
void DeformingMesh<Degree>::set_motions(double t0, double t1,
                                        std::span<const certificates::PointMotion<Degree>> motions) {
  check_step("set_motions", t0, t1);
  if (motions.size() != vertices()) {
    refuse("set_motions", std::to_string(motions.size()) + " motions for " + std::to_string(vertices()) + " vertices");
  }
  std::array<std::vector<Eigen::Vector3d>, std::size_t{Degree} + 1> control;
  double error = 0;
  for (const auto& motion : motions) {
    const PathControls<Degree> path(motion, t0, t1);
    error = std::max(error, path.error);
    for (std::size_t i = 0; i <= Degree; ++i) control[i].push_back(path.points[i]);
  }
  for (const auto& points : control) check_positions("set_motions", points);
  for (std::size_t i = 0; i <= Degree; ++i) fill(i, control[i]);
  finish(t0, t1, error);
}

template <int Degree>
void DeformingMesh<Degree>::fill(std::size_t i, Positions positions) {
  const auto points = surface_.change_control_points(i);
  std::copy(positions.begin(), positions.end(), points.begin());
}

template <int Degree>
void DeformingMesh<Degree>::finish(double t0, double t1, double uncertainty) {
  surface_.set_uncertainty(uncertainty);
  surface_.refit(t0, t1);
}

template class DeformingMesh<1>;
template class DeformingMesh<2>;

}  // namespace kds::collision
