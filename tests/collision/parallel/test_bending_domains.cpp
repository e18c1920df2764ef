// Meshes that bend, in domains: the events are those of one world, bit for bit.
#include "tests/collision/deforming/folded_strip.hpp"
#include "tests/collision/parallel/bending_stagings.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace kds::collision::test_bending_domains {
namespace {

using Eigen::Vector3d;
using tests::compare_bending_stagings;
using tests::compare_runs;
using tests::Manner;
using tests::Random;
using tests::Seen;
template <int Degree>
using Path = certificates::PointMotion<Degree>;

/// A sheet that heaves: a wave runs through it.
BodyDescription<2> trampoline() {
  const samples::Sheet flat(6, 9);
  std::vector<MeshScript::Keyframe> keyframes;
  for (int i = 0; i <= 12; ++i) {
    auto positions = flat.positions;
    for (Vector3d& p : positions) p[2] = (static_cast<int>(p[0] + 9) / 3 + i) % 3 == 0 ? 0.5 : 0;
    keyframes.push_back({0.25 * i, positions});
  }
  auto body =
      tests::fixed_body<2>(BendingMesh{std::make_shared<const MeshScript>(std::move(keyframes), flat.triangles)},
                           tests::motion<2>({7, 7, 0}));
  body.restitution = 0.9;
  return body;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("Domains with meshes that bend have the events of one world", "[parallel]",
                       ((int Degree), Degree), 1, 2) {
  Seen seen;
  compare_bending_stagings<Path<Degree>>({{1, 25, 8}}, seen);
  INFO(seen.text());
  CHECK(seen.events > 1200);
  CHECK(seen.divided > 7);
  CHECK(seen.windows > 25);
  CHECK(seen.corrected > 15);
}

TEST_CASE("Domains: balls on a trampoline that reaches through all domains", "[parallel]") {
  const auto fill = [](World<2>& world) {
    world.add_body(trampoline());
    Random random(5);
    for (int i = 0; i < 64; ++i) {
      const double u = random.between(-1, 1), v = random.between(-1, 1), height = random.between(1.5, 3);
      world.add_body(tests::ball<2>(0.4, {2.0 * (i % 8), 2.0 * (i / 8), height}, {u, v, 0}, {0, 0, -5}));
    }
  };
  Seen seen;
  for (const std::size_t domains : {2u, 4u}) {
    for (const std::size_t processes : {1u, 3u}) {
      Manner manner{.processes = processes, .polls = 3};
      manner.parallel.threads = 2, manner.parallel.domains = domains, manner.parallel.halo = 1;
      compare_runs<Path<2>>({tests::with_response(Response::elastic), fill, 3, "trampoline"}, manner, seen);
    }
  }
  INFO(seen.text());
  CHECK(seen.divided == 4);
  CHECK(seen.whole == 0);
  CHECK(seen.events > 4 * 200);
}

TEST_CASE("Domains: strips are folded down on themselves in all domains, at the instant at which balls meet",
          "[parallel]") {
  using Kind = tests::Kind;
  const tests::Fold fold;
  const auto strip = [&](const Vector3d& place, double speed = 0) {
    auto body = tests::fixed_body<1>(fold.shape(), tests::motion<1>(place, {0, speed, 0}));
    body.self_contacts = true;
    return body;
  };
  double meets_itself = 0;
  {
    tests::WholeLog<Path<1>> log;
    World<1> alone({}, &log);
    alone.add_body(strip(Vector3d::Zero()));
    alone.advance_to(3);
    REQUIRE(log.events.size() == 2);
    meets_itself = log.events[0].time();
  }
  // Two balls on each side of each strip, whose distance is exact; a strip is first, last or between the two by its
  // number. Some strips move.
  const auto fill = [&](World<1>& world) {
    for (int i = 0; i < 6; ++i) {
      const double x = 5.0 * i;
      if (i % 3 == 0) world.add_body(strip({x, 0, 0}, i % 2 == 0 ? 0 : 0.25));
      for (const double z : {4.0, -4.0}) {
        world.add_body(tests::ball<1>(0.5, {x, 0, z}));
        if (i % 3 == 1 && z > 0) world.add_body(strip({x, 0, 0}));
        world.add_body(tests::ball<1>(0.5, {x, 1 + meets_itself, z}, {0, -1, 0}));
      }
      if (i % 3 == 2) world.add_body(strip({x, 0, 0}, 0.125));
    }
    world.set_timer(meets_itself);
  };
  for (const Response response : {Response::elastic, Response::none}) {
    const tests::Staging<Path<1>> scene{tests::with_response(response), fill, 3.5, "folded strips"};
    tests::WholeLog<Path<1>> log;
    World<1> world(scene.options, &log);
    fill(world);
    world.advance_to(3.5);
    const auto at_once = [&](bool itself) {
      return std::ranges::count_if(log.events, [&](const tests::Event& event) {
        return event.kind == Kind::contact && event.time() == meets_itself && (event.a == event.b) == itself;
      });
    };
    CHECK(at_once(true) == 6);
    CHECK(at_once(false) == 12);
    Seen seen;
    Manner manner{.processes = response == Response::none ? 2u : 1u, .polls = 2};
    manner.parallel.threads = 2, manner.parallel.domains = 3;
    manner.parallel.halo = 1, manner.parallel.longest_window = 0.5;
    compare_runs(scene, manner, seen);
    INFO(seen.text());
    CHECK(seen.divided == 1);
    CHECK(seen.whole == 0);
  }
}

}  // namespace kds::collision::test_bending_domains
