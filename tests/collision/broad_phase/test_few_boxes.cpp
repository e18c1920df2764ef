// A few boxes compared with each other: the contract of broad phases, and when spans end.
#include "collision/broad_phase/few_boxes.hpp"
#include "kds/audit.hpp"
#include "tests/collision/broad_phase/broad_phase_stress.hpp"

#include <catch2/catch.hpp>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::collision::test_few_boxes {
namespace {

using namespace tests;

KineticBox<1> cube(const Vector3d& at, const Vector3d& velocity, double now = 0) {
  certificates::PointMotion<1> centre;
  centre.coefficients = {at, velocity};
  centre.start = now;
  return box_around(centre, Vector3d::Constant(-0.5), Vector3d::Constant(0.5));
}

/// All ids from 0 on.
std::vector<FewBoxes<1>::Entry> entries_of(const std::vector<KineticBox<1>>& boxes) {
  std::vector<FewBoxes<1>::Entry> entries;
  for (const auto& box : boxes) entries.push_back({static_cast<BodySlot>(entries.size()), &box});
  return entries;
}

TEMPLATE_TEST_CASE_SIG("Few boxes have all pairs that overlap, whatever happens", "[broad_phase]",
                       ((int Degree), Degree), 1, 2) {
  std::size_t reports = 0;
  std::size_t events = 0;
  for (const bool windows : {false, true}) {
    for (const bool coarse : {false, true}) {
      for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        INFO("degree " << Degree << (coarse ? ", coarse" : ", fine") << " numbers, seed " << seed
                       << (windows ? ", horizons" : ""));
        Stress<Degree> stress(seed, coarse, std::make_unique<FewBoxes<Degree>>());
        double horizon = windows ? 1 : never;
        stress.broad_phase.extend_horizon(0, horizon);
        stress.insert(10);
        stress.compare_with_brute_force();
        for (int round = 0; round < 50; ++round) {
          const double next = stress.now + (coarse ? 0.25 * stress.random.integer(0, 4) : stress.random.between(0, 1));
          if (next > horizon) {
            stress.advance(horizon);
            stress.broad_phase.extend_horizon(horizon, horizon + 1);
            horizon += 1;
          }
          stress.advance(next);
          stress.compare_with_brute_force();
          const auto dice = stress.random.below(12);
          if (dice < 2 && stress.boxes.size() < 14) {
            stress.insert(1 + stress.random.below(4));
          } else if (dice < 4 && stress.boxes.size() > 1) {
            stress.remove();
          } else {
            stress.update();
          }
          stress.compare_with_brute_force();
          stress.broad_phase.audit(stress.now);
        }
        reports += stress.pairs.reports;
        events += stress.events;
      }
    }
  }
  CHECK(reports > 500);
  CHECK(events > 25);
}

TEST_CASE("As many boxes as fit are compared with each other, and one more is refused", "[broad_phase]") {
  FewBoxes<1> few;
  ListedPairs pairs;
  constexpr std::size_t count = FewBoxes<1>::most;
  std::vector<KineticBox<1>> boxes;  // a row, each overlaps the next
  for (std::size_t i = 0; i <= count; ++i) boxes.push_back(cube({0.75 * static_cast<double>(i), 0, 0}, {0, 0, 0}));
  auto entries = entries_of(boxes);
  CHECK_THROWS_AS(few.insert(entries, 0, pairs), std::length_error);
  CHECK(few.size() == 0);
  entries.pop_back();
  few.insert(entries, 0, pairs);
  few.audit(0);
  std::size_t wrong = 0;
  for (BodySlot a = 0; a < count; ++a) {
    for (BodySlot b = a + 1; b < count; ++b) wrong += few.paired(a, b) != (b == a + 1);
  }
  CHECK(wrong == 0);
  CHECK(pairs.now.size() == count - 1);
  few.remove(0, 0, pairs);
  few.audit(0);
  CHECK_FALSE(few.paired(1, count - 1));
  CHECK(few.paired(count - 2, count - 1));
  CHECK(pairs.now.size() == count - 2);
}

TEST_CASE("A span that ends at the horizon is renewed only when there is a later one", "[broad_phase]") {
  FewBoxes<1> few;
  ListedPairs pairs;
  const std::vector<KineticBox<1>> boxes{cube({0, 0, 0}, {0.25, 0, 0}), cube({3, 0, 0}, {0, 0, 0})};
  few.extend_horizon(0, 1);
  few.insert(entries_of(boxes), 0, pairs);
  CHECK(few.next_time() == never);
  CHECK_FALSE(few.advance(1, pairs));
  CHECK(pairs.reports == 0);
  few.extend_horizon(1, 1000);
  CHECK(few.next_time() == 1);
  while (few.advance(1000, pairs)) few.audit(few.next_time());
  CHECK(pairs.since.contains({0, 1}));
  CHECK(pairs.now.empty());  // it has passed the other
  few.audit(1000);
  CHECK(few.counters().certificates < 30);  // spans get longer while nothing happens
}

TEST_CASE("Bodies at rest have one span for all time", "[broad_phase]") {
  FewBoxes<1> few;
  ListedPairs pairs;
  const std::vector<KineticBox<1>> boxes{cube({0, 0, 0}, {0, 0, 0}), cube({3, 0, 0}, {0, 0, 0})};
  few.insert(entries_of(boxes), 0, pairs);
  CHECK_FALSE(few.advance(1e300, pairs));
  CHECK(pairs.reports == 0);
  CHECK(few.counters().certificates == 1);
  few.update(0, cube({0, 0, 0}, {1, 0, 0}, 5), 5, pairs);
  few.audit(6);
  CHECK(pairs.now.contains({0, 1}));
}

TEST_CASE("Few boxes go on where a body moves by its size between two doubles", "[broad_phase]") {
  FewBoxes<1> few;
  ListedPairs pairs;
  const double now = 0x1p60;  // where doubles are 256 apart
  const std::vector<KineticBox<1>> boxes{cube({0, 0, 0}, {1, 0, 0}, now), cube({5000, 0, 0}, {0, 0, 0}, now)};
  few.insert(entries_of(boxes), now, pairs);
  while (few.advance(now + 65536, pairs)) {
  }
  CHECK(pairs.since.contains({0, 1}));
}

TEST_CASE("An audit of few boxes sees a body outside its box", "[broad_phase]") {
  FewBoxes<1> few;
  ListedPairs pairs;
  const std::vector<KineticBox<1>> boxes{cube({0, 0, 0}, {1, 0, 0})};
  few.insert(entries_of(boxes), 0, pairs);
  few.audit(0);
  CHECK_THROWS_AS(few.audit(-100), AuditFailure);
}

}  // namespace
}  // namespace kds::collision::test_few_boxes
