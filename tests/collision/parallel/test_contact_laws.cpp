// Bodies that respond to contacts by a law of the caller's, in domains: the events are those of one world, bit for bit.
#include "tests/collision/parallel/contact_laws.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>

namespace kds::collision::test_contact_laws {
namespace {

using Eigen::Vector3d;
using tests::compare_laws;
using tests::DividedLog;
using tests::Random;
using tests::SampleLaw;
using tests::Seen;
using tests::WholeLog;
template <int Degree>
using Path = certificates::PointMotion<Degree>;

/// Bodies swap their velocities.
struct Swap final : ContactLaw {
  void respond(const Meeting&, Velocities& a, Velocities& b) const override { std::swap(a, b); }
};

/// Throws, or does what no law may, at the first contact of two bodies of which one has this number.
struct Lawless final : ContactLaw {
  enum class What { throws, moves_fixed, turns, is_infinite } what = What::throws;

  explicit Lawless(What does) : what(does) {}
  void respond(const Meeting& meeting, Velocities& a, Velocities&) const override {
    if (meeting.a.user_data != 7) return;
    if (what == What::throws) throw std::logic_error("lawless");
    if (what == What::moves_fixed) a.linear += Vector3d(1, 0, 0);
    if (what == What::turns) a.angular = Vector3d(0, 0, 1);
    if (what == What::is_infinite) a.linear[1] = std::numeric_limits<double>::infinity();
  }
};

template <int Degree>
void add_balls(World<Degree>& world, int side) {
  Random random(9);
  for (int i = 0; i < side * side * side; ++i) {
    const double u = random.between(-2, 2), v = random.between(-2, 2), w = random.between(-2, 2);
    world.add_body(tests::ball<Degree>(0.3, Vector3d(i % side, i / side % side, i / side / side), {u, v, w}));
  }
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("Domains: bodies that respond by a law have the events of one world", "[parallel]",
                       ((int Degree), Degree), 1, 2) {
  Seen seen;
  compare_laws<Path<Degree>>({{1, 24, 8}, {1001, 2, 100}}, seen);
  INFO(seen.text());
  CHECK(seen.events > 4000);
  CHECK(seen.divided > 10);
  CHECK(seen.windows > 30);
  CHECK(seen.corrected > 30);
}

TEST_CASE("Domains: a law does what a listener of one world does that gives the same velocities", "[parallel]") {
  WorldOptions options = tests::with_response(Response::callback);
  options.walls = Walls{Vector3d::Constant(-1), Vector3d::Constant(6)};
  WholeLog<Path<1>> right;
  World<1> one(options, &right);
  add_balls(one, 6);
  right.then = [&](World<1>& world) {
    const tests::Event& event = right.events.back();
    if (event.kind != tests::Kind::contact) return;
    Path<1> a = world.motion(event.a).restarted(world.now()), b = world.motion(event.b).restarted(world.now());
    std::swap(a.coefficients[1], b.coefficients[1]);
    world.update_motion(event.a, a);
    world.update_motion(event.b, b);
  };
  one.advance_to(2);

  const Swap law;
  options.law = &law;
  WholeLog<Path<1>> by_law;
  World<1> another(options, &by_law);
  add_balls(another, 6);
  another.advance_to(2);
  tests::require_same(right.events, by_law.events, "swap, one world");

  DividedLog log;
  ParallelWorld<1> divided(options, {.threads = 2, .domains = 4, .halo = 1}, &log);
  add_balls(divided.whole(), 6);
  divided.advance_to(2);
  tests::require_same(right.events, log.events, "swap");
  CHECK(right.events.size() > 300);
  CHECK(divided.counters().windows > 0);
}

TEST_CASE("Domains: bodies that a law lets pass through each other pass in windows", "[parallel]") {
  const SampleLaw law(SampleLaw::Kind::lets_pass);
  WorldOptions options = tests::with_response(Response::callback);
  options.law = &law;
  DividedLog log;
  ParallelWorld<2> divided(options, {.threads = 2, .domains = 4, .halo = 1}, &log);
  add_balls(divided.whole(), 6);
  divided.advance_to(1);
  std::size_t passes = 0;
  for (const tests::Event& event : log.events) passes += event.kind == tests::Kind::passes;
  CHECK(passes > 100);
  CHECK(2 * passes == log.events.size());
  CHECK(divided.counters().stretches_whole == 0);
}

TEST_CASE("Domains: without a law a scene in mode callback is one world", "[parallel]") {
  ParallelWorld<1> world(tests::with_response(Response::callback), {.threads = 1, .domains = 4, .halo = 1});
  add_balls(world.whole(), 4);
  world.advance_to(1);
  CHECK(world.counters().contacts > 0);
  CHECK(world.counters().steps == 0);
}

TEST_CASE("Domains: what is no law is refused, and the run can go on", "[parallel]") {
  for (const auto what :
       {Lawless::What::throws, Lawless::What::moves_fixed, Lawless::What::turns, Lawless::What::is_infinite}) {
    double thrown_at = 0;
    for (const std::size_t domains : {1u, 3u}) {
      const Lawless law(what);
      WorldOptions options = tests::with_response(Response::callback);
      options.law = &law;
      ParallelWorld<1> world(options, {.threads = 1, .domains = domains, .halo = 1});
      auto first = tests::fixed_body<1>(Sphere{0.5}, tests::motion<1>({2.5, 2.5, 2.5}));
      first.user_data = 7;
      world.add_body(first);
      add_balls(world.whole(), 5);
      CHECK_THROWS_AS(world.advance_to(5), std::logic_error);
      CHECK(world.now() < 5);
      if (domains > 1) CHECK(world.now() == thrown_at);
      thrown_at = world.now();
      CHECK_NOTHROW(world.whole().audit());
    }
  }
}

}  // namespace kds::collision::test_contact_laws
