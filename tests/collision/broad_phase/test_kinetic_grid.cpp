// The kinetic grid, and the broad phase that chooses, by themselves, against brute force over exact numbers.
#include "collision/broad_phase/adaptive_broad_phase.hpp"
#include "collision/broad_phase/kinetic_grid.hpp"
#include "kds/audit.hpp"
#include "tests/collision/broad_phase/broad_phase_stress.hpp"
#include "tests/collision/broad_phase/kept_boxes.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <memory>
#include <set>
#include <utility>
#include <vector>

namespace kds::collision::test_kinetic_grid {
namespace {

using namespace tests;

template <int Degree>
std::unique_ptr<BroadPhase<Degree>> make(bool chooses) {
  if (chooses) return with_boxes<AdaptiveBroadPhase, Degree>(std::size_t{1}, AdaptiveTuning{.most_for_few = 8});
  return with_boxes<KineticGrid, Degree>();
}

TEMPLATE_TEST_CASE_SIG("The kinetic grid has all pairs that overlap, whatever happens", "[broad_phase]",
                       ((int Degree), Degree), 1, 2) {
  const bool chooses = GENERATE(false, true);
  std::size_t reports = 0;
  std::size_t events = 0;
  std::size_t choices = 0;
  for (const bool coarse : {false, true}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      INFO("degree " << Degree << (coarse ? ", coarse" : ", fine") << " numbers, seed " << seed
                     << (chooses ? ", choosing" : ""));
      Stress<Degree> stress(seed, coarse, make<Degree>(chooses));
      stress.insert(14);
      stress.compare_with_brute_force();
      for (int round = 0; round < 80; ++round) {
        stress.advance(stress.now + (coarse ? 0.25 * stress.random.integer(0, 4) : stress.random.between(0, 1)));
        stress.compare_with_brute_force();
        // Between a few and many, so that the choice is made anew.
        const auto dice = stress.random.below(12);
        const bool fewer = (round / 20) % 2 != 0;
        const auto before = stress.broad_phase.name();
        if (dice < 3 && (!fewer || stress.boxes.size() < 2)) {
          stress.insert(1 + stress.random.below(4));
        } else if (dice < 9 && fewer) {
          for (int i = 0; i < 2 && stress.boxes.size() > 1; ++i) stress.remove();
        } else {
          stress.update();
        }
        choices += before != stress.broad_phase.name();
        stress.compare_with_brute_force();
        stress.broad_phase.audit(stress.now);
      }
      reports += stress.pairs.reports;
      events += stress.events;
    }
  }
  CHECK(reports > 1000);
  CHECK(events > 300);
  CHECK((choices >= 8) == chooses);
}

KineticBox<1> cube(const Vector3d& at, const Vector3d& velocity, double now = 0) {
  certificates::PointMotion<1> centre;
  centre.coefficients = {at, velocity};
  centre.start = now;
  return box_around(centre, Vector3d::Constant(-0.5), Vector3d::Constant(0.5));
}

TEST_CASE("A body at rest costs nothing while time goes on, and starts when it is told to", "[broad_phase]") {
  std::vector<KineticBox<1>> boxes{cube({0, 0, 0}, Vector3d::Zero()), cube({10, 0, 0}, Vector3d::Zero())};
  KineticGrid<1> grid(boxes_of(boxes));
  ListedPairs pairs;
  const std::vector<KineticGrid<1>::Entry> entries{{0, &boxes[0]}, {1, &boxes[1]}};
  grid.insert(entries, 0, pairs);
  CHECK(grid.next_time() == never);
  CHECK(!grid.advance(1e9, pairs));
  boxes[1] = cube({10, 0, 0}, {-1, 0, 0}, 5);
  grid.update(1, boxes[1], 5, pairs);
  CHECK(grid.next_time() < never);
  while (grid.advance(20, pairs)) {
  }
  CHECK(pairs.reports == 2);  // it has passed the other
  CHECK(pairs.now.empty());
}

TEST_CASE("Bodies that fly apart are soon left alone", "[broad_phase]") {
  std::vector<KineticBox<1>> boxes;
  KineticGrid<1> grid(boxes_of(boxes));
  ListedPairs pairs;
  for (int i = 0; i < 20; ++i) boxes.push_back(cube({2.0 * i, 0, 0}, {0.1 * i, 0, 0}));
  std::vector<KineticGrid<1>::Entry> entries;
  for (BodySlot id = 0; id < 20; ++id) entries.push_back({id, &boxes[id]});
  grid.insert(entries, 0, pairs);
  while (grid.advance(1e6, pairs)) {
  }
  // Fat boxes are the longer the farther there is nothing: far fewer renewals than lengths travelled.
  CHECK(grid.counters().box_updates < 5000);
  while (grid.next_time() < never) grid.advance(grid.next_time(), pairs);  // to the end of time
  CHECK(grid.counters().box_updates < 200'000);
}

TEST_CASE("Clocks so large that a body moves by its size between two doubles do not stop the kinetic grid",
          "[broad_phase]") {
  const double now = 0x1p60;  // where doubles are 256 apart
  const std::vector<KineticBox<1>> boxes{cube({0, 0, 0}, {1, 0, 0}, now), cube({5000, 0, 0}, Vector3d::Zero(), now)};
  KineticGrid<1> grid(boxes_of(boxes));
  ListedPairs pairs;
  const std::vector<KineticGrid<1>::Entry> entries{{0, &boxes[0]}, {1, &boxes[1]}};
  grid.insert(entries, now, pairs);
  while (grid.advance(now + 8192, pairs)) {
  }
  CHECK(pairs.since.contains({0, 1}));
  CHECK(pairs.now.empty());
}

TEST_CASE("Boxes without extent move on in the kinetic grid too", "[broad_phase]") {
  std::vector<KineticBox<1>> boxes;
  certificates::PointMotion<1> path;
  path.coefficients = {Vector3d(0, 0, 0), Vector3d(1, 0, 0)};
  boxes.push_back({path, path});
  path.coefficients = {Vector3d(7, 0, 0), Vector3d(0, 0, 0)};
  boxes.push_back({path, path});
  KineticGrid<1> grid(boxes_of(boxes));
  ListedPairs pairs;
  const std::vector<KineticGrid<1>::Entry> entries{{0, &boxes[0]}, {1, &boxes[1]}};
  grid.insert(entries, 0, pairs);
  while (grid.advance(10, pairs)) {
  }
  CHECK(pairs.since.contains({0, 1}));
  CHECK(grid.counters().box_updates < 5000);
}

TEST_CASE("An audit of the kinetic grid sees a body outside its fat box", "[broad_phase]") {
  const std::vector<KineticBox<1>> boxes{cube({0, 0, 0}, {1, 0, 0})};
  KineticGrid<1> grid(boxes_of(boxes));
  ListedPairs pairs;
  const std::vector<KineticGrid<1>::Entry> entries{{0, &boxes[0]}};
  grid.insert(entries, 0, pairs);
  grid.audit(0);
  CHECK_THROWS_AS(grid.audit(-100), AuditFailure);
}

class PairSet final : public PairListener {
 public:
  void pair_began(BodySlot a, BodySlot b, double) override { twice += !pairs.insert({a, b}).second; }
  void pair_ended(BodySlot a, BodySlot b, double) override { pairs.erase({a, b}); }

  std::set<std::pair<BodySlot, BodySlot>> pairs;
  int twice = 0;
};

TEST_CASE("Thousands that come at once have the pairs of their fat boxes", "[broad_phase]") {
  kds::tests::Random random(31);
  constexpr std::size_t count = 5000;
  std::vector<KineticBox<1>> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    certificates::PointMotion<1> motion;
    for (int d = 0; d < 3; ++d) {
      motion.coefficients[0][d] = random.between(0, d == 2 ? 4 : 40);
      motion.coefficients[1][d] = i % 5 == 0 ? 0 : random.between(-1, 1);
    }
    const Eigen::Vector3d half_edges = Eigen::Vector3d::Constant(i % 100 == 0 ? 3 : 0.5);
    boxes.push_back(box_around(motion, -half_edges, half_edges));
  }
  std::vector<BroadPhase<1>::Entry> entries;
  for (std::size_t i = 0; i < count; ++i) entries.push_back({static_cast<BodySlot>(3 * (count - i)), &boxes[i]});
  KineticGrid<1> grid([&](BodySlot id) { return boxes.at(count - id / 3); });
  PairSet found;
  grid.extend_horizon(0, never);
  grid.insert(entries, 0, found);
  grid.audit(0);
  CHECK(grid.size() == count);
  const auto check = [&] {
    std::size_t wrong = 0;
    std::size_t expected = 0;
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < i; ++j) {  // ids fall
        const bool paired = grid.paired(entries[i].slot, entries[j].slot);
        expected += paired;
        wrong += paired && !found.pairs.contains({entries[i].slot, entries[j].slot});
      }
    }
    CHECK(wrong == 0);
    CHECK(expected == found.pairs.size());
    CHECK(expected > count);
    CHECK(found.twice == 0);
  };
  check();
  while (grid.advance(0.5, found)) {
  }
  grid.audit(0.5);
  check();
}

}  // namespace
}  // namespace kds::collision::test_kinetic_grid
