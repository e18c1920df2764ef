// Reads a scene file: strict, and exact about what is wrong where.
#pragma once

#include "examples/kds-collide/scene.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace kds_collide {

/// Largest magnitude of any number of a scene, and smallest of a size, mass or scale: products of four of them, with
/// room to spare for error bounds, stay normal doubles.
inline constexpr double largest_number = 1e30;
inline constexpr double smallest_size = 1e-30;

/// How far from 1 the norm of an orientation may be: files carry few digits. It is normalised.
inline constexpr double orientation_tolerance = 1e-6;

/// Reads the file and the meshes it names. Throws SceneError.
Scene read_scene(const std::filesystem::path& file);

/// The same from text; `file` is named in errors, and meshes are looked for beside it.
Scene parse_scene(std::string_view text, const std::filesystem::path& file);

}  // namespace kds_collide
