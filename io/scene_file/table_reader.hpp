// Tables of bodies that a scene names.
#pragma once

#include "io/scene.hpp"
#include "io/scene_file/json_node.hpp"

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace kds::io {

/// Rows of a table: of one that is read whole all, from 0 on.
struct TableRows {
  std::size_t first = 0;
  std::optional<std::size_t> wanted{};
};

/// A table that has been read: its rows are bodies of the scene, one after another.
struct ReadTable {
  std::string path;           ///< of it in the scene
  std::string file;           ///< as written in the scene
  std::string prefix;         ///< of the names of its bodies, which end with their rows
  std::size_t rows = 0;       ///< that it has
  std::size_t first_row = 0;  ///< of those that have been read
  std::size_t rows_read = 0;  ///< all, but in a share of a scene
  std::size_t first = 0;      ///< the place in Scene::bodies of the first
  bool has_friction = false;  ///< or tangential restitution

  /// Where what is wrong with a member of a row, as of a body, is to be found.
  std::string member_path(std::size_t row, const std::string& member) const;
};

/// Reads rows of the table that `node`, an element of the scene's "tables", names, relative to a folder, and appends
/// their bodies to the scene, and its file to scene.sources. They have the surface of the scene where the table does
/// not say another. Throws JsonError.
ReadTable read_table(const JsonNode& node, const std::filesystem::path& folder, const SurfaceNumbers& of_scene,
                     const TableRows& rows, Scene& scene);
/// How many rows that table has. Throws JsonError.
std::size_t rows_of_table(const JsonNode& node, const std::filesystem::path& folder);

/// That no two bodies have the same name; `names` are those of bodies that are in no table, with their paths. Throws
/// JsonError.
void check_names(const std::vector<ReadTable>& tables, const std::map<std::string, std::string>& names);

}  // namespace kds::io
