// The shares that several processes have of a scene: together they are the scene.
#include "collision/parallel/processes.hpp"
#include "io/body_table.hpp"
#include "io/run.hpp"
#include "io/scene_reader.hpp"
#include "tests/collision/parallel/thread_processes.hpp"
#include "tests/io/temporary_folder.hpp"
#include "tests/support/throws.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace test_scene_share {

using namespace kds::io;
using kds::io::tests::TemporaryFolder;

namespace {

BodyTable balls(std::size_t rows, double y) {
  BodyTable table;
  for (std::size_t i = 0; i < rows; ++i) {
    const double x = 3 * static_cast<double>(i);
    table.position.emplace_back(x, y, 0);
    table.velocity.emplace_back(i % 2 == 0 ? 1 : -1, 0.25, 0);
    table.radius.push_back(1);
    table.start.push_back(0.5 - 0.125 * static_cast<double>(i % 3));
  }
  return table;
}

/// Two bodies that are listed, and tables of 10 and of 3 rows.
std::filesystem::path scene_in(const TemporaryFolder& folder) {
  const std::string listed = R"({"name": "a", "shape": {"sphere": {"radius": 1}},
    "motion": [{"start": 2, "position": [[0, 100, 0]]}]}, {"name": "c", "shape": {"sphere": {"radius": 1}},
    "motion": [{"start": 2, "position": [[0, 200, 0], [0, 0, 1]]}]})";
  folder.write("b.h5", to_hdf5(balls(10, 0)));
  folder.write("d.h5", to_hdf5(balls(3, 20)));
  return folder.write("scene.json", R"({"scene": 1, "end_time": 3, "response": "elastic", "bodies": [)" + listed +
                                        R"(], "tables": [{"file": "b.h5", "prefix": "b"},
                                           {"file": "d.h5", "prefix": "row"}]})");
}

/// HDF5 is for one thread at a time.
std::vector<Scene> shares_of(const std::filesystem::path& file, std::size_t processes) {
  std::vector<Scene> shares;
  for (std::size_t rank = 0; rank < processes; ++rank) shares.push_back(read_share(file, {}, rank, processes));
  return shares;
}

}  // namespace

TEST_CASE("share of a scene: all together are its bodies, in their order, and each knows all names") {
  const TemporaryFolder folder;
  const auto file = scene_in(folder);
  const Scene whole = read_scene(file);
  CHECK_FALSE(whole.is_share());
  REQUIRE(whole.size() == 15);
  for (const std::size_t processes : {1u, 2u, 3u, 7u, 20u}) {
    std::size_t next = 0;
    for (std::size_t rank = 0; rank < processes; ++rank) {
      INFO("process " << rank << " of " << processes);
      const Scene share = read_share(file, 2.5, rank, processes);
      CHECK(share.is_share() == (processes > 1));
      CHECK(share.size() == 15);
      CHECK(share.end_time == 2.5);
      CHECK((!share.is_share() || share.share.first == next));
      for (const SceneBody& body : share.bodies) {
        REQUIRE(body.name == whole.bodies[next].name);
        REQUIRE(body.motion.front().path == whole.bodies[next++].motion.front().path);
      }
      for (std::size_t number = 0; number < 15; ++number) REQUIRE(share.name_of(number) == whole.name_of(number));
    }
    CHECK(next == 15);
  }
}

TEST_CASE("share of a scene: what is about all bodies is known when all have theirs") {
  const TemporaryFolder folder;
  const auto file = scene_in(folder);
  BodyTable falling = balls(3, 20);
  falling.acceleration.assign(3, Eigen::Vector3d::Zero());
  falling.acceleration[2][2] = -1;
  falling.start[0] = -7;
  folder.write("d.h5", to_hdf5(falling));
  auto shares = shares_of(file, 5);
  kds::collision::tests::ThreadProcesses(5).run([&](kds::collision::Processes& processes) {
    kds::collision::Team team(&processes);
    Scene& share = shares[team.rank()];
    complete(share, file, team);
    if (share.begin_time != -7 || share.degree() != 2) throw std::runtime_error("begin or degree is wrong");
    share.end_time = -8;
    std::string what;
    try {
      complete(share, file, team);
    } catch (const SceneError& error) {
      what = error.what();
    }
    if (what.find("end_time: must be >= -7, where the motion begins") == std::string::npos) {
      throw std::runtime_error("an end before the begin is not refused: " + what);
    }
  });
}

TEST_CASE("share of a scene: what is wrong with a row is said by the process that has read it") {
  const TemporaryFolder folder;
  const auto file = scene_in(folder);
  BodyTable wrong = balls(10, 0);
  wrong.radius[7] = -1;
  folder.write("b.h5", to_hdf5(wrong));
  // Of 15 bodies row 7 of the first table is body 9.
  CHECK_NOTHROW(read_share(file, {}, 0, 3));
  kds::tests::throws<SceneError>([&] { read_share(file, {}, 1, 3); }, "tables[0].rows[7].radius: must be > 0");
  CHECK_NOTHROW(read_share(file, {}, 2, 3));
  // Rows of a column that is not used are none.
  wrong = balls(10, 0);
  wrong.mass.assign(10, 1);
  folder.write("b.h5", to_hdf5(wrong));
  CHECK(body_table_rows(folder / "b.h5") == 10);
  const BodyTable rows = read_body_table(folder / "b.h5", 4, 3);
  REQUIRE(rows.rows() == 3);
  CHECK(rows.position[0][0] == 12);
  CHECK(rows.mass.size() == 3);
  CHECK(rows.fixed.empty());
}

namespace {

/// What a sink is told, as text.
struct Lines final : EventSink {
  std::string text;
  void on_event(const Event& event) override {
    text += std::to_string(event.time) + ' ' + std::to_string(event.a) + ' ' + std::to_string(event.b) + '\n';
  }
};

}  // namespace

TEST_CASE("share of a scene: runs of shares have the events of the scene, and goes on from their checkpoints") {
  const TemporaryFolder folder;
  const auto file = scene_in(folder);
  Lines right;
  const Scene whole = read_scene(file);
  run(whole, {}, right);
  CHECK(std::count(right.text.begin(), right.text.end(), '\n') > 10);
  for (const bool resumes : {false, true}) {
    kds::Snapshot half;
    std::vector<std::vector<char>> coming, blocks;
    Lines told;
    std::mutex mutex;
    auto shares = shares_of(file, 3);
    kds::collision::tests::ThreadProcesses(3).run([&](kds::collision::Processes& processes) {
      kds::collision::Team team(&processes);
      Scene& share = shares[team.rank()];
      complete(share, file, team);
      Lines lines;
      RunOptions options{.domains = 3, .processes = &processes};
      options.checkpoint_every = 1;
      options.checkpoint_bodies = [&](std::vector<char> block) {
        const std::scoped_lock lock(mutex);
        coming.push_back(std::move(block));
      };
      options.checkpoint = [&](const kds::Snapshot& state, double /*time*/) {
        const std::scoped_lock lock(mutex);
        if (team.rank() == 0) half = state, blocks = std::exchange(coming, {});
      };
      const RunResult result = run(share, options, lines);
      if (result.bodies != 15) throw std::runtime_error("the number of bodies is wrong");
      if (team.rank() == 0) told = lines;
      if (!resumes) return;
      team.of_first(0);
      const kds::Snapshot from = half;
      options.resume = &from, options.checkpoint_every = 0;
      options.resume_bodies = [&, next = team.rank()](std::vector<char>& block) mutable {
        if (next >= blocks.size()) return false;
        block = blocks[next];
        next += 3;
        return true;
      };
      Lines later;
      run(share, options, later);
      if (team.rank() == 0 && (later.text.empty() || !right.text.ends_with(later.text))) {
        throw std::runtime_error("what goes on has other events");
      }
    });
    CHECK(told.text == right.text);
  }
  Lines none;
  const Scene share = read_share(file, {}, 0, 2);
  kds::tests::throws([&] { run(share, {}, none); }, "run: it is a share of a scene");
}

}  // namespace test_scene_share
