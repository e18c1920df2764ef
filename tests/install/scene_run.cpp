// A program of someone else's that uses kds::io: a scene is read and run, and its run becomes a record.
#include "io/events.hpp"
#include "io/mesh_file.hpp"
#include "io/replay.hpp"
#include "io/run.hpp"
#include "io/scene_reader.hpp"

#include <iostream>

namespace {

class Counter final : public kds::io::EventSink {
 public:
  void on_event(const kds::io::Event& event) override { contacts += event.kind == kds::io::EventKind::contact; }

  int contacts = 0;
};

}  // namespace

int main() {
  const kds::io::Scene scene = kds::io::parse_scene(R"({
    "scene": 1, "end_time": 2, "response": "elastic", "bodies": [
      {"name": "left", "shape": {"sphere": {"radius": 1}},
       "motion": [{"start": 0, "position": [[-2, 0, 0], [1, 0, 0]]}]},
      {"name": "right", "shape": {"sphere": {"radius": 1}},
       "motion": [{"start": 0, "position": [[2, 0, 0], [-1, 0, 0]]}]}
    ]})", "two balls");
  Counter counter;
  kds::io::ReplayRecorder recorder(scene);
  kds::io::EventSinks sinks;
  sinks.add(counter);
  sinks.add(recorder);
  kds::io::run(scene, {}, sinks);
  std::cout << counter.contacts << " contact, and a record of " << recorder.to_json("two balls").size() << " bytes\n";
}
