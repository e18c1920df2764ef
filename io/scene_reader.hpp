// Reads a scene file: strict, and exact about what is wrong where.
#pragma once

#include "collision/parallel/processes.hpp"
#include "io/scene.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace kds::io {

/// Reads the file and the meshes it names; the scene ends at `until`, in seconds, instead of its end_time, if that is
/// given. Throws SceneError.
Scene read_scene(const std::filesystem::path& file, std::optional<double> until = {});

/// The same of one of several processes, by its rank: some of the bodies, those of rank 0 the first ones, and as many
/// for each. Of tables only their rows are read. What is about all bodies, begin_time and degree(), is about these
/// until complete(). Throws SceneError.
Scene read_share(const std::filesystem::path& file, std::optional<double> until, std::size_t rank,
                 std::size_t processes);
/// All processes make this call, each with its share of the scene, when all have one. Throws SceneError, in all.
void complete(Scene& share, const std::filesystem::path& file, kds::collision::Team& team);

/// The same as read_scene() from text; `file` is named in errors, and meshes are looked for beside it.
Scene parse_scene(std::string_view text, const std::filesystem::path& file, std::optional<double> until = {});

}  // namespace kds::io
