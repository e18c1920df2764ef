// Periodic worlds: what happens does not depend on which slots bodies have, but only on the order in which they are
// added.
#include "collision/periodic/periodic_world.hpp"
#include "tests/collision/periodic/periodic_scenes.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace test_periodic_slots {
namespace {

using namespace periodic_scenes;
using Eigen::Vector3d;
using kds::tests::Random;

/// Bodies by their user data.
struct Told final : PeriodicListener<1> {
  std::vector<std::string> lines;
  std::size_t wraps = 0;

  void note(const char* what, const PeriodicEvent& e) {
    char text[200];
    const Vector3d& x = e.contact.point;
    std::snprintf(text, sizeof text, "%a %s %llu %llu %a %a %a", e.contact.time, what,
                  static_cast<unsigned long long>(e.user_data_a), static_cast<unsigned long long>(e.user_data_b), x[0],
                  x[1], x[2]);
    lines.emplace_back(text);
  }
  void contact(PeriodicWorld<1>&, const PeriodicEvent& e) override { note("contact", e); }
  void overlap(PeriodicWorld<1>&, const PeriodicEvent& e) override { note("overlap", e); }
  void passes(PeriodicWorld<1>&, const PeriodicEvent& e) override { note("passes", e); }
  void wrapped(PeriodicWorld<1>& world, BodyId id, const Offset&) override {
    lines.push_back("wrapped " + std::to_string(world.world().user_data(world.in_world(id))));
    ++wraps;
  }
};

/// Balls on a lattice with velocities of few values: many meet, and leave the box, at one time.
std::vector<BodyDescription<1>> lattice(Random& random) {
  std::vector<BodyDescription<1>> balls;
  for (int cell = 0; cell < 27; ++cell) {
    const auto one = [&] { return random.integer(-1, 1); };
    BodyDescription<1> ball{.shape = Sphere{0.5}};
    ball.motion = {
        {{Vector3d(cell % 3, cell / 3 % 3, cell / 9) * 2 + Vector3d(1, 1, 1), Vector3d(one(), one(), one())}}};
    ball.user_data = balls.size();
    balls.push_back(ball);
  }
  return balls;
}

/// `history`: if not null, decides which slots bodies get: strangers are added between them and removed again.
std::vector<std::string> run(const std::vector<BodyDescription<1>>& balls, Random* history, std::size_t& out_of_order,
                             std::size_t& wraps) {
  PeriodicOptions options;
  options.max = {6, 6, 6};
  Told told;
  PeriodicWorld<1> world(options, &told);
  std::vector<BodyId> ids;
  const auto stir = [&] {
    if (!history) return;
    std::vector<BodyId> strangers;
    for (std::size_t i = history->below(6); i > 0; --i) strangers.push_back(world.add_body(balls[0]));
    while (!strangers.empty()) {
      std::swap(strangers[history->below(strangers.size())], strangers.back());
      world.remove_body(strangers.back());
      strangers.pop_back();
    }
  };
  for (const auto& ball : balls) {
    if (history && history->one_in(2)) stir();
    ids.push_back(world.add_body(ball));
    if (ids.size() > 1 && body_slot(ids.back()) < body_slot(ids[ids.size() - 2])) ++out_of_order;
  }
  world.advance_to(3);
  world.remove_body(ids[5]), world.remove_body(ids[9]);
  stir();
  auto later = balls[0];
  later.motion[0].start = 3;
  for (std::uint64_t i = 0; i < 2; ++i) {
    later.motion[0].coefficients[0] += Vector3d(0.5, 0.25, 0.125);
    later.user_data = balls.size() + i;
    world.add_body(later);
  }
  world.advance_to(6);
  world.audit();
  wraps += told.wraps;
  return told.lines;
}

}  // namespace

TEST_CASE("periodic world: bodies do the same at the same times, whichever slots they have", "[periodic][slots]") {
  std::size_t out_of_order = 0, wraps = 0, lines = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const auto balls = lattice(random);
    const auto plain = run(balls, nullptr, out_of_order, wraps), other = run(balls, &random, out_of_order, wraps);
    const bool same = plain == other;
    CHECK(same);
    lines += plain.size();
  }
  CHECK(out_of_order > 20);
  CHECK(wraps > 100);
  CHECK(lines > 500);
}

}  // namespace test_periodic_slots
