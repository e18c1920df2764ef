// What broad phases answer, against brute force over exact numbers.
#include "collision/broad_phase/adaptive_broad_phase.hpp"
#include "collision/broad_phase/all_pairs.hpp"
#include "collision/broad_phase/kinetic_sweep_and_prune.hpp"
#include "collision/broad_phase/swept_sweep_and_prune.hpp"
#include "tests/collision/broad_phase/broad_phase_stress.hpp"
#include "tests/collision/broad_phase/kept_boxes.hpp"
#include "tests/support/exact_rational.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace kds::collision::test_queries {
namespace {

using namespace tests;
using oracle::Rational;

constexpr double largest = std::numeric_limits<double>::max();
const std::vector<std::string> ways{"all pairs", "few boxes", "grid", "chosen", "one list", "all lists", "frames"};

template <int Degree>
std::unique_ptr<BroadPhase<Degree>> make(const std::string& way) {
  constexpr double frames_per_second = 2;
  if (way == "all pairs") return std::make_unique<AllPairs<Degree>>();
  if (way == "few boxes") return std::make_unique<FewBoxes<Degree>>();
  if (way == "grid") return with_boxes<KineticGrid, Degree>();
  if (way == "chosen") return with_boxes<AdaptiveBroadPhase, Degree>(std::size_t{1}, AdaptiveTuning{.most_for_few = 8});
  if (way == "frames") return std::make_unique<SweptSweepAndPrune<Degree>>(0, frames_per_second, nullptr);
  const ListedAxes listed = way == "one list" ? ListedAxes::one : ListedAxes::all;
  return std::make_unique<KineticSweepAndPrune<Degree>>(0, SweepTuning{.listed = listed});
}

template <int Degree>
Rational value(const Motion<Degree>& x, double t) {
  Rational sum = 0;
  for (std::size_t i = Degree + 1; i-- > 0;) {
    sum = sum * (oracle::rational(t) - oracle::rational(x.start)) + oracle::rational(x.position.c[i]);
  }
  return sum;
}

/// Whether two closed boxes have a point in common at t, where one is at rest.
template <int Degree>
bool meet(const KineticBox<Degree>& body, const StaticBox& box, double t) {
  for (int d = 0; d < 3; ++d) {
    if (box.max[d] < largest && value(body.min.axis(d), t) > oracle::rational(box.max[d])) return false;
    if (box.min[d] > -largest && value(body.max.axis(d), t) < oracle::rational(box.min[d])) return false;
  }
  return true;
}
template <int Degree>
bool meet(const KineticBox<Degree>& a, const KineticBox<Degree>& b, double t) {
  for (int d = 0; d < 3; ++d) {
    if (value(a.min.axis(d), t) > value(b.max.axis(d), t) || value(b.min.axis(d), t) > value(a.max.axis(d), t)) {
      return false;
    }
  }
  return true;
}

template <int Degree>
std::vector<BodySlot> overlapping(const BroadPhase<Degree>& broad_phase, const StaticBox& box, double now) {
  std::vector<BodySlot> named;
  broad_phase.visit_overlapping(box, now, [&](BodySlot id) { named.push_back(id); });
  std::sort(named.begin(), named.end());
  return named;
}
template <int Degree>
std::vector<BodySlot> swept(const BroadPhase<Degree>& broad_phase, const KineticBox<Degree>& box, double from,
                            double until) {
  std::vector<BodySlot> named;
  broad_phase.visit_swept(box, from, until, [&](BodySlot id) { named.push_back(id); });
  std::sort(named.begin(), named.end());
  return named;
}

/// What is named must be there, once.
template <class Boxes>
void require_named_once(const std::vector<BodySlot>& named, const Boxes& boxes) {
  REQUIRE(std::adjacent_find(named.begin(), named.end()) == named.end());
  for (const BodySlot id : named) REQUIRE(boxes.contains(id));
}

struct Asked {
  std::size_t questions = 0, named = 0, met = 0, touched = 0;
};

/// Bodies that meet the box, none of which may be missed.
template <int Degree>
void ask(const BroadPhase<Degree>& broad_phase, const std::map<BodySlot, KineticBox<Degree>>& boxes,
         const StaticBox& box, double now, Asked& asked) {
  const std::vector<BodySlot> named = overlapping(broad_phase, box, now);
  require_named_once(named, boxes);
  StaticBox inside = box;
  for (int d = 0; d < 3; ++d) inside.min[d] = next_up(box.min[d]), inside.max[d] = next_down(box.max[d]);
  ++asked.questions;
  asked.named += named.size();
  for (const auto& [id, body] : boxes) {
    if (!meet(body, box, now)) continue;
    INFO("body " << id << " at " << now);
    REQUIRE(std::binary_search(named.begin(), named.end(), id));
    ++asked.met;
    asked.touched += !meet(body, inside, now);
  }
}

template <int Degree>
void ask(const BroadPhase<Degree>& broad_phase, const std::map<BodySlot, KineticBox<Degree>>& boxes,
         const KineticBox<Degree>& box, double from, double until, Asked& asked) {
  const std::vector<BodySlot> named = swept(broad_phase, box, from, until);
  require_named_once(named, boxes);
  ++asked.questions;
  asked.named += named.size();
  for (const auto& [id, body] : boxes) {
    const bool at_ends = meet(body, box, from) || meet(body, box, until);
    asked.met += at_ends;
    if (std::binary_search(named.begin(), named.end(), id)) continue;
    INFO("body " << id << " from " << from << " until " << until);
    REQUIRE(!at_ends);
    REQUIRE(!meet(body, box, from + 0.5 * (until - from)));
    if (boxes.size() < 50) REQUIRE(oracle::overlaps(exact(box), exact(body), from, until).empty());
  }
}

StaticBox random_static_box(Random& random, bool coarse, double side) {
  StaticBox box;
  const double size = random.one_in(4) ? 0 : random.one_in(3) ? 6 : 1.5;
  for (int d = 0; d < 3; ++d) {
    box.min[d] = coarse ? 0.5 * random.integer(-2, 2 * static_cast<int>(side)) : random.between(-1, side);
    box.max[d] = box.min[d] + (coarse ? 0.5 * random.integer(0, static_cast<int>(2 * size)) : size * random.unit());
  }
  return box;
}

template <int Degree>
void ask_some(Stress<Degree>& stress, Asked& at_rest, Asked& moving) {
  Random& random = stress.random;
  for (int i = 0; i < 3; ++i) {
    ask(stress.broad_phase, stress.boxes, random_static_box(random, stress.coarse, stress.side), stress.now, at_rest);
  }
  const auto box = random_box<Degree>(random, stress.coarse, stress.now, stress.side);
  const double ahead = random.one_in(3) ? 0 : 0.25 * random.integer(0, 12);
  ask(stress.broad_phase, stress.boxes, box, stress.now, stress.now + ahead, moving);
}

TEMPLATE_TEST_CASE_SIG("Questions name all bodies that a box meets, each once", "[broad_phase]", ((int Degree), Degree),
                       1, 2) {
  for (const std::string& way : ways) {
    Asked at_rest, moving;
    std::size_t present = 0;
    std::size_t rounds = 0;
    for (const bool coarse : {false, true}) {
      for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        INFO(way << ", degree " << Degree << (coarse ? ", coarse" : ", fine") << " numbers, seed " << seed);
        Stress<Degree> stress(seed, coarse, make<Degree>(way));
        ask_some(stress, at_rest, moving);  // of nothing
        stress.insert(1);
        ask_some(stress, at_rest, moving);
        stress.insert(13);
        for (int round = 0; round < 40; ++round) {
          stress.advance(stress.now + (coarse ? 0.25 * stress.random.integer(0, 3) : stress.random.between(0, 0.6)));
          ask_some(stress, at_rest, moving);
          const auto dice = stress.random.below(8);
          if (dice < 1) {
            stress.insert(1 + stress.random.below(3));
          } else if (dice < 3 && stress.boxes.size() > 4) {
            stress.remove();
          } else {
            stress.update();
          }
          ask_some(stress, at_rest, moving);
          present += stress.boxes.size();
          ++rounds;
        }
        while (!stress.boxes.empty()) stress.remove();
        REQUIRE(overlapping(stress.broad_phase, whole_space(), stress.now).empty());
        REQUIRE(swept(stress.broad_phase, random_box<Degree>(stress.random, coarse, stress.now, 12), stress.now,
                      stress.now + 1)
                    .empty());
      }
    }
    INFO(way);
    CHECK(at_rest.met > 200);
    CHECK(at_rest.touched > 20);  // at the surface alone
    CHECK(moving.met > 100);
    // All that are present would be so many.
    const std::size_t all = present / rounds * at_rest.questions;
    if (way != "all pairs") CHECK(2 * at_rest.named < all);
  }
}

/// Balls' boxes of many sizes, some of which stand still.
template <int Degree>
std::map<BodySlot, KineticBox<Degree>> crowd(Random& random, std::size_t count, double side) {
  std::map<BodySlot, KineticBox<Degree>> boxes;
  for (BodySlot id = 0; boxes.size() < count; id += 1 + static_cast<BodySlot>(random.below(2))) {
    auto centre = path<Degree>(random, false, 0, side);
    if (random.one_in(3)) centre.coefficients[1].setZero();
    const double radius = std::ldexp(1.0, random.integer(-6, 0));
    boxes[id] = box_around<Degree>(centre, Vector3d::Constant(-radius), Vector3d::Constant(radius), radius);
  }
  return boxes;
}

template <int Degree>
void insert(BroadPhase<Degree>& broad_phase, const std::map<BodySlot, KineticBox<Degree>>& boxes, ListedPairs& pairs) {
  std::vector<typename BroadPhase<Degree>::Entry> entries;
  for (const auto& [id, box] : boxes) entries.push_back({id, &box});
  broad_phase.insert(entries, 0, pairs);
}

TEMPLATE_TEST_CASE_SIG("Questions about many boxes of many sizes look at few of them", "[broad_phase]",
                       ((int Degree), Degree), 1, 2) {
  for (const std::string way : {"grid", "one list", "frames"}) {
    for (const double window : {0.75, never}) {
      const std::uint64_t seed = 5;
      INFO(way << ", degree " << Degree << ", window " << window << ", seed " << seed);
      Random random(seed);
      const double side = 18;
      const auto boxes = crowd<Degree>(random, 400, side);
      const auto broad_phase = make<Degree>(way);
      ListedPairs pairs;
      broad_phase->extend_horizon(0, window);
      insert(*broad_phase, boxes, pairs);
      Asked small, rods, moving;
      for (double now = 0; now < 2; now += 0.5) {
        if (window < never) broad_phase->extend_horizon(now, now + window);
        while (broad_phase->advance(now, pairs)) {
        }
        for (int i = 0; i < 16; ++i) {
          const Eigen::Array3d corner(random.between(0, side), random.between(0, side), random.between(0, side));
          ask(*broad_phase, boxes, {corner, corner + random.between(0, 0.5)}, now, small);
          // Across the whole, in more cells than are looked into at a time.
          StaticBox rod{corner, corner + 0.01};
          const int along = random.integer(0, 2);
          rod.min[along] = random.one_in(2) ? -40 : -largest;
          rod.max[along] = random.one_in(2) ? 40 : largest;
          ask(*broad_phase, boxes, rod, now, rods);
        }
        // Within the window, and beyond it.
        for (const double ahead : {0.0, 0.3, 2.0}) {
          const auto centre = path<Degree>(random, false, now, side);
          const auto box = box_around<Degree>(centre, Vector3d::Constant(-1), Vector3d::Constant(1));
          ask(*broad_phase, boxes, box, now, now + ahead, moving);
        }
      }
      CHECK(small.met > 0);
      CHECK(rods.met > 25);
      CHECK(moving.met > 5);
      // Fat boxes are larger than those in them.
      CHECK(small.named < small.met + 5 * small.questions);
      CHECK(rods.named < 4 * rods.met + 20 * rods.questions);
    }
  }
}

TEST_CASE("Boxes that touch meet, and huge, infinite and empty ones are answered", "[broad_phase]") {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const std::string& way : ways) {
    for (const double at : {0.0, 1.0, -1e15, 0x1p200}) {
      INFO(way << ", at " << at);
      // Sizes at which sums of these coordinates are exact.
      const double unit = std::max(1.0, std::ldexp(std::abs(at), -20));
      std::map<BodySlot, KineticBox<1>> boxes;
      for (BodySlot id = 0; id < 5; ++id) {
        KineticBox<1>& box = boxes[id];
        box.min.coefficients[0] = Vector3d::Constant(at) + Vector3d(2.0 * id, 0, 0) * unit;
        box.max.coefficients[0] = box.min.coefficients[0] + Vector3d::Constant(unit);
        // Moving apart from the next at once, or towards it.
        if (id % 2 == 1) box.min.coefficients[1] = box.max.coefficients[1] = Vector3d(unit / 4, 0, 0);
        box.min.start = box.max.start = 0;
      }
      const auto broad_phase = make<1>(way);
      ListedPairs pairs;
      broad_phase->extend_horizon(0, never);
      insert(*broad_phase, boxes, pairs);
      const auto cube = [&](double x, double size) {
        const Eigen::Array3d low(at + x * unit, at, at);
        return StaticBox{low, low + size * unit};
      };
      Asked asked;
      for (double now : {0.0, 2.0}) {
        while (broad_phase->advance(now, pairs)) {
        }
        for (int i = -4; i < 44; ++i) {
          ask(*broad_phase, boxes, cube(0.25 * i, 0), now, asked);
          ask(*broad_phase, boxes, cube(0.25 * i, 1), now, asked);
        }
        const std::vector<BodySlot> all{0, 1, 2, 3, 4};
        CHECK(overlapping(*broad_phase, whole_space(), now) == all);
        CHECK(overlapping(*broad_phase, {Eigen::Array3d::Constant(-infinity), Eigen::Array3d::Constant(infinity)},
                          now) == all);
        if (way == "all pairs") continue;
        CHECK(overlapping(*broad_phase, {Eigen::Array3d::Constant(0x1p300), Eigen::Array3d::Constant(largest)}, now)
                  .empty());
        CHECK(overlapping(*broad_phase, {Eigen::Array3d::Constant(-infinity), Eigen::Array3d::Constant(-0x1p300)}, now)
                  .empty());
      }
      CHECK(asked.touched > 20);
    }
  }
}

TEST_CASE("A body that leaves its fat box in time is named, wherever it goes", "[broad_phase]") {
  for (const std::string& way : ways) {
    for (const double window : {1.0, never}) {
      INFO(way << ", window " << window);
      std::map<BodySlot, KineticBox<1>> boxes;
      for (BodySlot id = 0; id < 12; ++id) {
        certificates::PointMotion<1> centre;
        centre.coefficients = {Vector3d(3.0 * id, 0, 0), Vector3d(0, id == 7 ? 1000 : 0.01, 0)};
        boxes[id] = box_around<1>(centre, Vector3d::Constant(-0.5), Vector3d::Constant(0.5), 0.5);
      }
      const auto broad_phase = make<1>(way);
      ListedPairs pairs;
      broad_phase->extend_horizon(0, window);
      insert(*broad_phase, boxes, pairs);
      certificates::PointMotion<1> target;
      target.coefficients = {Vector3d(21, 9000, 0), Vector3d(0, 0, 0)};
      const auto box = box_around<1>(target, Vector3d::Constant(-0.5), Vector3d::Constant(0.5));
      Asked asked;
      for (const double until : {0.5, 8.9, 9.5, 50.0}) {
        const auto named = swept(*broad_phase, box, 0, until);
        CHECK((std::count(named.begin(), named.end(), BodySlot{7}) == 1) >= (until > 9));
        if (way != "all pairs" && until < 1) CHECK(named.empty());
        ask(*broad_phase, boxes, box, 0, until, asked);
      }
    }
  }
}

TEST_CASE("Several threads may ask at a time", "[broad_phase]") {
  for (const std::string way : {"grid", "chosen", "one list", "frames"}) {
    INFO(way);
    Random random(6);
    const auto boxes = crowd<1>(random, 300, 12);
    const auto broad_phase = make<1>(way);
    ListedPairs pairs;
    broad_phase->extend_horizon(0, never);
    insert(*broad_phase, boxes, pairs);
    const auto answers = [&] {
      Random places(7);
      std::vector<std::vector<BodySlot>> all;
      for (int i = 0; i < 200; ++i) {
        all.push_back(overlapping(*broad_phase, random_static_box(places, false, 12), 0));
        all.push_back(swept(*broad_phase, random_box<1>(places, false, 0, 12), 0, places.between(0, 2)));
      }
      return all;
    };
    const auto expected = answers();
    std::vector<std::vector<std::vector<BodySlot>>> found(3);
    std::vector<std::thread> threads;
    for (auto& one : found) threads.emplace_back([&] { one = answers(); });
    for (std::thread& thread : threads) thread.join();
    for (const auto& one : found) CHECK(one == expected);
  }
}

}  // namespace
}  // namespace kds::collision::test_queries
