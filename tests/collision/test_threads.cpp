// Bodies that come many at once are shared out among threads: nothing that can be seen depends on how many.
#include "collision/in_parts.hpp"
#include "collision/world.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace kds::collision::test_threads {
namespace {

using tests::EventLog;

/// A crowd of balls, each in a cell of its own of a lattice of side^3, some of which overlap at the start.
template <int Degree>
std::vector<BodyDescription<Degree>> crowd(int side) {
  kds::tests::Random random(2026);
  std::vector<BodyDescription<Degree>> bodies;
  for (int i = 0; i < side * side * side; ++i) {
    BodyDescription<Degree> body;
    body.shape = Sphere{random.between(0.2, 0.52)};
    certificates::PointMotion<Degree> motion{};
    motion.coefficients[0] = {i % side + 0.5, i / side % side + 0.5, i / (side * side) + 0.5};
    for (int d = 0; d < 3; ++d) {
      motion.coefficients[1][d] = random.between(-1, 1);
      if constexpr (Degree >= 2) motion.coefficients[2][d] = d == 2 ? -0.5 : 0;
    }
    body.motion = {motion};
    bodies.push_back(body);
  }
  return bodies;
}

template <int Degree>
void compare(Response response, int side, double duration) {
  const auto bodies = crowd<Degree>(side);
  std::vector<tests::Event> events;
  WorldCounters counters;
  for (const std::size_t threads : {1, 2, 3}) {
    WorldOptions options;
    options.response = response;
    options.walls = Walls{Eigen::Vector3d::Constant(-1), Eigen::Vector3d::Constant(side + 1)};
    options.window = 0.5;
    options.threads = threads;
    EventLog<Degree> log;
    World<Degree> world(options, &log);
    for (const auto& body : bodies) world.add_body(body);
    world.advance_to(duration);
    if (threads == 1) {
      events = log.events;
      counters = world.counters();
      CHECK(counters.contacts > 400);
      CHECK(counters.overlaps > 0);
      continue;
    }
    CAPTURE(threads);
    CHECK((log.events == events));
    CHECK((world.counters() == counters));
  }
}

TEST_CASE("Events and counters do not depend on the number of threads", "[threads]") {
  SECTION("elastic") { compare<1>(Response::elastic, 22, 0.1); }
  SECTION("curved paths") { compare<2>(Response::elastic, 21, 0.15); }
  SECTION("transparent") { compare<1>(Response::none, 21, 0.15); }
}

TEST_CASE("Parts of an array are worked on once each, and what one throws is thrown", "[threads]") {
  for (const std::size_t threads : {1, 2, 5}) {
    std::vector<int> touched(1003, 0);
    in_parts(touched.size(), threads, [&](std::size_t, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) ++touched[i];
    });
    CHECK(std::count(touched.begin(), touched.end(), 1) == 1003);
    CHECK_THROWS_AS(in_parts(100, threads,
                             [](std::size_t, std::size_t first, std::size_t last) {
                               if (first <= 50 && 50 < last) throw std::runtime_error("50");
                             }),
                    std::runtime_error);
  }
  CHECK(threads_for(1000, 8) == 1);
  CHECK(threads_for(100'000, 1) == 1);
  CHECK(threads_for(100'000, 3) == 3);
  CHECK(threads_for(100'000, 0) >= 1);
}

}  // namespace
}  // namespace kds::collision::test_threads
