// The scene reader on any bytes: a scene that a world takes, or one line that says what is wrong.
#include "collision/world.hpp"
#include "io/scene_reader.hpp"
#include "io/scene_world.hpp"
#include "tests/fuzz/check.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

namespace kds::fuzz {
namespace {

using namespace kds::io;

/// Where meshes are looked for; none there, other than by a name like "/dev/stdin", which is no mesh file.
constexpr const char* file = "no-such-folder/scene.json";

void check_sound(const Scene& scene) {
  require(scene.begin_time <= scene.end_time, "the scene ends before it begins");
  for (const SceneBody& body : scene.bodies) {
    require(!body.name.empty() && !body.motion.empty(), "a body without name or motion");
    require(std::isfinite(body.mass) && body.mass > 0, "a mass");
    require(std::abs(body.orientation.norm() - 1) < 1e-12, "an orientation is not normalised");
    for (const MotionPiece& piece : body.motion) require(piece.finite(), "a motion is not finite");
  }
}

/// What the reader lets through, the engine takes.
template <class Motion>
void check_accepted(const Scene& scene) {
  collision::WorldOptions options;
  options.start_time = scene.begin_time;
  options.response = scene.response;
  if (scene.domain && scene.domain->reflects) {
    options.walls = collision::Walls{scene.domain->min, scene.domain->max, scene.domain->restitution};
  }
  collision::BasicWorld<Motion> world(options);
  for (const SceneBody& body : scene.bodies) world.add_body(describe<Motion>(body));
  // Some events, as far as a fuzzer's patience goes: not through 1e60 radians.
  if (collision::turns<Motion>) return;
  for (int i = 0; i < 20 && world.step(scene.end_time); ++i) {
  }
}

void check_message(const std::string_view message) {
  require(message.starts_with(std::string(file) + ": "), "the error does not begin with the file");
  const auto control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  require(std::none_of(message.begin(), message.end(), control), "the error is not one line");
  const std::string_view rest = message.substr(std::string_view(file).size() + 2);
  const auto colon = rest.find(": ", 1);  // WHERE holds keys as they are, and one may begin with a colon
  require(colon != std::string_view::npos && colon + 2 < rest.size(), "the error says no WHERE or what");
}

}  // namespace

void run(std::span<const std::uint8_t> input) {
  const std::string text(input.begin(), input.end());
  try {
    const Scene scene = parse_scene(text, file);
    check_sound(scene);
    if (scene.turning) {
      check_accepted<certificates::RigidMotion<2>>(scene);
    } else {
      check_accepted<certificates::PointMotion<2>>(scene);
    }
  } catch (const SceneError& error) {
    check_message(error.what());
  }
}

}  // namespace kds::fuzz
