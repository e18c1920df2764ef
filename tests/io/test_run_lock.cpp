#include "io/output_file.hpp"
#include "io/run_lock.hpp"
#include "tests/io/temporary_folder.hpp"
#include "tests/support/throws.hpp"

#include <catch2/catch.hpp>

#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <optional>
#include <string>

namespace test_run_lock {

using namespace kds::io;
using kds::io::tests::TemporaryFolder;

namespace {

void require_locked(const std::filesystem::path& file) {
  kds::tests::throws<OutputError>([&] { RunLock(file, 0); },
                                          file.string() + ": file: is written by another run, which has not ended");
}

}  // namespace

TEST_CASE("RunLock: a second run is refused while any process of the first one is there", "[io]") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "run.state";
  std::optional<RunLock> first(std::in_place, file, 0), second(std::in_place, file, 1), third(std::in_place, file, 2);
  require_locked(file);
  first->share(), third->share(), second->share();
  require_locked(file);
  first.reset();
  require_locked(file);
  third.reset();
  require_locked(file);
  second.reset();
  RunLock next(file, 0);
  require_locked(file);
}

TEST_CASE("RunLock: the file is removed by process 0, and one that is left keeps no one away", "[io]") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "run.state";
  {
    RunLock first(file, 0), second(file, 1);
    first.share(), second.share();
    second.remove();
    REQUIRE(std::filesystem::exists(lock_path(file)));
    first.remove();
    REQUIRE(folder.file_count() == 0);
    RunLock next(file, 0);
    REQUIRE(std::filesystem::exists(lock_path(file)));
  }
  REQUIRE(folder.file_count() == 1);
  RunLock again(file, 0);
}

TEST_CASE("RunLock: a process that is killed gives its share back", "[io]") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "run.state";
  int ready[2];
  REQUIRE(pipe(ready) == 0);
  const pid_t child = fork();
  if (child == 0) {
    RunLock lock(file, 0);
    lock.share();
    if (write(ready[1], "x", 1) != 1) _exit(1);
    for (;;) pause();
  }
  char letter = 0;
  REQUIRE(read(ready[0], &letter, 1) == 1);
  require_locked(file);
  kill(child, SIGKILL);
  REQUIRE(waitpid(child, nullptr, 0) == child);
  RunLock next(file, 0);
  close(ready[0]), close(ready[1]);
}

TEST_CASE("RunLock: a link and the file it leads to have one lock", "[io]") {
  const TemporaryFolder folder;
  folder.write("run.state", "");
  std::filesystem::create_symlink(folder / "run.state", folder / "link");
  RunLock first(folder / "link", 0);
  require_locked(folder / "run.state");
}

TEST_CASE("RunLock: no file can be made", "[io]") {
  const TemporaryFolder folder;
  kds::tests::throws<OutputError>([&] { RunLock(folder / "missing" / "run.state", 0); },
                                          "run.state.lock: file: cannot be written: No such file or directory");
}

}  // namespace test_run_lock
