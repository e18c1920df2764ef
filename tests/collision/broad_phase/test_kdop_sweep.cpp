// Kinetic sweep and prune over k-DOPs, against brute force over exact numbers.
#include "collision/broad_phase/kdop.hpp"
#include "collision/broad_phase/kinetic_sweep_and_prune.hpp"
#include "tests/collision/broad_phase/broad_phase_stress.hpp"
#include "tests/collision/broad_phase/kdop_values.hpp"
#include "tests/support/exact_algebra.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <map>
#include <vector>

namespace kds::collision::test_kdop_sweep {
namespace {

using namespace tests;

/// Bodies with random intervals about random paths, in a kinetic sweep and prune that is told of them.
template <int Degree>
struct Dops {
  struct Body {
    certificates::PointMotion<Degree> path;
    KineticBox<Degree> box;
    std::vector<KineticSlab<Degree>> slabs;
  };

  Dops(std::uint64_t seed, bool coarse_numbers, int k, ListedAxes listed)
      : random(seed),
        coarse(coarse_numbers),
        more(directions(k)),
        broad_phase(0, {.listed = listed},
                    {more, [this](BodySlot id, std::size_t i, double) { return bodies.at(id).slabs[i]; }}) {
    broad_phase.extend_horizon(0, never);
  }

  Body make() {
    Body body;
    body.path = path<Degree>(random, coarse, now, 6);
    const double radius = coarse ? 0.5 * random.integer(1, 3) : random.between(0.2, 1);
    body.box = box_around(body.path, Vector3d::Constant(-radius), Vector3d::Constant(radius));
    for (const auto& d : more) {
      const double length = radius * (coarse ? 1 : Vector3d(d.data()).norm());
      body.slabs.push_back(slab_around(body.path, -length, length, d));
    }
    return body;
  }
  void insert(std::size_t count) {
    std::vector<typename BroadPhase<Degree>::Entry> entries;
    for (BodySlot id = 0; entries.size() < count; ++id) {
      if (bodies.contains(id)) continue;
      bodies[id] = make();
      entries.push_back({id, &bodies[id].box});
    }
    broad_phase.insert(entries, now, pairs);
  }
  void change() {
    const BodySlot id = std::next(bodies.begin(), static_cast<std::ptrdiff_t>(random.below(bodies.size())))->first;
    if (random.one_in(5)) {
      broad_phase.remove(id, now, pairs);
      bodies.erase(id);
      return insert(1);
    }
    bodies[id] = make();
    broad_phase.update(id, bodies[id].box, now, pairs);
  }
  void advance(double t) {
    while (broad_phase.next_time() <= t) {
      now = std::max(now, broad_phase.next_time());
      broad_phase.advance(broad_phase.next_time(), pairs);
    }
    now = t;
    broad_phase.audit(now);
  }
  /// How many pairs are told wrongly, and whose boxes alone overlap.
  int compare() {
    int wrong = 0;
    for (const auto& [a, body_a] : bodies) {
      for (const auto& [b, body_b] : bodies) {
        if (!(a < b)) continue;
        const bool boxes = oracle::overlap_after(exact(body_a.box), exact(body_b.box), now);
        bool overlap = boxes;
        for (std::size_t i = 0; i < more.size(); ++i) {
          const auto apart = [&](const KineticSlab<Degree>& left, const KineticSlab<Degree>& right) {
            return (polynomial(right.min) - polynomial(left.max)).sign_after(oracle::rational(now)) >= 0;
          };
          if (!overlap) break;
          overlap = !apart(body_a.slabs[i], body_b.slabs[i]) && !apart(body_b.slabs[i], body_a.slabs[i]);
        }
        wrong += overlap != pairs.now.contains({a, b});
        pruned += boxes && !overlap;
      }
    }
    return wrong;
  }

  Random random;
  bool coarse;
  std::vector<KdopDirection> more;
  std::map<BodySlot, Body> bodies;
  KineticSweepAndPrune<Degree> broad_phase;
  ListedPairs pairs;
  double now = 0;
  std::size_t pruned = 0;
};

}  // namespace

TEMPLATE_TEST_CASE_SIG("Kinetic sweep and prune over k-DOPs under stress", "[kdop][broad_phase]",
                       ((int Degree), Degree), 1, 2) {
  std::size_t reports = 0, pruned = 0;
  std::uint64_t seed = 1230;
  for (const ListedAxes listed : {ListedAxes::automatic, ListedAxes::one, ListedAxes::all}) {
    for (const bool coarse : {false, true}) {
      const int k = std::array{14, 18, 26}[++seed % 3];
      CAPTURE(Degree, static_cast<int>(listed), k, coarse, seed);
      Dops<Degree> dops(seed, coarse, k, listed);
      dops.insert(20);
      int wrong = dops.compare();
      for (int round = 0; round < 24; ++round) {
        dops.advance(dops.now + (coarse ? 0.0625 * dops.random.integer(0, 2) : dops.random.between(0, 0.15)));
        if (round % 4 == 0) wrong += dops.compare();
        dops.change();
        dops.advance(dops.now);
        if (round % 4 == 2) wrong += dops.compare();
        if (round == 12) dops.insert(21);  // a reason to choose another list
      }
      CHECK(wrong == 0);
      reports += dops.pairs.reports;
      pruned += dops.pruned;
    }
  }
  CHECK(reports > 500);
  CHECK(pruned > 100);
}

TEST_CASE("The list may be in any direction", "[kdop][broad_phase]") {
  Random random(1250);
  std::vector<KineticBox<1>> boxes;
  std::vector<std::vector<KineticSlab<1>>> slabs;
  const auto more = directions(18);
  for (int i = 0; i < 100; ++i) {
    certificates::PointMotion<1> path;
    const double far = 100 * random.unit();  // along (1, -1, 0), which is the second of them
    const double height = random.unit(), speed = random.unit();
    path.coefficients = {Vector3d(far, -far, height), Vector3d(speed, speed, 0)};
    boxes.push_back(box_around(path, Vector3d::Constant(-0.1), Vector3d::Constant(0.1)));
    slabs.emplace_back();
    for (const auto& d : more) slabs.back().push_back(slab_around(path, -0.1, 0.1, d));
  }
  std::vector<KineticSweepAndPrune<1>::Entry> entries;
  for (BodySlot id = 0; id < 100; ++id) entries.push_back({id, &boxes[id]});
  KineticSweepAndPrune<1> broad_phase(0, {}, {more, [&](BodySlot id, std::size_t i, double) { return slabs[id][i]; }});
  ListedPairs pairs;
  broad_phase.insert(entries, 0, pairs);
  CHECK(broad_phase.listed_axes() == 1u << 4);
  broad_phase.audit(0);
}

TEST_CASE("A k-DOP that is not finite is refused by name", "[kdop]") {
  certificates::PointMotion<1> path;
  path.coefficients = {Vector3d::Constant(1e308), Vector3d::Zero()};
  const KineticBox<1> box = box_around(path, Vector3d::Constant(-1), Vector3d::Constant(1));
  KineticSweepAndPrune<1> broad_phase(0, {}, {directions(14), [&](BodySlot, std::size_t i, double) {
                                                return slab_around(path, -2, 2, directions(14)[i]);
                                              }});
  const KineticSweepAndPrune<1>::Entry entry{7, &box};
  ListedPairs pairs;
  CHECK_THROWS_WITH(broad_phase.insert({&entry, 1}, 0, pairs), Catch::Matchers::Contains("body 7"));
}

}  // namespace kds::collision::test_kdop_sweep
