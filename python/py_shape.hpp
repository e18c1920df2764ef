// Shapes as Python has them.
#pragma once

#include "collision/shapes/mesh_keyframe.hpp"
#include "collision/shapes/shape.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace kds_python {

/// A shape that place() has accepted. (A type of its own, since pybind11 takes a std::variant apart.)
struct PyShape {
  kds::collision::Shape shape;
};

/// Times, and for each of them as many positions, one time after the other.
inline std::vector<kds::collision::MeshKeyframe> to_keyframes(const std::vector<double>& times,
                                                              const std::vector<Eigen::Vector3d>& positions) {
  std::vector<kds::collision::MeshKeyframe> keyframes;
  const std::size_t each = times.empty() ? 0 : positions.size() / times.size();
  auto next = positions.begin();
  for (const double time : times) {
    keyframes.push_back({time, {next, next + static_cast<std::ptrdiff_t>(each)}});
    next += static_cast<std::ptrdiff_t>(each);
  }
  return keyframes;
}

}  // namespace kds_python
