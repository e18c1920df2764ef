// Meshes that bend, in domains: the events are those of one world, bit for bit.
#include "tests/collision/parallel/bending_stagings.hpp"

#include <catch2/catch.hpp>

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
  compare_bending_stagings<Path<Degree>>(1, 25, 8, seen);
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

TEST_CASE("Domains: with a mesh that may meet itself a scene is one world", "[parallel]") {
  ParallelWorld<2> world(tests::with_response(Response::elastic), {.threads = 1, .domains = 4, .halo = 1});
  auto sheet = trampoline();
  sheet.self_contacts = true;
  world.add_body(sheet);
  for (int i = 0; i < 27; ++i) world.add_body(tests::ball<2>(0.4, {2.0 * (i % 3), 2.0 * (i / 3), 2}, {0, 0, -1}));
  world.advance_to(2);
  CHECK(world.counters().contacts > 0);
  CHECK(world.counters().steps == 0);
}

}  // namespace kds::collision::test_bending_domains
