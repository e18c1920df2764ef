#include "io/body_table.hpp"
#include "io/checkpoint.hpp"
#include "io/event_csv.hpp"
#include "io/run.hpp"
#include "io/scene_reader.hpp"
#include "tests/collision/parallel/thread_processes.hpp"
#include "tests/io/temporary_folder.hpp"
#include "tests/support/throws.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace test_checkpoint {

using namespace kds::io;
using kds::io::tests::read_file;
using kds::io::tests::TemporaryFolder;

namespace {

/// Balls and a box that fall in a box, bounce, and come to rest; or, if they turn, a rod among them.
Scene falling(bool turning) {
  std::string bodies;
  for (int i = 0; i < 12; ++i) {
    const std::string name = std::to_string(i);
    const std::string place =
        std::to_string(1 + i % 3) + "," + std::to_string(1 + i / 3) + "," + std::to_string(2 + i % 4);
    bodies +=
        (i > 0 ? "," : "") + std::string(R"({"name": ")") + name + R"(", "restitution": 0.6, "shape": {"sphere": )" +
        R"({"radius": 0.4}}, "motion": [{"start": 0, "position": [[)" + place + "],[0." + name + ",0.3,0],[0,0,-5]]}]}";
  }
  bodies += R"(,{"name": "box", "restitution": 0.6, "shape": {"box": {"half_extents": [0.5,0.4,0.3]}}, "motion": )"
            R"([{"start": 0, "position": [[2,2,6],[0,0,-1],[0,0,-5]])" +
            std::string(turning ? R"(, "angular_velocity": [0,1,0]}], "inertia": 0.1})" : "}]}");
  return parse_scene(R"({"scene": 1, "end_time": 3, "response": "elastic", "domain": {"min": [0,0,0], "max": [5,6,9],
    "walls": "reflect", "restitution": 0.6}, "bodies": [)" +
                         bodies + "]}",
                     "scene.json");
}

/// The events as the file has them.
class Lines final : public EventSink {
 public:
  explicit Lines(const Scene& scene) : scene_(scene) {}
  void on_event(const Event& event) override { append_csv_line(text, event, scene_); }

  std::string text;

 private:
  const Scene& scene_;
};

std::size_t contacts_in(const std::string& lines) {
  std::size_t count = 0;
  for (std::size_t at = lines.find(",contact,"); at != std::string::npos; at = lines.find(",contact,", at + 1)) ++count;
  return count;
}

struct Number {
  double value = 7;
  template <class Archive>
  void archive(Archive& archive) {
    archive(value);
  }
};

struct State {
  kds::Snapshot world;
  std::size_t events;
};

struct InBlocks {
  State state;
  std::vector<std::vector<char>> blocks;
};

}  // namespace

TEST_CASE("checkpoint: a run that goes on from one has the events of the run that went through") {
  const bool turning = GENERATE(false, true);
  const Scene scene = falling(turning);
  Lines through(scene);
  RunOptions options;
  const RunResult all = run(scene, options, through);
  CHECK(all.contacts == contacts_in(through.text));

  Lines lines(scene);
  std::vector<State> states;
  options.checkpoint_every = 0.4;
  options.checkpoint = [&](const kds::Snapshot& world, double) { states.push_back({world, lines.text.size()}); };
  run(scene, options, lines);
  CHECK(lines.text == through.text);
  REQUIRE(states.size() == 7);
  int seen_in_blocks = 0;
  for (const State& state : states) {
    RunOptions on = options;
    on.checkpoint = [](const kds::Snapshot&, double) {};
    on.resume = &state.world;
    Lines rest(scene);
    const RunResult result = run(scene, on, rest);
    CHECK(rest.text == through.text.substr(state.events));
    CHECK(result.contacts == contacts_in(rest.text));
    CHECK(result.sim_seconds < 3);
    if (turning) continue;
    on.domains = 3;
    std::vector<std::vector<char>> blocks;
    std::vector<InBlocks> in_blocks;
    Lines divided(scene);
    on.checkpoint_bodies = [&](std::vector<char> block) { blocks.push_back(std::move(block)); };
    on.checkpoint = [&](const kds::Snapshot& world, double) {
      in_blocks.push_back({{world, divided.text.size()}, std::exchange(blocks, {})});
    };
    run(scene, on, divided);
    CHECK(divided.text == rest.text);
    for (const InBlocks& from : in_blocks) {
      if (from.blocks.empty()) continue;  // It was one world.
      ++seen_in_blocks;
      RunOptions last;
      last.resume = &from.state.world;
      last.resume_bodies = [&, next = from.blocks.begin()](std::vector<char>& block) mutable {
        if (next == from.blocks.end()) return false;
        block = *next++;
        return true;
      };
      Lines later(scene);
      run(scene, last, later);
      CHECK(later.text == divided.text.substr(from.state.events));
    }
  }
  if (!turning) CHECK(seen_in_blocks > 0);
}

TEST_CASE("checkpoint: of another scene, or other options, it is refused") {
  const Scene scene = falling(false);
  kds::Snapshot state;
  RunOptions options;
  std::vector<double> times;
  options.checkpoint_every = 1.25;
  options.checkpoint = [&](const kds::Snapshot& world, double time) { state = world, times.push_back(time); };
  EventSinks none;
  run(scene, options, none);
  CHECK(times == std::vector<double>{1.25, 2.5});
  options.resume = &state;
  Scene shorter = scene;
  shorter.bodies.pop_back();
  CHECK_THROWS_WITH(run(shorter, options, none), "the state to go on from is of 13 bodies, and the scene has 12");
  shorter = scene;
  shorter.end_time = 1;
  CHECK_THROWS(run(shorter, options, none));
  RunOptions other = options;
  other.broad_phase = "grid";
  CHECK_NOTHROW(run(scene, other, none));
  other.domains = 3;
  CHECK_THROWS_WITH(run(scene, other, none), "RunOptions.checkpoint_bodies: is needed in a scene that is divided");
}

TEST_CASE("checkpoint: a file has what was written, and one that is damaged is refused") {
  const TemporaryFolder folder;
  const auto file = folder / "run.state";
  Number number;
  const Checkpoint written{.run = 11,
                           .scene = {12, 13},
                           .options = {{"--pairs", "given"}, {"--rate", "5"}},
                           .time = 1.5,
                           .events = FilePlace{345, 678},
                           .world = kds::save(number)};
  kds::collision::Team alone(nullptr);
  CheckpointWriter(file, alone).commit(written);
  const Checkpoint read = read_checkpoint(file);
  CHECK(read.run == 11);
  CHECK(read.scene == written.scene);
  CHECK(read.options == written.options);
  CHECK(read.time == 1.5);
  REQUIRE(read.events);
  CHECK(read.events->bytes == 345);
  CHECK(read.events->checksum == 678);
  CHECK(read.world == written.world);

  const std::string bytes = read_file(file);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 4);
    CHECK_THROWS_AS(read_checkpoint(folder.write("damaged", damaged)), SceneError);
    CHECK_THROWS_AS(read_checkpoint(folder.write("cut", bytes.substr(0, i))), SceneError);
  }
  const std::string damaged = (folder / "damaged").string();
  CHECK_THROWS_WITH(read_checkpoint(folder.write("damaged", "nothing of the kind, whatever it may be")),
                    damaged + ": checkpoint: snapshot: this is none, or is from another kind of machine");
  const std::string missing = (folder / "none").string();
  CHECK_THROWS_WITH(read_checkpoint(missing), missing + ": file: cannot be read: No such file or directory");
}

namespace {

using Blocks = std::vector<std::string>;

/// What each process reads, in the order of the processes.
Blocks read_blocks(const std::filesystem::path& file, std::size_t processes) {
  const Checkpoint checkpoint = read_checkpoint(file);
  Blocks all;
  for (std::size_t rank = 0; rank < processes; ++rank) {
    CheckpointReader reader(file, checkpoint, rank, processes);
    reader.check();
    for (std::vector<char> block; reader.read(block);) all.emplace_back(block.begin(), block.end());
  }
  return all;
}

/// A checkpoint of several processes, of which each writes its number and more.
void write_parts(CheckpointWriter& writer, std::size_t rank, std::size_t blocks, const std::string& what) {
  for (std::size_t i = 0; i < blocks; ++i) {
    const std::string block = what + std::to_string(rank) + "." + std::to_string(i);
    writer.write_bodies({block.begin(), block.end()});
  }
}

std::vector<std::string> files_in(const TemporaryFolder& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "")) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

void write_by(std::size_t processes, const std::filesystem::path& file, std::size_t times, const std::string& what) {
  kds::collision::tests::ThreadProcesses(processes).run([&](kds::collision::Processes& others) {
    kds::collision::Team team(&others);
    CheckpointWriter writer(file, team);
    for (std::size_t k = 0; k < times; ++k) {
      write_parts(writer, team.rank(), 1 + team.rank() % 3, what + std::to_string(k) + "-");
      writer.commit({.run = 7});
    }
  });
}

}  // namespace

TEST_CASE("checkpoint: files of bodies are read by any number of processes, and replaced by those of the next one") {
  const TemporaryFolder folder;
  const auto file = folder / "run.state";
  write_by(4, file, 2, "x");
  Blocks right{"x1-0.0", "x1-1.0", "x1-1.1", "x1-2.0", "x1-2.1", "x1-2.2", "x1-3.0"};
  for (const std::size_t processes : {1u, 2u, 3u, 9u}) {
    Blocks read = read_blocks(file, processes);
    std::sort(read.begin(), read.end());
    CHECK(read == right);
  }
  CHECK(read_checkpoint(file).run == 7);
  CHECK(files_in(folder) == Blocks{"run.state", "run.state.b.0", "run.state.b.1", "run.state.b.2", "run.state.b.3"});
  write_by(2, file, 1, "y");
  CHECK(files_in(folder) == Blocks{"run.state", "run.state.a.0", "run.state.a.1"});
  CHECK(read_blocks(file, 1) == Blocks{"y0-0.0", "y0-1.0", "y0-1.1"});
  // One with all in it has no files beside it.
  kds::collision::Team alone(nullptr);
  CheckpointWriter(file, alone).commit({.run = 8});
  CHECK(files_in(folder) == Blocks{"run.state"});
  CHECK(read_blocks(file, 2).empty());
}

TEST_CASE("checkpoint: a process that ends while one is written leaves the one before whole") {
  const TemporaryFolder folder;
  const auto file = folder / "run.state";
  write_by(2, file, 1, "x");
  const Blocks before = read_blocks(file, 1);
  const Blocks files = files_in(folder);
  {  // Some bodies are written.
    kds::collision::Team alone(nullptr);
    CheckpointWriter writer(file, alone);
    write_parts(writer, 0, 3, "never");
    CHECK(read_blocks(file, 1) == before);
  }
  CHECK(files_in(folder) == files);
  // All bodies are there, of three processes, and the file that would name them is not.
  folder.write("other.state", read_file(file));
  const auto other = folder / "other.state";
  write_by(3, other, 1, "late");
  for (int rank = 0; rank < 3; ++rank) {
    const std::string part = ".b." + std::to_string(rank);
    folder.write("run.state" + part, read_file(other.string() + part));
  }
  CHECK(read_blocks(file, 1) == before);
  // The next one, of fewer processes, leaves nothing of them, wherever there are gaps; but of others.
  folder.write("run.state.a.7", read_file(other.string() + ".b.2"));
  folder.write("run.state.a.8.unfinished", read_file(other.string() + ".b.2").substr(0, 20));
  folder.write("run.state.b.9", "a table, say");
  write_by(2, file, 1, "z");
  CHECK(read_blocks(file, 1) == Blocks{"z0-0.0", "z0-1.0", "z0-1.1"});
  CHECK_FALSE(std::filesystem::exists(file.string() + ".b.2"));
  CHECK_FALSE(std::filesystem::exists(file.string() + ".a.0"));
  CHECK_FALSE(std::filesystem::exists(file.string() + ".a.7"));
  CHECK_FALSE(std::filesystem::exists(file.string() + ".a.8.unfinished"));
  CHECK(std::filesystem::exists(file.string() + ".b.9"));
}

TEST_CASE("checkpoint: one that cannot be written leaves no file of bodies") {
  const TemporaryFolder folder;
  const auto file = folder / "run.state";
  kds::collision::Team alone(nullptr);
  CheckpointWriter writer(file, alone);
  write_parts(writer, 0, 1, "x");
  std::filesystem::create_directory(file);
  CHECK_THROWS_WITH(writer.commit({.run = 8}), file.string() + ": file: cannot be written: Is a directory");
  CHECK(files_in(folder) == Blocks{"run.state"});
}

TEST_CASE(
    "checkpoint: files of bodies that are missing, cut, damaged or of another checkpoint are refused, and named") {
  const TemporaryFolder folder;
  const auto file = folder / "run.state", other = folder / "other.state";
  write_by(2, file, 1, "x");
  write_by(2, other, 1, "y");
  const auto refused = [&](const std::string& what) {
    const std::string part = file.string() + ".a.1: ";
    kds::tests::throws<SceneError>([&] { read_blocks(file, 1); }, part + what);
  };
  const std::string part = read_file(file.string() + ".a.1");
  for (std::size_t i = 0; i < part.size(); ++i) {
    std::string damaged = part;
    damaged[i] = static_cast<char>(damaged[i] ^ 4);
    folder.write("run.state.a.1", damaged);
    CHECK_THROWS_AS(read_blocks(file, 1), SceneError);
    CHECK_THROWS_AS(read_blocks(file, 3), SceneError);
    folder.write("run.state.a.1", part.substr(0, i));
    refused("part of a checkpoint: ");
  }
  std::string damaged = part;
  damaged[part.size() - 10] = '?';
  folder.write("run.state.a.1", damaged);
  refused("part of a checkpoint: is damaged");
  folder.write("run.state.a.1", read_file(other.string() + ".a.1"));
  refused("part of a checkpoint: is of another checkpoint");
  folder.write("run.state.a.1", part + "more");
  refused("part of a checkpoint: has " + std::to_string(part.size() + 4) + " bytes, and there were " +
          std::to_string(part.size()) + ": it has been cut, or is of another checkpoint");
  std::filesystem::remove(file.string() + ".a.1");
  refused("file: cannot be read: No such file or directory");
}

TEST_CASE("checkpoint: a scene whose file, mesh or table is another one is refused, by its name, whoever reads it") {
  const TemporaryFolder folder;
  const auto table = [](double last) {
    BodyTable bodies;
    for (int i = 0; i < 7; ++i) {
      bodies.position.emplace_back(3 * i, 0, 0);
      bodies.radius.push_back(i == 6 ? last : 1);
      bodies.fixed.push_back(static_cast<std::int8_t>(i % 2));
    }
    return to_hdf5(bodies);
  };
  const std::string mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const std::string text = R"({"scene": 1, "end_time": 1, "meshes": {"m": {"file": "m.obj"}}, "tables":
    [{"file": "t.h5", "prefix": "b"}, {"file": "u.h5", "prefix": "c"}], "bodies": [{"name": "a", "shape":
    {"mesh": "m"}, "motion": [{"start": 0, "position": [[0, 9, 0]]}]}]})";
  const auto file = folder.write("scene.json", text);
  folder.write("m.obj", mesh), folder.write("t.h5", table(1)), folder.write("u.h5", table(1));
  const std::size_t readers = GENERATE(1u, 2u, 3u, 20u);
  const auto scene_of = [&] {
    Scene scene;
    if (readers == 1) return read_scene(file);
    std::mutex mutex;
    kds::collision::tests::ThreadProcesses(readers).run([&](kds::collision::Processes& processes) {
      kds::collision::Team team(&processes);
      Scene share;
      {  // The HDF5 library is for one thread.
        const std::scoped_lock lock(mutex);
        share = read_share(file, {}, team.rank(), team.count());
      }
      complete(share, file, team);
      if (team.rank() + 1 == readers) scene = share;
    });
    return scene;
  };
  const Scene whole = read_scene(file);
  const Checkpoint checkpoint{.scene = checksums_of(whole), .world = {}};
  REQUIRE(checkpoint.scene.size() == 4);
  const auto refusal = [&] {
    const Scene scene = scene_of();
    try {
      require_same_scene(scene, file, checkpoint);
    } catch (const SceneError& error) {
      CHECK(fingerprint(scene) != fingerprint(whole));
      return std::string(error.what());
    }
    CHECK(fingerprint(scene) == fingerprint(whole));
    return std::string();
  };
  CHECK(refusal().empty());
  const std::string changed = " is not what it was when the checkpoint was written";
  folder.write("u.h5", table(1.5));
  CHECK(refusal() == file.string() + ": tables[1].file: u.h5:" + changed);
  folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 1e-9\nf 1 2 3\n");
  CHECK(refusal() == file.string() + ": meshes.m.file: m.obj:" + changed);
  folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 1\n");
  CHECK(refusal() == file.string() + ": meshes.m.file: m.obj:" + changed);
  folder.write("scene.json", text + " ");
  CHECK(refusal() == file.string() + ": file:" + changed);
  folder.write("scene.json", text), folder.write("m.obj", "# the same mesh\n" + mesh), folder.write("u.h5", table(1));
  CHECK(refusal().empty());
}

}  // namespace test_checkpoint
