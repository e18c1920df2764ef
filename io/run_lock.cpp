#include "io/run_lock.hpp"

#include "io/output_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

namespace kds::io {
namespace {

// Locks of an open file, where the system has them: those of a process are lost when any of its threads closes the
// file.
#ifdef F_OFD_SETLK
constexpr int try_to_lock = F_OFD_SETLK, wait_to_lock = F_OFD_SETLKW;
#else
constexpr int try_to_lock = F_SETLK, wait_to_lock = F_SETLKW;
#endif

constexpr std::size_t to_the_end = 0;  // as a number of bytes, for fcntl()

}  // namespace

std::filesystem::path lock_path(const std::filesystem::path& file) { return resolved(file).string() + ".lock"; }

RunLock::RunLock(const std::filesystem::path& file, std::size_t rank) : path_(lock_path(file)), rank_(rank) {
  open();
  if (rank_ > 0) return;
  for (;;) {
    if (!lock(0, to_the_end, F_WRLCK, false)) {
      close(descriptor_);
      throw OutputError(file.string() + ": file: is written by another run, which has not ended", true);
    }
    // A run that has ended meanwhile may have removed the file that was opened here.
    struct stat opened {};
    struct stat there {};
    if (fstat(descriptor_, &opened) == 0 && stat(path_.c_str(), &there) == 0 && opened.st_ino == there.st_ino &&
        opened.st_dev == there.st_dev) {
      return;
    }
    close(descriptor_);
    open();
  }
}

RunLock::~RunLock() { close(descriptor_); }

void RunLock::open() {
  descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) {
    throw OutputError(path_.string() + ": file: cannot be written: " + std::strerror(errno), true);
  }
}

void RunLock::share() {
  if (rank_ == 0) {
    lock(1, to_the_end, F_UNLCK, false);
  } else {
    lock(rank_, 1, F_WRLCK, true);
  }
}

void RunLock::remove() {
  if (rank_ == 0) unlink(path_.c_str());
}

/// Of `count` bytes from `first` on. False if another process holds some of them.
bool RunLock::lock(std::size_t first, std::size_t count, short kind, bool waits) const {
  struct flock bytes {};
  bytes.l_type = kind;
  bytes.l_whence = SEEK_SET;
  bytes.l_start = static_cast<off_t>(first);
  bytes.l_len = static_cast<off_t>(count);
  int result = 0;
  do {
    result = fcntl(descriptor_, waits ? wait_to_lock : try_to_lock, &bytes);
  } while (result != 0 && errno == EINTR);
  return result == 0 || (errno != EAGAIN && errno != EACCES);
}

}  // namespace kds::io
