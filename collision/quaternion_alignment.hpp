// A program and the library have to agree on how Eigen aligns quaternions.
#pragma once

#include "collision/quaternion.hpp"

#include <cstddef>

namespace kds::collision {

/// Where code is compiled for AVX (-mavx, -march=native) Eigen aligns quaternions to 32 bytes, and else to 16. Structs
/// that hold them then have another layout, and code that both compile expects another alignment: what is compiled so
/// and so must not be linked. The library has `as_the_library` for its own alignment only, and all programs that know
/// shapes ask for that of theirs: "undefined reference to `kds::collision::QuaternionsAlignedTo<32ul>::as_the_library'"
/// says that one of the two is compiled for AVX, and the other is not.
template <std::size_t bytes>
struct QuaternionsAlignedTo {
  static const char as_the_library;
};
template <>
const char QuaternionsAlignedTo<alignof(Eigen::Quaterniond)>::as_the_library;

#if defined(__GNUC__)
[[gnu::used]]
#endif
inline const char* const asks_for_alignment = &QuaternionsAlignedTo<alignof(Eigen::Quaterniond)>::as_the_library;

}  // namespace kds::collision
