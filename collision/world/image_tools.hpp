// Tools of the images of the world's parts: see World::archive().
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <stdexcept>
#include <string>

namespace kds::collision::image {

/// Throws std::runtime_error: it is not an image that a world can have saved. Other images could make the world read
/// out of bounds, or never end.
[[noreturn]] inline void fail(const std::string& what) { throw std::runtime_error("snapshot: " + what); }

inline void require(bool right, const char* list, std::size_t index, const char* what) {
  if (!right) fail(std::string(list) + "[" + std::to_string(index) + "]: " + what);
}

/// A time that may be -infinity, and is not after now.
inline bool is_past(double time, double now) { return time <= now; }
/// A time that may be infinity, and is not before now.
inline bool is_to_come(double time, double now) { return time >= now; }

template <class Archive>
void vector(Archive& archive, Eigen::Vector3d& v) {
  archive(v[0], v[1], v[2]);
}

}  // namespace kds::collision::image
