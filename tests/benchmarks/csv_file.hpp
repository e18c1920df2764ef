// Figures to a file and to the terminal.
#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace kds::benchmarks {

/// Opens folder/name for writing and makes the folder; throws std::runtime_error where that fails.
inline std::ofstream open_csv(const std::filesystem::path& folder, const std::string& name) {
  std::filesystem::create_directories(folder);
  std::ofstream file(folder / name);
  if (!file) throw std::runtime_error("cannot write " + (folder / name).string());
  return file;
}

/// One line to the file and to the terminal.
inline void tell(std::ofstream& file, const std::string& line) {
  file << line << std::flush;
  std::fputs(line.c_str(), stdout);
  std::fflush(stdout);
}

/// The same, as of printf.
inline void tell(std::ofstream& file, const char* format, auto value, auto... more) {
  char line[512];
  std::snprintf(line, sizeof line, format, value, more...);
  tell(file, std::string(line));
}

}  // namespace kds::benchmarks
