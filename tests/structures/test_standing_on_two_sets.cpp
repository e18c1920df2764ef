// A rule on two triangulations of different points: the order of what happens at one time, and mistakes.
#include "kds/framework/history.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "structures/delaunay.hpp"
#include "tests/structures/random_values.hpp"
#include "tests/structures/told_edges.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <map>
#include <span>
#include <stdexcept>
#include <vector>

namespace test_standing_on_two_sets {
namespace {

using namespace kds;
using namespace kds::tests;
using structures::EdgeChange;

using Path = certificates::PlaneMotion<1>;
using Delaunay = structures::DelaunayRule<Path>;

/// On two of one type, over elements of two sets: writes down by which it has been told, and when.
struct BothRule : StandsOn<Delaunay, Delaunay>, Quiet<Path> {
  static constexpr const char* name = "Both";
  std::array<EdgesTold, 2> edges{};
  struct Call {
    double time;
    std::size_t place;
    auto operator<=>(const Call&) const = default;
  };
  std::vector<Call> log{};
  bool throws = false;

  Effect repair(Slot, Repair<Path>&) { return Effect::internal; }
  template <std::size_t I>
  Effect follow(From<I>, std::span<const EdgeChange> changes, Repair<Path>& repair) {
    if (throws) throw std::runtime_error("on purpose");
    for (const EdgeChange& change : changes) edges[I].take(change);
    log.push_back({repair.now(), I});
    return Effect::external;
  }
  template <class Archive>
  void archive(Archive& archive) {
    archive(edges[0], edges[1], log);
  }
};

struct TwoSets {
  MovingSet<Path> left{}, right{}, own{};  // the last has no elements
  Kinetic<Delaunay> first{left, 0}, second{right, 0};
  Kinetic<BothRule> both{own, {first, second}, 0};

  /// The same motions in both, so that all their events are at the same times.
  explicit TwoSets(std::uint64_t seed, Id count = 12) {
    Random random(seed);
    for (Id id = 0; id < count; ++id) {
      const Path path = random_plane_motion<1>(random, Kind::generic, 0);
      left.insert(id, path, 0);
      right.insert(id, path, 0);
    }
  }
  bool right_edges() const {
    const auto same = [](const EdgesTold& told, const Delaunay& delaunay) {
      std::size_t there = 0;
      for (std::uint32_t edge = 0; edge < delaunay.edges().end(); ++edge) there += delaunay.edges().contains(edge);
      return there == told.ends.size() && std::all_of(told.ends.begin(), told.ends.end(), [&](const auto& edge) {
               return delaunay.edges().contains(edge.first) && delaunay.edges().ends(edge.first) == edge.second;
             });
    };
    return same(both.rule().edges[0], first.rule()) && same(both.rule().edges[1], second.rule());
  }
};

}  // namespace

TEST_CASE("events of one time are taken up in the order of the simulator", "[standing_on]") {
  for (std::uint64_t seed = 340; seed < 344; ++seed) {
    CAPTURE(seed);
    TwoSets sets(seed);
    Simulator simulator(0, sets.first, sets.second, sets.both);
    History history(5, simulator, sets.left, sets.right);
    history.advance_to(1);
    const auto& log = sets.both.rule().log;
    REQUIRE(sets.both.measures().followed > 10);
    const auto edits = [](const BothRule::Call& call) { return call.time == 0; };
    CHECK(std::is_sorted(std::find_if_not(log.begin(), log.end(), edits), log.end()));
    std::map<double, std::array<int, 2>> at;
    for (const auto& [time, place] : log) ++at[time][place];
    for (const auto& [time, count] : at) CHECK((time == 0 || count[0] == count[1]));
    history.edit([&] { sets.right.remove(3, simulator.now()); });
    history.advance_to(2);
    history.edit([&] { sets.left.update(4, sets.left[5], simulator.now()); });
    history.advance_to(3);
    simulator.audit();
    CHECK(sets.right_edges());
    const auto whole = log;
    history.roll_back(0.5);
    CHECK(sets.right_edges());
    history.advance_to(1);
    CHECK(std::equal(log.begin(), log.end(), whole.begin()));
  }
}

TEST_CASE("an edit of one set comes after what is due in structures on the other", "[standing_on]") {
  TwoSets sets(350);
  Simulator simulator(0, sets.first, sets.second, sets.both);
  const double due = simulator.next_time();  // of both
  REQUIRE(due < never);
  sets.left.update(0, sets.left[1], due);  // before any of the two has been processed
  CHECK(sets.second.next_time() > due);
  CHECK(sets.right_edges());
  simulator.advance_to(due);
  simulator.audit();
}

TEST_CASE("a structure says which mistake has been made with what it stands on", "[standing_on]") {
  TwoSets sets(370);
  SECTION("one of them is not in the simulator") {
    Simulator simulator(0, sets.first, sets.both);
    CHECK_THROWS_WITH(simulator.advance_to(3), Catch::Contains("Both: what it stands on has passed over the event"));
  }
  SECTION("one of them has been loaded without it") {
    Simulator all(0, sets.first, sets.second, sets.both);
    Simulator alone(0, sets.second);
    const Snapshot before = save(alone, sets.right);
    all.advance_to(1);
    restore(before, alone, sets.right);
    CHECK_THROWS_WITH(sets.both.audit(1),
                      Catch::Contains("Both: a structure that it stands on has changed without it"));
  }
  SECTION("its rule throws: then none of those that have been called can be used") {
    sets.both.edit([](BothRule& rule, auto&) { rule.throws = true; }, 0);
    CHECK_THROWS_WITH(sets.left.remove(0, 0), "on purpose");
    CHECK_THROWS_WITH(sets.left.remove(1, 0), Catch::Contains("or has thrown"));
    CHECK_THROWS_WITH(sets.right.remove(1, 0), Catch::Contains("or has thrown"));
  }
}

}  // namespace test_standing_on_two_sets
