#include "tests/benchmarks/features/query_files.hpp"

#include <catch2/catch.hpp>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace test_query_files {
namespace {

using namespace kds;
using namespace kds::tests;
using benchmarks::read_queries;

/// A folder of its own that goes away again.
struct Folder {
  std::filesystem::path path = std::filesystem::temp_directory_path() / ("kds_queries_" + std::to_string(::getpid()));
  Folder() { std::filesystem::create_directories(path / "scene" / "vertex-face"); }
  ~Folder() { std::filesystem::remove_all(path); }
  void write(const char* name, const std::string& text) const {
    std::filesystem::create_directories((path / name).parent_path());
    std::ofstream(path / name) << text;
  }
};

const std::string query =
    "1,4,1,4,1,1,1\n0,1,0,1,0,1,1\n1,1,0,1,0,1,1\n0,1,1,1,0,1,1\n"
    "1,4,1,4,-3,2,1\n0,1,0,1,0,1,1\n1,1,0,1,0,1,1\n0,1,1,1,0,1,1\n";

}  // namespace

TEST_CASE("files of queries are read as the exact numbers they hold", "[query_files]") {
  const Folder folder;
  folder.write("scene/vertex-face/0.csv", query + query);
  folder.write("scene/edge-edge/0.csv", query);
  folder.write("scene/other.csv", "not a query");
  std::size_t left_out = 9;
  const auto queries = read_queries(folder.path, left_out);
  REQUIRE(queries.size() == 3);
  CHECK(left_out == 0);
  CHECK(queries[0].kind == Features::edge_edge);
  CHECK(queries[2].kind == Features::vertex_face);
  CHECK(queries[2].touches == true);
  CHECK(queries[2].ends[0][0] == Eigen::Vector3d(0.25, 0.25, 1));
  CHECK(queries[2].ends[1][0] == Eigen::Vector3d(0.25, 0.25, -1.5));
  CHECK(queries[2].ends[1][3] == Eigen::Vector3d(0, 1, 0));
}

TEST_CASE("numbers that are no doubles are left out, and broken files named", "[query_files]") {
  const Folder folder;
  std::size_t left_out = 0;
  folder.write("vertex-face/0.csv", "1,3" + query.substr(3) + query);
  CHECK(read_queries(folder.path, left_out).size() == 1);
  CHECK(left_out == 1);
  folder.write("vertex-face/0.csv", query + "1,1,1,1,1,1,1\n");
  CHECK_THROWS_WITH(read_queries(folder.path, left_out), Catch::Contains("0.csv") && Catch::Contains("within a query"));
  folder.write("vertex-face/0.csv", "1,1,1,1,1,1\n");
  CHECK_THROWS_WITH(read_queries(folder.path, left_out), Catch::Contains("0.csv:1: seven numbers"));
  folder.write("vertex-face/0.csv", "1,0,1,1,1,1,1\n");
  CHECK_THROWS_WITH(read_queries(folder.path, left_out), Catch::Contains("denominator 0"));
  folder.write("vertex-face/0.csv", "1,1,1,1,1,1,2\n");
  CHECK_THROWS_WITH(read_queries(folder.path, left_out), Catch::Contains("must be 0 or 1"));
}

}  // namespace test_query_files
