// That one run alone writes its files.
#pragma once

#include <cstddef>
#include <filesystem>

namespace kds::io {

/// Keeps other runs from the files of a run in parts: a process that was told to end may still be writing them when the
/// run is gone on with. It is a lock on the file FILE.lock, which lasts as long as the processes do that hold it; a
/// lock file which nobody holds keeps no one away. Of several processes each holds a share, made in two steps:
///
///     RunLock lock(file, rank);  // in process 0, and when that is done, in the others
///     lock.share();              // in all of them, in any order
///
/// Where a file system offers no locks, nothing is locked.
class RunLock {
 public:
  /// `file`: of the checkpoints. Process 0 takes the whole lock. Throws OutputError if a process of another run holds a
  /// share of it, or if there can be no file.
  RunLock(const std::filesystem::path& file, std::size_t rank);
  ~RunLock();
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;

  /// Process 0 keeps a share, and leaves the others to others. They wait for theirs.
  void share();
  /// The file is removed, in process 0. To be called when no process writes any more.
  void remove();

 private:
  void open();
  bool lock(std::size_t first, std::size_t count, short kind, bool waits) const;

  const std::filesystem::path path_;
  const std::size_t rank_;
  int descriptor_ = -1;
};

/// Where it is: `file` with ".lock" after it; if that is a symbolic link, beside what it leads to.
std::filesystem::path lock_path(const std::filesystem::path& file);

}  // namespace kds::io
