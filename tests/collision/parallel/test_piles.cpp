// Bodies that lean on each other, in domains: the events are those of one world, bit for bit.
#include "tests/collision/parallel/changed_piles.hpp"
#include "tests/collision/parallel/in_two.hpp"
#include "tests/collision/parallel/piles.hpp"
#include "tests/collision/parallel/ties.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

namespace kds::collision::test_piles {
namespace {

using Eigen::Vector3d;
using tests::compare_piles;
using tests::compare_runs;
using tests::compare_seeds;
using tests::compare_seeds_changed;
using tests::Manner;
using tests::PileMaker;
using tests::Seen;
using tests::Staging;
using tests::TieMaker;

const Vector3d gravity(0, 0, -5);

/// A ball that others may come to rest on.
BodyDescription<2> soft_ball(const Vector3d& place, const Vector3d& velocity = Vector3d::Zero()) {
  auto ball = tests::ball<2>(0.5, place, velocity, gravity);
  ball.restitution = 0;
  return ball;
}

/// Rows of two to four balls that touch, all over a floor, and balls that roll against them.
void add_rows(World<2>& world) {
  world.add_body(tests::fixed_body<2>(Box{{60, 60, 1}}, tests::motion<2>({20, 10, -1})));
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 6; ++j) {
      const Vector3d foot(5.0 * i + 0.5 * (j % 3), 4.0 * j, 0.5);
      const Vector3d along = (i + j) % 2 == 0 ? Vector3d(1, 0, 0) : Vector3d(0, 1, 0);
      for (int k = 0; k < 2 + (i + j) % 3; ++k) world.add_body(soft_ball(foot + k * along));
      world.add_body(soft_ball(foot + Vector3d(-1.5, 1.5, 0), {1, -1, 0}));
    }
  }
}

/// Rows of five balls that have been pushed together, all across x = 20, and balls that roll against one end of each
/// from far away, some after they have struck another.
void add_struck_rows(World<2>& world) {
  world.add_body(tests::fixed_body<2>(Box{{90, 60, 1}}, tests::motion<2>({20, 20, -1})));
  for (int j = 0; j < 10; ++j) {
    const double y = 4.0 * j, middle = 20 + 0.37 * (j - 4.5), side = j % 2 == 0 ? 1 : -1;
    for (int k = -2; k <= 2; ++k) world.add_body(soft_ball({middle + k, y, 0.5}, {-0.05 * k, 0, 0}));
    const double far = 2.5 + 4 + 0.8 * j, speed = -5.0 - (j % 3);
    world.add_body(soft_ball({middle + side * far, y + 0.1 * (j % 4), 0.5}, {side * speed, 0, 0}));
    auto stone = soft_ball({middle + side * (far + 2), y + 0.3, 0.5}, {side * (speed - 3), 0, 0});
    stone.restitution = 1;
    if (j % 3 == 0) world.add_body(stone);
  }
  for (int i = -10; i <= 10; ++i) {
    for (const double y : {-4.0, 42.0}) world.add_body(soft_ball({20 + 4.0 * i, y, 0.5}));
  }
}

/// Blocks of balls that touch, five by five of them, so that several stand where four cells meet; balls strike each
/// from four sides, and most of them at the same instants.
void add_blocks(World<2>& world) {
  world.add_body(tests::fixed_body<2>(Box{{60, 60, 1}}, tests::motion<2>({0, 0, -1})));
  for (int i = -2; i <= 2; ++i) {
    for (int j = -2; j <= 2; ++j) {
      const Vector3d middle(6.0 * i, 6.0 * j, 0.5);
      for (const double x : {-0.5, 0.5}) {
        for (const double y : {-0.5, 0.5}) world.add_body(soft_ball(middle + Vector3d(x, y, 0)));
      }
      for (const double side : {-1.0, 1.0}) {
        const double speed = (i + j) % 2 == 0 ? 1 : 2, off = (i * j) % 3 == 0 ? 0.5 : 0.25;
        world.add_body(soft_ball(middle + side * Vector3d(2.5, off, 0), {-side * speed, 0, 0}));
        world.add_body(soft_ball(middle + side * Vector3d(off, -2.5, 0), {0, side * speed, 0}));
      }
    }
  }
}

/// The scene in domains with one thread and two, alone and by two processes.
Seen run_in_all_manners(const Staging<certificates::PointMotion<2>>& scene, double halo,
                        std::initializer_list<std::size_t> numbers_of_domains = {2, 3}) {
  Seen seen;
  for (const std::size_t domains : numbers_of_domains) {
    for (const std::size_t processes : {1u, 2u}) {
      Manner manner{.processes = processes, .polls = 2};
      manner.parallel.threads = domains % 2 + 1, manner.parallel.domains = domains;
      manner.parallel.halo = halo, manner.parallel.longest_window = 0.25;
      compare_runs(scene, manner, seen);
    }
  }
  return seen;
}

/// Bodies on a floor that is the first of them, in two domains.
struct InTwo : tests::InTwo<certificates::PointMotion<2>> {
  using Path = certificates::PointMotion<2>;

  static constexpr double now = 0.125;

  InTwo(double halo, const std::vector<BodyDescription<2>>& bodies, bool know_all = true)
      : tests::InTwo<Path>(
            tests::with_response(Response::elastic),
            [&](World<2>& world) {
              world.add_body(tests::fixed_body<2>(Box{{90, 9, 1}}, tests::motion<2>({0, 0, -1})));
              for (const auto& body : bodies) world.add_body(body);
            },
            now, halo, know_all) {}
};

/// Six balls in a row along x that have been pushed together, and slide.
std::vector<BodyDescription<2>> sliding_row() {
  std::vector<BodyDescription<2>> row;
  for (int i = 0; i < 6; ++i) row.push_back(soft_ball({1.0 * i, 0, 0.5}, {1 - 0.05 * (i - 2.5), 0, 0}));
  return row;
}

}  // namespace

TEST_CASE("Domain: copies that lean on owned bodies count where it is seen how far these come out", "[parallel]") {
  InTwo row(20, sliding_row());
  const double begun = row.outside_first(6);
  REQUIRE(begun > 1);
  CHECK(row.domain(0).report().divisible);
  CHECK(row.domain(0).report().begun_outside == Approx(begun));
  row.domain(0).run(InTwo::now + 0.5);
  CHECK(row.domain(0).report().overshoot == Approx(begun + 0.5));

  // What an island reaches out of the cell takes up the halo.
  CHECK_FALSE(InTwo(begun + 1.25, sliding_row()).domain(0).report().divisible);

  auto struck = sliding_row();  // by a heavy ball, which drives it back
  struck.push_back(soft_ball({6.5 + 2 * InTwo::now, 0, 0.5}, {-1, 0, 0}));
  struck.back().mass = 20;
  InTwo back(20, struck);
  const double gap = back.outside_first(7) - back.outside_first(6) - 1;
  REQUIRE(gap > 0.1);
  back.domain(0).run(InTwo::now + 4);
  CHECK(back.domain(0).report().overshoot == Approx(back.outside_first(6) + 0.5 * gap + 1));
}

TEST_CASE("Domain: of an island that an owned body strikes, all count", "[parallel]") {
  std::vector<BodyDescription<2>> pile;
  for (const double x : {0.0, 1.0}) pile.push_back(soft_ball({x, 0, 0.5}));
  pile.push_back(soft_ball({0.5, 0, 0.5 + 0.875}));
  auto stone = soft_ball({-2.5, 0, 0.5}, {4, 0, 0});
  stone.restitution = pile[0].restitution = 1;
  pile.push_back(stone);
  for (const double x : {-6.0, -9.0}) pile.push_back(soft_ball({x, 0, 0.5}));
  InTwo two(20, pile);
  REQUIRE(two.outside_first(4) == 0);
  REQUIRE(two.outside_first(1) > 0);
  two.domain(0).run(InTwo::now + 0.05);
  CHECK(two.domain(0).report().overshoot == 0);
  two.domain(0).run(InTwo::now + 0.3);
  CHECK(two.domain(0).report().overshoot > two.outside_first(2));
}

TEST_CASE("Domain: copies are compared with all that rests of the originals", "[parallel]") {
  InTwo two(20, sliding_row());
  for (std::size_t i = 0; i < 2; ++i) two.domain(i).run(InTwo::now + 0.5);
  REQUIRE(two.domain(1).changes().empty());
  using Change = Domain<InTwo::Path>::Change;
  auto struck = sliding_row();
  struck.push_back(soft_ball({6.5 + 2 * InTwo::now, 0, 0.5}, {-1, 0, 0}));
  InTwo both(20, struck);
  for (std::size_t i = 0; i < 2; ++i) both.domain(i).run(InTwo::now + 1);
  std::vector<Change> changes(both.domain(1).changes().begin(), both.domain(1).changes().end());
  REQUIRE_FALSE(changes.empty());
  const auto compare = [&] {
    const std::array<std::span<const Change>, 1> of_neighbours{changes};
    both.domain(0).compare(of_neighbours);
    return both.domain(0).wrong().size();
  };
  CHECK(compare() == 0);
  for (Change& change : changes) {
    if (change.number == 6) change.resting = {};
  }
  CHECK(compare() == 1);
}

TEST_CASE("Domain: who needs no longer know a body that lies deep in its cell does not", "[parallel]") {
  std::vector<BodyDescription<2>> apart;
  for (int i = 0; i < 8; ++i) apart.push_back(soft_ball({8.0 * i, 0, 0.5}));
  InTwo two(3, apart);  // in which each domain knows all of them
  two.domain(0).run(InTwo::now + 0.5);
  two.domain(0).find_moves(two.store(), InTwo::now + 0.5);
  std::size_t moves = 0;
  two.domain(0).moves().each([&](BodySlot, DomainIndex owner, std::span<const DomainIndex> knowers) {
    ++moves;
    CHECK(owner == 0);
    CHECK(knowers.size() == 1);
  });
  CHECK(moves == 4);
}

TEST_CASE("Domain: a body that ceases to rest may leave the depth of its cell", "[parallel]") {
  auto pressed = soft_ball({-20, 0, 0.5}, {0, 1, 0});
  pressed.motion[0].coefficients[2] = {2.5, 0, -2.5};
  const auto stop = tests::fixed_body<2>(Box{{0.5, 0.5, 0.5}}, tests::motion<2>({-19, 0, 0.5}));
  InTwo two(3, {pressed, stop, soft_ball({20, 0, 0.5})}, false);
  two.domain(0).run(InTwo::now + 0.125);
  CHECK(two.domain(0).report().overshoot == 0);
  two.domain(0).run(InTwo::now + 4);
  CHECK(two.domain(0).report().stayed);
  CHECK(two.domain(0).report().overshoot > 0);
}

TEMPLATE_TEST_CASE_SIG("Domains: bodies that lean on each other have the events of one world", "[parallel]",
                       ((int Degree), Degree), 1, 2) {
  Seen seen;
  compare_piles<Degree>({{15, 20, 6}, {38, Degree == 2 ? 1u : 0u, 8}}, seen);
  INFO(seen.text());
  CHECK(seen.events > 500);
  CHECK(seen.divided > 5);
  CHECK(seen.windows > 30);
  CHECK(seen.corrected > 3);
  CHECK(seen.rests > 200);
}

TEST_CASE("Domains: rows of balls across borders are divided, and none of it is run as one world", "[parallel]") {
  const Seen seen = run_in_all_manners({tests::with_response(Response::elastic), add_rows, 2, "rows"}, 4);
  INFO(seen.text());
  CHECK(seen.tables == 4);
  CHECK(seen.windows > 20);
  CHECK(seen.rests >= 4 * 200);
}

TEST_CASE("Domains: rows of balls across a border are struck at their far ends", "[parallel]") {
  const WorldOptions options = tests::with_response(Response::elastic);
  Seen seen;
  for (const double halo : {1.0, 2.0}) {
    const Seen of_halo = run_in_all_manners({options, add_struck_rows, 3, "struck rows"}, halo);
    seen.windows += of_halo.windows, seen.corrected += of_halo.corrected, seen.tables += of_halo.tables;
    seen.rests += of_halo.rests, seen.whole += of_halo.whole, seen.failed += of_halo.failed;
  }
  INFO(seen.text());
  CHECK(seen.tables > 3);
  CHECK(seen.windows > 40);
  CHECK(seen.corrected > 3);
}

TEST_CASE("Domains: blocks of balls where four cells meet are struck from all sides at one time", "[parallel]") {
  const Seen seen = run_in_all_manners({tests::with_response(Response::elastic), add_blocks, 2, "blocks"}, 2, {4, 7});
  INFO(seen.text());
  CHECK(seen.tables == 4);
  CHECK(seen.windows > 20);
}

TEMPLATE_TEST_CASE_SIG("Domains: a listener that changes piles has the events of one world", "[parallel]",
                       ((int Degree), Degree), 1, 2) {
  Seen seen;
  const std::uint64_t asked =
      compare_seeds_changed<Degree, PileMaker<Degree>>("KDS_CHANGED_PILE_SEEDS", {{1, Degree == 1 ? 40 : 12, 8}}, seen);
  INFO("changes " << asked << ", " << seen.text());
  CHECK(asked > 100);
  CHECK(seen.events > 2000);
  CHECK(seen.windows > 5);
  CHECK(seen.rests > 300);
}

TEST_CASE("Domains: bodies leave clusters before a span of these ends", "[parallel]") {
  Seen seen;
  compare_seeds_changed<2, TieMaker<2>>("KDS_CHANGED_TIE_SEEDS", {{42}, {294}}, seen);
  INFO(seen.text());
  CHECK(seen.events > 500);
  CHECK(seen.rests > 200);
}

TEST_CASE("Domains: rows and blocks on a lattice are struck at one time", "[parallel]") {
  Seen seen;
  compare_seeds<TieMaker<1>>("KDS_TIE_SEEDS", {{8}, {25}}, seen);
  INFO(seen.text());
  CHECK(seen.windows > 5);
  CHECK(seen.rests > 100);
}

TEST_CASE("Domains: islands that their owners cannot know wholly come back from several processes", "[parallel]") {
  Seen seen;
  compare_seeds<TieMaker<2>>("KDS_TIE_SEEDS", {{17}, {24}}, seen);
  INFO(seen.text());
  CHECK(seen.whole > 5);
  CHECK(seen.rests > 50);
}

}  // namespace kds::collision::test_piles
