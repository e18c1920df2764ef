// A file that is there whole or not at all.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace kds::io {

/// Cannot be written; the message is one line `FILE: file: what is wrong`.
struct OutputError : std::runtime_error {
  OutputError(const std::string& line, bool when_opening) : std::runtime_error(line), on_opening(when_opening) {}
  bool on_opening;  ///< so the name is wrong; else the disk is full or failing
};

/// Where `path` leads if it is a symbolic link to a file that is not there yet; else `path`.
std::filesystem::path past_dangling_links(const std::filesystem::path& path);

/// Where `path` leads if it is a symbolic link, to a file that is there or not; else `path`.
std::filesystem::path resolved(const std::filesystem::path& path);

/// Where a file is until it is whole that takes several runs to write: `path` with ".unfinished" after it.
std::filesystem::path unfinished_path(const std::string& path);
/// Where that is which a run has written that is to be gone on with: there, or in the place of the whole file, if the
/// run has come so far.
std::filesystem::path begun_path(const std::string& path);

/// So many bytes of a file, from its beginning on.
struct FilePlace {
  std::uint64_t bytes = 0;
  std::uint64_t checksum = 0;  ///< of these bytes; who writes the file says which
};

/// For programs, not for libraries in them: from now on temporary files of OutputFile, up to 8 at a time, are removed
/// when the process is told to stop (SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU) or nobody reads its standard output any
/// more (SIGPIPE); a file that grows beyond a limit (SIGXFSZ, ignored) is an error like any other.
void remove_temporaries_at_signals();
/// From now on such a signal also writes this line to standard error, if it is not empty and `may_say`, if there is
/// one, returns true: it is called by the signal handler.
void say_at_signals(std::string line, bool (*may_say)() = nullptr);

/// Writes to a temporary file beside the one that `path` leads to; commit() renames it, and until then nothing is
/// there, or what was there before. Destroyed without commit(), the temporary file is removed. "-" is standard output;
/// it, pipes and devices are written directly. Links stay links. A file that was there leaves its permissions to the
/// new one, but not its owner or its other names (hard links).
///
/// All members but the destructor throw OutputError.
class OutputFile {
 public:
  explicit OutputFile(const std::string& path);
  /// One that may take several runs to write: to unfinished_path(), which stays if the run ends between flush() and
  /// commit(), so that a later one can go on; what no flush() tells of is removed. What flush() and commit() tell of is
  /// on the disk, too, and outlasts a power cut. `from`: of a run that begins nothing, and there must be no such file.
  /// Of one that goes on so many bytes of what there is are kept, and what follows them is dropped, by the first
  /// write(), flush() or close(): until then nothing is changed. If 0, there may be nothing.
  OutputFile(const std::string& path, std::optional<std::uint64_t> from);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view text);
  /// Ends the writing, and throws if it failed. Called of several files before the first commit(), it makes all of them
  /// appear or none, but for a rename that fails in between: a folder that others have meanwhile changed.
  void close();
  void commit();
  /// How many bytes have been written; they are in the file, whatever happens to this process.
  std::uint64_t flush();
  /// Of a run that has begun, and does not get as far as a state to go on from: what flush() told of is removed, too.
  void discard() { stays_ = false; }
  /// Throws OutputError: what there is of a file that takes several runs to write is not what it should be.
  [[noreturn]] void refuse_to_go_on(const std::string& why) const;

 private:
  void drop();
  void sync();
  [[noreturn]] void fail(int error, bool on_opening = false) const;

  std::string path_;
  std::filesystem::path target_;               ///< path_, with symbolic links resolved
  std::filesystem::path temporary_;            ///< empty where path_ is written directly
  bool stays_ = false;                         ///< the temporary file, if there is no commit()
  bool goes_on_ = false;                       ///< a later run may go on with it
  std::optional<std::uint64_t> drops_from_{};  ///< nothing has been changed: what is from here on is to be dropped
  std::FILE* file_ = nullptr;
  int slot_ = -1;  ///< of the names a signal removes
};

}  // namespace kds::io
