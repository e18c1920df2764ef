#include "io/output_file.hpp"
#include "tests/io/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <unistd.h>

#include <optional>
#include <string>

namespace test_output_file {

using namespace kds::io;
using kds::io::tests::read_file;
using kds::io::tests::TemporaryFolder;

TEST_CASE("output file: what was there stays until the new one is whole") {
  const TemporaryFolder folder;
  const std::string path = folder.write("a.txt", "old").string();
  {
    OutputFile file(path);
    file.write("new");
  }
  CHECK(read_file(path) == "old");
  CHECK(folder.file_count() == 1);
  OutputFile file(path);
  file.write("new");
  file.commit();
  CHECK(read_file(path) == "new");
  CHECK(folder.file_count() == 1);
}

TEST_CASE("output file: a symbolic link stays one, a device is written as it is") {
  const TemporaryFolder folder;
  const auto target = folder.write("a.txt", "old");
  std::filesystem::create_symlink(target, folder / "link.txt");
  OutputFile file((folder / "link.txt").string());
  file.write("new");
  file.commit();
  CHECK(std::filesystem::is_symlink(folder / "link.txt"));
  CHECK(read_file(target) == "new");

  OutputFile null("/dev/null");
  null.write("gone");
  null.commit();
  CHECK(std::filesystem::is_character_file("/dev/null"));
}

TEST_CASE("output file: a link that leads nowhere yet leads to the new file") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "below");
  std::filesystem::create_symlink("below/second", folder / "first");  // relative to the folder of the link
  std::filesystem::create_symlink("../a.txt", folder / "below/second");
  //   CHECK(past_dangling_links((folder / "first").string()) == folder / "below/../a.txt");
  OutputFile file((folder / "first").string());
  file.write("new");
  file.commit();
  CHECK(std::filesystem::is_symlink(folder / "first"));
  CHECK(std::filesystem::is_symlink(folder / "below/second"));
  CHECK(read_file(folder / "a.txt") == "new");
  CHECK(folder.file_count() == 3);

  std::filesystem::create_symlink("circle", folder / "circle");
  CHECK_THROWS_WITH(OutputFile((folder / "circle").string()), Catch::Contains("Too many levels of symbolic links"));
}

TEST_CASE("output file: who may read and write it stays as it was") {
  using std::filesystem::perms;
  const TemporaryFolder folder;
  const auto path = folder.write("a.txt", "old");
  const auto mode = GENERATE(perms{0600}, perms{0666}, perms{0755});
  std::filesystem::permissions(path, mode);
  OutputFile file(path.string());
  file.write("new");
  file.commit();
  CHECK(std::filesystem::status(path).permissions() == mode);
}

TEST_CASE("output file: a place that cannot be written is named") {
  const TemporaryFolder folder;
  const auto error = [](const std::string& path) {
    try {
      OutputFile file(path);
      return std::string("no error");
    } catch (const OutputError& e) {
      CHECK(e.on_opening);
      return std::string(e.what());
    }
  };
  const std::string missing = (folder / "none/a.txt").string();
  CHECK(error(missing) == missing + ": file: cannot be written: No such file or directory");
  CHECK(error((folder / "").string()) == (folder / "").string() + ": file: cannot be written: Is a directory");
}

TEST_CASE("output file: one that takes several runs stays unfinished, and is gone on with") {
  const TemporaryFolder folder;
  const std::string path = (folder / "a.txt").string(), unfinished = path + ".unfinished";
  std::uint64_t length = 0;
  {
    OutputFile file(path, std::nullopt);
    file.write("one,");
    length = file.flush();
    file.write("what is dropped");
  }
  CHECK(length == 4);
  CHECK(!std::filesystem::exists(path));
  CHECK(read_file(unfinished) == "one,what is dropped");
  CHECK_THROWS_WITH(OutputFile(path, std::nullopt),
                    unfinished + ": file: is there already, of a run that has not ended");
  CHECK_THROWS_WITH(OutputFile(path, 20), unfinished +
                                              ": file: cannot be gone on with: it has 19 bytes, and the run had "
                                              "written 20");
  {
    OutputFile file(path, length);
    file.write("two");
    CHECK(file.flush() == 7);
    file.commit();
  }
  CHECK(read_file(path) == "one,two");
  CHECK(folder.file_count() == 1);
  CHECK_THROWS_WITH(OutputFile("/dev/null", std::nullopt),
                    "/dev/null: file: cannot be that of a run in parts: it is a pipe or a device");
  const std::string below = (folder / "").string();
  CHECK_THROWS_WITH(OutputFile(below, std::nullopt), below + ": file: cannot be written: Is a directory");
  // One that was killed when this had its place, and other outputs had not.
  {
    const OutputFile file(path, 4);
    CHECK(read_file(path) == "one,two");  // Nothing is changed before something is written.
  }
  CHECK(read_file(path) == "one,two");
  OutputFile file(path, 4);
  file.write("2");
  file.commit();
  CHECK(read_file(path) == "one,2");
  CHECK(folder.file_count() == 1);
  std::filesystem::remove(path);
  CHECK_THROWS_WITH(OutputFile(path, 4), unfinished + ": file: cannot be gone on with: No such file or directory");
  folder.write("a.txt.unfinished", "left");
  { const OutputFile none(path, 0); }
  CHECK(read_file(unfinished) == "left");
  OutputFile(path, 0).commit();
  CHECK(read_file(path).empty());
}

TEST_CASE("output file: what a killed process of the same number has left is not in the way") {
  const TemporaryFolder folder;
  const std::string left = "a.txt.part-" + std::to_string(getpid());
  folder.write(left, "half");
  const std::string path = (folder / "a.txt").string();
  for (const char* text : {"one", "two"}) {
    OutputFile file(path);
    file.write(text);
    file.commit();
    CHECK(read_file(path) == text);
  }
  CHECK(read_file(folder / left) == "half");
  CHECK(folder.file_count() == 2);
}

TEST_CASE("output file: one that takes several runs is written where a link leads, before and after") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "below");
  std::filesystem::create_symlink("below/a.txt", folder / "link");
  const std::string path = (folder / "link").string();
  for (const char* text : {"one", "two"}) {
    OutputFile file(path, std::nullopt);
    CHECK(std::filesystem::exists(folder / "below/a.txt.unfinished"));
    file.write(text);
    file.commit();
    CHECK(read_file(folder / "below/a.txt") == text);
    CHECK(std::filesystem::is_symlink(path));
  }
}

TEST_CASE("output file: of several runs, what no state tells of does not stay") {
  const TemporaryFolder folder;
  {
    OutputFile file((folder / "a.txt").string(), std::nullopt);
    file.write("nothing goes on from this");
  }
  CHECK(folder.file_count() == 0);
}

}  // namespace test_output_file
