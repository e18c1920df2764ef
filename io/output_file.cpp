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

/// What a signal handler writes: one of two lines, so that the one which it may be reading is not changed.
struct LastLine {
  std::string text;
  bool (*may_say)() = nullptr;
};
std::array<LastLine, 2> last_lines;
std::atomic<const LastLine*> last_line = nullptr;

/// Temporary files of one name that processes which were killed may have left: looked past.
constexpr int most_left = 1000;

/// Waits until what is in a file is on the disk, where the system can. Returns the error, 0 if there is none.
int sync_file(int descriptor) {
#if defined(_POSIX_FSYNC) && _POSIX_FSYNC > 0
  if (fsync(descriptor) != 0 && errno != EINVAL) return errno;  // EINVAL: this file system has nothing to wait for.
#else
  static_cast<void>(descriptor);
#endif
  return 0;
}

/// The same of the names in the folder of a file; what a file system does not offer is no error.
void sync_folder_of(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const int descriptor = open(folder.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  sync_file(descriptor);
  ::close(descriptor);
}

extern "C" void remove_temporaries(int signal) {
  for (const auto& name : open_temporaries) {
    if (const char* file = name.load()) unlink(file);
  }
  if (const LastLine* const line = last_line.exchange(nullptr); line && (!line->may_say || line->may_say())) {
    static_cast<void>(!write(STDERR_FILENO, line->text.data(), line->text.size()));  // nothing can be done about it
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

void say_at_signals(std::string line, bool (*may_say)()) {
  LastLine& next = last_lines[last_line == &last_lines[0] ? 1 : 0];
  if (!line.empty()) line += '\n';
  next = {std::move(line), may_say};
  last_line = next.text.empty() ? nullptr : &next;
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

std::filesystem::path resolved(const std::filesystem::path& path) {
  const std::filesystem::path target = past_dangling_links(path);
  std::error_code error;
  if (!std::filesystem::is_symlink(target, error)) return target;
  const std::filesystem::path end = std::filesystem::canonical(target, error);
  return error ? target : end;
}

std::filesystem::path unfinished_path(const std::string& path) { return resolved(path).string() + ".unfinished"; }

std::filesystem::path begun_path(const std::string& path) {
  std::error_code ignored;
  const std::filesystem::path unfinished = unfinished_path(path), whole = resolved(path);
  const bool has_ended =
      !std::filesystem::exists(unfinished, ignored) && std::filesystem::is_regular_file(whole, ignored);
  return has_ended ? whole : unfinished;
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

OutputFile::OutputFile(const std::string& path, std::optional<std::uint64_t> from)
    : path_(path), target_(resolved(path)), goes_on_(true) {
  std::error_code error;
  const file_type kind = std::filesystem::status(target_, error).type();
  if (kind == file_type::directory) fail(EISDIR, true);
  if (kind != file_type::regular && kind != file_type::not_found) {
    throw OutputError(path_ + ": file: cannot be that of a run in parts: it is a pipe or a device", true);
  }
  const std::filesystem::path unfinished = unfinished_path(path);
  const std::filesystem::path begun = from.value_or(0) > 0 ? begun_path(path) : unfinished;
  if (from) file_ = std::fopen(begun.c_str(), "r+b");
  if (file_) {
    stays_ = true;
    drops_from_ = from;
    temporary_ = unfinished;
    const std::uintmax_t size = std::filesystem::file_size(begun, error);
    if (!error && size >= *from) return;
    std::fclose(std::exchange(file_, nullptr));
    refuse_to_go_on("it has " + std::to_string(error ? 0 : size) + " bytes, and the run had written " +
                    std::to_string(*from));
  }
  if (from.value_or(0) > 0) refuse_to_go_on(std::strerror(errno));
  file_ = std::fopen(unfinished.c_str(), "wbx");
  if (!file_) {
    if (errno != EEXIST) fail(errno, true);
    throw OutputError(unfinished.string() + ": file: is there already, of a run that has not ended", true);
  }
  temporary_ = unfinished;
  slot_ = remember(unfinished);
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
  if (drops_from_) drop();
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail(errno);
}

/// The file has its place, and what was written before the state from which the run goes on.
void OutputFile::drop() {
  const std::uint64_t from = *std::exchange(drops_from_, std::nullopt);
  std::error_code error;
  if (!std::filesystem::exists(temporary_, error)) std::filesystem::rename(target_, temporary_, error);
  if (error) fail(error.value());
  if (ftruncate(fileno(file_), static_cast<off_t>(from)) != 0 || fseeko(file_, 0, SEEK_END) != 0) fail(errno);
}

void OutputFile::sync() {
  if (std::fflush(file_) != 0) fail(errno);
  if (const int error = sync_file(fileno(file_))) fail(error);
}

std::uint64_t OutputFile::flush() {
  if (drops_from_) drop();
  if (goes_on_) {
    sync();
    if (!std::exchange(stays_, true)) sync_folder_of(temporary_);
    forget(std::exchange(slot_, -1));
  }
  if (std::fflush(file_) != 0) fail(errno);
  return static_cast<std::uint64_t>(ftello(file_));
}

void OutputFile::close() {
  if (!file_) return;
  if (drops_from_) drop();
  if (std::fflush(file_) != 0) fail(errno);
  if (file_ == stdout) return;
  if (goes_on_) sync();
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
  if (goes_on_) sync_folder_of(target_);
}

void OutputFile::refuse_to_go_on(const std::string& why) const {
  throw OutputError(begun_path(path_).string() + ": file: cannot be gone on with: " + why, true);
}

void OutputFile::fail(int error, bool on_opening) const {
  throw OutputError(path_ + ": file: cannot be written: " + std::strerror(error), on_opening);
}

}  // namespace kds::io
