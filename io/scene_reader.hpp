// Reads a scene file: strict, and exact about what is wrong where.
#pragma once

#include "io/scene.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace kds::io {

/// Reads the file and the meshes it names; the scene ends at `until`, in seconds, instead of its end_time, if that is
/// given. Throws SceneError.
Scene read_scene(const std::filesystem::path& file, std::optional<double> until = {});

/// The same from text; `file` is named in errors, and meshes are looked for beside it.
Scene parse_scene(std::string_view text, const std::filesystem::path& file, std::optional<double> until = {});

}  // namespace kds::io
