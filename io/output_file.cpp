#include "io/output_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

namespace kds::io {
namespace {

using std::filesystem::file_type;

/// Names of the temporary files now open, where a signal handler can read them: it may neither lock nor allocate.
constexpr std::size_t most_files = 8;
std::array<std::atomic<char*>, most_files> open_temporaries{};

/// Temporary files of one name that processes which were killed may have left: looked past.
constexpr int most_left = 1000;

extern "C" void remove_temporaries(int signal) {
  for (const auto& name : open_temporaries) {
    if (const char* file = name.load()) unlink(file);
  }
  std::signal(signal, SIG_DFL);
  raise(signal);
}

int remember(const std::string& name) {
  for (std::size_t slot = 0; slot < most_files; ++slot) {
    if (open_temporaries[slot].load()) continue;
    open_temporaries[slot] = strdup(name.c_str());
    return static_cast<int>(slot);
  }
  return -1;
}

void forget(int slot) {
  if (slot >= 0) std::free(open_temporaries[static_cast<std::size_t>(slot)].exchange(nullptr));
}

}  // namespace

void remove_temporaries_at_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGQUIT, SIGXCPU}) {
    // What is ignored stays so: nohup.
    if (std::signal(signal, remove_temporaries) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow further is an error of writing, as a full disk is
}

std::filesystem::path past_dangling_links(const std::filesystem::path& path) {
  std::error_code ignored;
  std::filesystem::path file = path;
  while (std::filesystem::is_symlink(file, ignored) &&
         std::filesystem::status(file, ignored).type() == file_type::not_found) {
    file = file.parent_path() / std::filesystem::read_symlink(file, ignored);
  }
  return file;
}

OutputFile::OutputFile(const std::string& path) : path_(path), target_(past_dangling_links(path)) {
  if (path_ == "-") {
    file_ = stdout;
    return;
  }
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(target_, error);
  const file_type kind = status.type();
  if (kind == file_type::directory) fail(EISDIR, true);
  if (kind != file_type::regular && kind != file_type::not_found) {
    file_ = std::fopen(path_.c_str(), "wb");
    if (!file_) fail(errno, true);
    return;
  }
  const bool replaces = kind == file_type::regular;
  if (replaces) {
    if (access(path_.c_str(), W_OK) != 0) fail(errno, true);
    target_ = std::filesystem::canonical(target_, error);
    if (error) fail(error.value(), true);
  }
  const mode_t mode = replaces ? static_cast<mode_t>(status.permissions() & std::filesystem::perms::all) : 0666;
  // A process of the same number, in a container perhaps, may have left one when it was killed.
  const std::string part = target_.string() + ".part-" + std::to_string(getpid());
  int descriptor = -1, reason = EEXIST;
  for (int others = 0; descriptor < 0 && reason == EEXIST && others < most_left; ++others) {
    temporary_ = others == 0 ? part : part + "-" + std::to_string(others);
    descriptor = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    reason = errno;
  }
  if (descriptor < 0) {
    temporary_.clear();
    fail(reason, true);
  }
  if (replaces) fchmod(descriptor, mode);  // which the umask may have narrowed
  slot_ = remember(temporary_.string());
  file_ = fdopen(descriptor, "wb");
}

OutputFile::OutputFile(const std::string& path, std::uint64_t from)
    : path_(path), target_(past_dangling_links(path)), stays_(from > 0), goes_on_(true) {
  const std::filesystem::path unfinished = target_.string() + ".unfinished";
  const auto refuse = [&](const std::string& why) {
    throw OutputError(unfinished.string() + ": file: cannot be gone on with: " + why, true);
  };
  std::error_code error;
  const file_type kind = std::filesystem::status(target_, error).type();
  if (kind != file_type::regular && kind != file_type::not_found) fail(EINVAL, true);
  file_ = std::fopen(unfinished.c_str(), from > 0 ? "r+b" : "wbx");
  if (!file_) {
    const int reason = errno;
    if (from > 0) refuse(std::strerror(reason));
    if (reason != EEXIST) fail(reason, true);
    throw OutputError(unfinished.string() + ": file: is there already, of a run that has not ended", true);
  }
  temporary_ = unfinished;
  if (from == 0) {
    slot_ = remember(unfinished);
    return;
  }
  const std::uintmax_t size = std::filesystem::file_size(unfinished, error);
  if (error || size < from) {
    refuse("it has " + std::to_string(error ? 0 : size) + " bytes, and the run had written " + std::to_string(from));
  }
  std::filesystem::resize_file(unfinished, from, error);
  if (error) refuse(error.message());
  std::fseek(file_, 0, SEEK_END);
}

OutputFile::~OutputFile() {
  if (file_ && file_ != stdout) std::fclose(file_);
  if (!temporary_.empty() && !stays_) {
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
  }
  forget(slot_);
}

void OutputFile::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail(errno);
}

std::uint64_t OutputFile::flush() {
  if (std::fflush(file_) != 0) fail(errno);
  if (goes_on_ && !stays_) {
    stays_ = true;
    forget(std::exchange(slot_, -1));
  }
  return static_cast<std::uint64_t>(std::ftell(file_));
}

void OutputFile::close() {
  if (!file_) return;
  if (std::fflush(file_) != 0) fail(errno);
  if (file_ == stdout) return;
  std::FILE* file = file_;
  file_ = nullptr;
  if (std::fclose(file) != 0) fail(errno);
}

void OutputFile::commit() {
  close();
  if (temporary_.empty()) return;
  std::error_code error;
  std::filesystem::rename(temporary_, target_, error);
  if (error) fail(error.value());
  temporary_.clear();
}

void OutputFile::fail(int error, bool on_opening) const {
  throw OutputError(path_ + ": file: cannot be written: " + std::strerror(error), on_opening);
}

}  // namespace kds::io
