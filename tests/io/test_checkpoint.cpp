#include "io/checkpoint.hpp"
#include "io/event_csv.hpp"
#include "io/run.hpp"
#include "io/scene_reader.hpp"
#include "tests/io/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <string>
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
  options.checkpoint = [&](const kds::Snapshot& world) { states.push_back({world, lines.text.size()}); };
  run(scene, options, lines);
  CHECK(lines.text == through.text);
  REQUIRE(states.size() == 7);
  for (const State& state : states) {
    RunOptions on = options;
    on.checkpoint = [](const kds::Snapshot&) {};
    on.resume = &state.world;
    Lines rest(scene);
    const RunResult result = run(scene, on, rest);
    CHECK(rest.text == through.text.substr(state.events));
    CHECK(result.contacts == contacts_in(rest.text));
    CHECK(result.sim_seconds < 3);
    if (turning) continue;
    on.domains = 3;
    Lines divided(scene);
    run(scene, on, divided);
    CHECK(divided.text == rest.text);
  }
}

TEST_CASE("checkpoint: of another scene, or other options, it is refused") {
  const Scene scene = falling(false);
  kds::Snapshot state;
  RunOptions options;
  options.checkpoint_every = 2;
  options.checkpoint = [&](const kds::Snapshot& world) { state = world; };
  EventSinks none;
  run(scene, options, none);
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
}

TEST_CASE("checkpoint: a file has what was written, and one that is damaged is refused") {
  const TemporaryFolder folder;
  const auto file = folder / "run.state";
  Number number;
  const Checkpoint written{.scene = 12, .events = 345, .world = kds::save(number)};
  write_checkpoint(file, written);
  const Checkpoint read = read_checkpoint(file);
  CHECK(read.scene == 12);
  CHECK(read.events == 345);
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

TEST_CASE("checkpoint: the fingerprint is that of the file") {
  const TemporaryFolder folder;
  CHECK(fingerprint(folder.write("a", "scene")) == fingerprint(folder.write("b", "scene")));
  CHECK(fingerprint(folder / "a") != fingerprint(folder.write("c", "scent")));
}

}  // namespace test_checkpoint
