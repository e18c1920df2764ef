#include "examples/kds-collide/file_names.hpp"

#include "io/output_file.hpp"
#include "io/run_lock.hpp"
#include "io/vtk.hpp"

#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace kds_collide {
namespace {

using Path = std::filesystem::path;

/// A file; or, if it is numbered, the files path.0, path.1... with an ending.
struct FileName {
  std::string option;  ///< or what else names it
  Path file;
  bool numbered = false;
  std::string ending{};
};

/// Where a path leads, also if there is no file yet.
Path plain(const Path& file) {
  std::error_code ignored;
  const Path whole = std::filesystem::absolute(kds::io::past_dangling_links(file), ignored);
  return std::filesystem::weakly_canonical(whole, ignored);
}

/// Whether to write to one is to change the other. A device or a pipe may be written to by several.
bool same_file(const Path& a, const Path& b) {
  if (a.empty() || b.empty()) return false;
  if (a == "-" || b == "-") return a == b;
  std::error_code ignored;
  if (std::filesystem::is_other(a, ignored)) return false;
  return std::filesystem::equivalent(a, b, ignored) || plain(a) == plain(b);
}

/// Whether a file is one of those that are numbered.
bool is_one_of(const Path& file, const FileName& numbered) {
  std::string name = file.string();
  if (!name.ends_with(numbered.ending)) return false;
  name.resize(name.size() - numbered.ending.size());
  const std::string number = Path(name).extension().string();
  const bool is_number = number.size() > 1 && number.find_first_not_of("0123456789", 1) == std::string::npos;
  return is_number && same_file(file, numbered.file.string() + number + numbered.ending);
}

bool clash(const FileName& a, const FileName& b) {
  if (a.numbered && b.numbered) return a.ending == b.ending && same_file(a.file, b.file);
  if (b.numbered) return clash(b, a);
  if (a.numbered) return is_one_of(b.file, a) || is_one_of(plain(b.file), a);
  return same_file(a.file, b.file);
}

std::vector<FileName> files_written(const Arguments& arguments) {
  std::vector<FileName> files;
  const auto add = [&](const char* option, const Path& file) {
    if (!file.empty()) files.push_back({option, file});
  };
  add("--events", arguments.events);
  add("--stats", arguments.stats);
  add("--view", arguments.view);
  add("--gltf", arguments.gltf);
  add("--vtk", arguments.vtk);
  if (!arguments.vtk.empty()) add("--vtk", kds::io::frames_folder(arguments.vtk));
  add("--checkpoint", arguments.checkpoint);
  const bool in_parts = !arguments.checkpoint.empty();
  if (arguments.events_apart) {
    files.push_back({"--events", arguments.events, true});
    if (in_parts) files.push_back({"--events", arguments.events, true, ".unfinished"});
  } else if (in_parts && !arguments.events.empty()) {
    add("--events", kds::io::unfinished_path(arguments.events));
  }
  if (!in_parts) return files;
  add("--checkpoint", kds::io::unfinished_path(arguments.checkpoint));
  add("--checkpoint", kds::io::lock_path(arguments.checkpoint));
  for (const char* const turn : {".a", ".b"}) {
    for (const char* const ending : {"", ".unfinished"}) {
      files.push_back({"--checkpoint", arguments.checkpoint + turn, true, ending});
    }
  }
  return files;
}

std::vector<FileName> files_read(const Arguments& arguments, const kds::io::Scene* scene) {
  std::vector<FileName> files{{"SCENE", arguments.scene}};
  if (!arguments.merge.empty()) files.push_back({"--merge-events", arguments.merge, true});
  if (!scene) return files;
  const Path folder = Path(arguments.scene).parent_path();
  for (const kds::io::SceneSource& source : scene->sources) {
    if (!source.where.empty()) files.push_back({source.where + " of the scene", folder / source.file});
  }
  return files;
}

}  // namespace

void check_files_differ(const Arguments& arguments, const kds::io::Scene* scene) {
  std::vector<FileName> files = files_read(arguments, scene);
  for (FileName& output : files_written(arguments)) {
    for (const FileName& other : files) {
      if (!clash(output, other)) continue;
      throw ArgumentError(output.option + ": " + (output.numbered ? "a part of it is" : "is") + " the same file as " +
                          (other.numbered ? "a part of " : "") + other.option);
    }
    files.push_back(std::move(output));
  }
}

}  // namespace kds_collide
