// What takes the place of outer rules that edit inner ones: listeners that edit elements, at the time of the event.
#include "examples/smallest_gap.hpp"
#include "kds/framework/history.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "structures/points_inside.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

namespace test_edits_from_above {
namespace {

using namespace kds;
using namespace kds::tests;
using examples::ListRule;
using examples::SmallestGapRule;
using structures::BallRegion;
using structures::PointsInsideRule;

using Value = Motion<2>;
using List = Kinetic<ListRule<Value>>;

/// Of two values that become the closest to each other the one with the greater id goes.
struct ThinsOut {
  MovingSet<Value>* values;
  void operator()(const SmallestGapRule& rule, const KineticEvent& event) const {
    if (event.effect == Effect::internal) return;
    values->process_due(event.time);  // Other events of this time come before an edit: this is called for them then.
    if (values->size() > 4) values->remove((*rule.pair())[1], event.time);
  }
};

using Path = certificates::PlaneMotion<1>;
using View = BallRegion<Path>;

/// When a point has left a view, that follows it.
struct Follows {
  MovingSet<Path>* points;
  MovingSet<View>* views;
  std::vector<double>* times;
  void operator()(const PointsInsideRule<View>& inside, const KineticEvent& event) const {
    if (inside.count(0) > 0) return;
    View view = (*views)[0];
    view.centre = (*points)[0];  // where it is, and as it moves
    views->update(0, view, event.time);
    times->push_back(event.time);
  }
};

/// Edits the elements from within follow().
struct Meddles : StandsOn<ListRule<Value>> {
  static constexpr const char* name = "Meddles";
  MovingSet<Value>* values = nullptr;
  std::optional<certificates::Order<2>> certificate(Slot, const MovingSet<Value>&) const { return {}; }
  std::array<Id, 0> members(Slot) const { return {}; }
  Effect repair(Slot, Repair<Value>&) { return Effect::internal; }
  Effect follow(std::span<const examples::NewNeighbour>, Repair<Value>& repair) {
    if (values != nullptr) values->remove(1, repair.now());
    return Effect::internal;
  }
};

}  // namespace

TEST_CASE("a listener of an outer structure edits the elements of the inner one", "[standing_on]") {
  for (std::uint64_t seed = 380; seed < 386; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const Kind kind = seed % 2 == 0 ? Kind::generic : Kind::lattice;
    MovingSet<Value> values;
    for (Id id = 0; id < 20; ++id) values.insert(id, random_motion<2>(random, kind, 0), 0);
    List list(values, 0);
    Kinetic<SmallestGapRule, ThinsOut> gap(list, 0, {}, {&values});
    Simulator simulator(0, list, gap);
    History history(4, simulator, values);
    while (history.step(3)) {
      simulator.audit();
      CHECK(list.rule().order.size() == values.size());
    }
    const std::vector<Id> left = values.ids();
    CHECK(left.size() < 20);
    history.roll_back(0);
    CHECK(values.size() > left.size());
    history.advance_to(3);
    CHECK(values.ids() == left);
  }
}

TEST_CASE("a listener of an outer structure edits what it stands on, of another type", "[standing_on]") {
  MovingSet<Path> points;
  MovingSet<View> views;
  std::vector<double> times;
  points.insert(0, {{{{{0, 1}}, {{0, 0}}}}, 0}, 0);                  // to the right
  views.insert(0, {{{{{{0, 0}}, {{0, 0}}}}, 0}, {{{2, 0}}, 0}}, 0);  // at rest, of radius 2
  Kinetic<ElementsRule<View>> set(views, 0);
  Kinetic<PointsInsideRule<View>, Follows> inside(points, set, 0, {}, {&points, &views, &times});
  Simulator simulator(0, set, inside);
  simulator.advance_to(5);
  simulator.audit();
  CHECK(times == std::vector<double>{2});
  CHECK(inside.rule().contains(0, 0));
  points.update(0, {{{{{5, -1}}, {{0, 0}}}}, 5}, 5);  // turns round, and leaves a view that goes on: 2 apart at 6
  simulator.advance_to(7);
  simulator.audit();
  CHECK(times == std::vector<double>{2, 6});
  CHECK(inside.rule().contains(0, 0));
}

TEST_CASE("a rule that edits from within is refused", "[standing_on]") {
  MovingSet<Value> values;
  for (Id id = 0; id < 3; ++id) values.insert(id, {{{1.0 * id, 0, 0}}, 0}, 0);
  List list(values, 0);
  Kinetic<Meddles> meddles(list, 0);
  meddles.edit([&](Meddles& rule, auto&) { rule.values = &values; }, 0);
  CHECK_THROWS_WITH(values.remove(0, 0), Catch::Contains("nothing can be edited from within it"));
}

}  // namespace test_edits_from_above
