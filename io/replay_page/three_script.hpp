// The scripts of three.js, which draw space on pages.
#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

namespace kds::io {

/// The text of a script below the folder of three.js, "build/three.min.js" for example; nothing if the folder's name is
/// empty or the script cannot be read.
inline std::optional<std::string> three_script(const std::filesystem::path& folder, const char* name) {
  std::ifstream in(folder / name, std::ios::binary);
  std::ostringstream text;
  if (folder.empty() || !in || !(text << in.rdbuf())) return std::nullopt;
  return std::move(text).str();
}

}  // namespace kds::io
