// Parabolas written as cubics and quintics whose last coefficients are zero: the same events as in World<2>, bit for
// bit, in every mode.
#include "tests/collision_splines/random_curves.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace kds::collision::test_same_as_parabolas {
namespace {

using namespace tests;

template <int Degree>
certificates::PointMotion<Degree> raised(const certificates::PointMotion<2>& path) {
  certificates::PointMotion<Degree> result{{path.coefficients[0], path.coefficients[1], path.coefficients[2]},
                                           path.start};
  return result;
}

template <int Degree>
Scene<Degree> raised(const Scene<2>& scene) {
  Scene<Degree> result;
  result.end_time = scene.end_time;
  for (const auto& from : scene.bodies) {
    BodyDescription<Degree> to;
    to.shape = from.shape, to.orientation = from.orientation;
    to.mass = from.mass, to.restitution = from.restitution, to.fixed = from.fixed;
    to.motion.clear();
    for (const auto& piece : from.motion) to.motion.push_back(raised<Degree>(piece));
    result.bodies.push_back(std::move(to));
  }
  return result;
}

void require_equal(const std::vector<Event>& found, const std::vector<Event>& expected) {
  for (std::size_t i = 0; i < std::min(found.size(), expected.size()); ++i) {
    INFO("event " << i);
    REQUIRE(found[i] == expected[i]);
  }
  REQUIRE(found.size() == expected.size());
}

constexpr std::array all_shapes{Shapes::spheres, Shapes::turned_boxes, Shapes::tetrahedra, Shapes::mixture};

TEMPLATE_TEST_CASE_SIG("Curves: without higher terms they are the parabolas of World<2>, bit for bit", "[splines]",
                       ((int Degree), Degree), 3, 5) {
  std::size_t events = 0;
  for (const Response response : {Response::none, Response::elastic}) {
    for (const Numbers numbers : {Numbers::fine, Numbers::coarse}) {
      for (const Shapes shapes : all_shapes) {
        const std::uint64_t seed = 3;
        INFO("degree " << Degree << ", response " << static_cast<int>(response) << ", " << name(shapes) << ", "
                       << (numbers == Numbers::fine ? "fine" : "coarse") << " numbers, seed " << seed);
        Random random(seed);
        SceneMaker maker(random, {.shapes = shapes, .numbers = numbers, .bodies = 10, .side = 5, .scripts = true});
        const auto scene = maker.scene<2>();
        WorldOptions options;
        options.response = response;
        const auto expected = run(scene, options);
        require_equal(run(raised<Degree>(scene), options), expected);
        events += expected.size();
      }
    }
  }
  CHECK(events > 200);
}

/// Bodies that lose speed fall on each other and on a floor, and come to rest.
TEMPLATE_TEST_CASE_SIG("Curves: without higher terms bodies come to rest as in World<2>", "[splines]",
                       ((int Degree), Degree), 3, 5) {
  const std::uint64_t seed = 11;
  CAPTURE(seed);
  Random random(seed);
  Scene<2> scene;
  scene.end_time = 4;
  scene.bodies.push_back(fixed_body<2>(Box{{20, 20, 1}}, motion<2>({0, 0, -1})));
  for (int i = 0; i < 6; ++i) {
    const Vector3d place(random.between(-2, 2), random.between(-2, 2), 2 + 2.5 * i);
    auto description =
        i % 2 == 0 ? box<2>({0.8, 0.8, 0.8}, place, zero, {0, 0, -5}) : ball<2>(0.7, place, zero, {0, 0, -5});
    description.restitution = 0.4;
    scene.bodies.push_back(description);
  }
  const auto options = with_response(Response::elastic);
  const auto expected = run(scene, options);
  CHECK(std::count_if(expected.begin(), expected.end(),
                      [](const Event& e) { return e.kind == Kind::rebound_suppressed; }) > 3);
  require_equal(run(raised<Degree>(scene), options, {.audit = true}), expected);
}

}  // namespace
}  // namespace kds::collision::test_same_as_parabolas
