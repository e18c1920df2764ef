#include "examples/kds-collide/run.hpp"
#include "examples/kds-collide/scene_reader.hpp"

#include <catch2/catch.hpp>

#include <stdexcept>
#include <string>

using namespace kds_collide;

namespace {

/// Counts how often the clock is told of, and ends a run that has no end.
class CountingSink final : public EventSink {
 public:
  void on_time(double time) override {
    if (++count > 10'000) throw std::runtime_error("the clock stands still");
    last = time;
  }

  int count = 0;
  double last = 0;
};

Scene one_ball(const std::string& end_time) {
  return parse_scene(R"({"scene": 1, "end_time": )" + end_time + R"(, "bodies": [
    {"name": "a", "shape": {"sphere": {"radius": 1}}, "motion": [{"start": 0, "position": [[0,0,0], [1,0,0]]}]}]})",
                     "scene.json");
}

}  // namespace

TEST_CASE("run: progress is steady, however short the run") {
  const std::string end_time = GENERATE("1e20", "1", "1e-300", "1e-307", "5e-324");
  INFO(end_time);
  CountingSink sink;
  const Scene scene = one_ball(end_time);
  run(scene, {.steady_progress = true}, sink);
  CHECK(sink.last == scene.end_time);
  CHECK(sink.count <= 101);
}

TEST_CASE("run: results are asked for at the rate") {
  CountingSink sink;
  run(one_ball("2"), {.rate = 60}, sink);
  CHECK(sink.last == 2);
  CHECK(sink.count == 120);
}
