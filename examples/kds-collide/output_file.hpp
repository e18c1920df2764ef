// A file that is there whole or not at all.
#pragma once

#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace kds_collide {

/// Cannot be written; the message is one line `FILE: file: what is wrong`.
struct OutputError : std::runtime_error {
  OutputError(const std::string& line, bool when_opening) : std::runtime_error(line), on_opening(when_opening) {}
  bool on_opening;  ///< so the name is wrong; else the disk is full or failing
};

/// Writes to a temporary file beside `path`, which commit() renames; until then nothing is at `path`, or what was there
/// before. Destroyed without commit(), and when the process is told to stop (SIGINT, SIGTERM, SIGHUP) or nobody reads
/// its standard output any more (SIGPIPE), the temporary file is removed. "-" is standard output; it, pipes and devices
/// are written directly. A link to a file stays one; a link that leads nowhere is replaced.
///
/// All members but the destructor throw OutputError. Signals remove up to 8 files at a time.
class OutputFile {
 public:
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view text);
  /// Ends the writing, and throws if it failed. Called of several files before the first commit(), it makes all of them
  /// appear or none.
  void close();
  void commit();

 private:
  [[noreturn]] void fail(int error, bool on_opening = false) const;

  std::string path_;
  std::filesystem::path target_;     ///< path_; of a file that exists, with symbolic links resolved
  std::filesystem::path temporary_;  ///< empty where path_ is written directly
  std::FILE* file_ = nullptr;
  int slot_ = -1;  ///< of the names a signal removes
};

}  // namespace kds_collide
