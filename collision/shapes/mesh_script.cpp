#include "collision/shapes/mesh_script.hpp"

#include "collision/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

namespace kds::collision {
namespace {

[[noreturn]] void refuse(std::size_t keyframe, const std::string& what) {
  throw std::invalid_argument("keyframes[" + std::to_string(keyframe) + "]" + what);
}

void check_positions(std::span<const Eigen::Vector3d> positions, std::size_t keyframe) {
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const double largest = std::max({std::abs(positions[v][0]), std::abs(positions[v][1]), std::abs(positions[v][2])});
    if (!(positions[v].allFinite() && largest <= Mesh::largest_coordinate)) {
      refuse(keyframe, ".positions[" + std::to_string(v) + "]: must be finite, and at most 2^100 in magnitude");
    }
  }
}

/// Runs before the tree is built from the first.
std::vector<MeshScript::Keyframe> checked(std::vector<MeshScript::Keyframe> keyframes) {
  if (keyframes.empty()) throw std::invalid_argument("keyframes: there is none");
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const auto& [time, positions] = keyframes[i];
    if (!std::isfinite(time)) refuse(i, ".time: must be finite");
    if (i > 0 && !(time > keyframes[i - 1].time)) refuse(i, ".time: must be later than that of the keyframe before");
    if (positions.size() != keyframes[0].positions.size()) {
      refuse(i, ".positions: has " + std::to_string(positions.size()) + " positions, and keyframes[0] has " +
                    std::to_string(keyframes[0].positions.size()));
    }
    check_positions(positions, i);
  }
  return keyframes;
}

std::shared_ptr<const MeshScript::Form> form_of(const std::vector<Eigen::Vector3d>& positions,
                                                std::vector<Mesh::Triangle> triangles) {
  SurfaceTree tree(positions, triangles);
  return std::make_shared<const MeshScript::Form>(MeshScript::Form{std::move(triangles), positions, std::move(tree)});
}

}  // namespace

MeshScript::MeshScript(std::vector<Keyframe> keyframes, std::vector<Mesh::Triangle> triangles)
    : keyframes_(checked(std::move(keyframes))), form_(form_of(keyframes_[0].positions, std::move(triangles))) {
  measure();
}

MeshScript::MeshScript(std::vector<Keyframe> keyframes, std::shared_ptr<const Form> form)
    : keyframes_(checked(std::move(keyframes))), form_(std::move(form)) {
  if (keyframes_[0].positions.size() != vertices()) {
    refuse(0, ".positions: has " + std::to_string(keyframes_[0].positions.size()) + " positions, and the mesh has " +
                  std::to_string(vertices()) + " vertices");
  }
  measure();
}

void MeshScript::measure() {
  for (const Keyframe& keyframe : keyframes_) {
    for (const Eigen::Vector3d& v : keyframe.positions) bounding_radius_ = std::max(bounding_radius_, norm(v));
  }
  bounding_radius_ *=
      1 + 0x1p-50;  // three roundings of the norm, upward; a ball is convex, so it holds what is between
}

MeshScript MeshScript::continued(double t, std::vector<Keyframe> to_come) const {
  for (std::size_t i = 0; i < to_come.size(); ++i) {
    const auto& [time, positions] = to_come[i];
    if (!std::isfinite(time)) refuse(i, ".time: must be finite");
    if (!(time > (i > 0 ? to_come[i - 1].time : t))) {
      refuse(i, i > 0 ? ".time: must be later than that of the keyframe before" : ".time: must be later than now");
    }
    if (positions.size() != vertices()) {
      refuse(i, ".positions: has " + std::to_string(positions.size()) + " positions, and the mesh has " +
                    std::to_string(vertices()) + " vertices");
    }
    check_positions(positions, i);
  }
  std::vector<Keyframe> keyframes(1);
  keyframes[0].time = t;
  for (std::size_t v = 0; v < vertices(); ++v) keyframes[0].positions.push_back(position(v, t));
  std::move(to_come.begin(), to_come.end(), std::back_inserter(keyframes));
  return with(std::move(keyframes));
}

std::size_t MeshScript::keyframes_until(double t) const {
  const auto after = std::upper_bound(keyframes_.begin(), keyframes_.end(), t,
                                      [](double time, const Keyframe& keyframe) { return time < keyframe.time; });
  return static_cast<std::size_t>(after - keyframes_.begin());
}

Eigen::Vector3d MeshScript::position(std::size_t vertex, double t) const {
  const std::size_t next = keyframes_until(t);
  if (next == 0) return keyframes_[0].positions[vertex];
  const Keyframe& before = keyframes_[next - 1];
  if (next == keyframes_.size() || t == before.time) return before.positions[vertex];
  const Keyframe& after = keyframes_[next];
  const double s = (t - before.time) / (after.time - before.time);
  return (1 - s) * before.positions[vertex] + s * after.positions[vertex];
}

Eigen::Vector3d MeshScript::velocity(std::size_t vertex, double t) const {
  const std::size_t next = keyframes_until(t);
  if (next == 0 || next == keyframes_.size()) return Eigen::Vector3d::Zero();
  const Keyframe &before = keyframes_[next - 1], &after = keyframes_[next];
  return (after.positions[vertex] - before.positions[vertex]) / (after.time - before.time);
}

}  // namespace kds::collision
