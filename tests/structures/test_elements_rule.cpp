// Rules about elements of two types, and edits of rules: points in rectangles that move, grow and are redrawn.
#include "kds/framework/elements_rule.hpp"
#include "kds/framework/history.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/framework/reverse.hpp"
#include "kds/simulator.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace test_elements_rule {
namespace {

using namespace kds;
using namespace kds::tests;
using Point = certificates::PlaneMotion<1>;

/// Two corners.
struct Rectangle {
  Point low, high;
  bool finite() const { return kds::detail::finite(low) && kds::detail::finite(high); }
  friend Rectangle reversed(const Rectangle& r) { return {reversed(r.low), reversed(r.high)}; }
};

/// sign (a - b) >= margin, of two coordinates.
struct Beyond {
  static constexpr int degree = 1;
  Motion<1> a, b;
  double sign;
  double margin;

  template <class Number>
  auto polynomial(double epoch) const {
    return difference_about<Number>(a, b, epoch) * sign - constant<Number>(margin);
  }
};

/// Which points are in which rectangles, these enlarged by a margin. Slot: 4 (point + most * rectangle) + side.
struct InsideRule : StandsOn<ElementsRule<Rectangle>> {
  using Element = Point;
  static constexpr const char* name = "Inside";
  static constexpr Id most = 32;
  double margin = 0;
  std::vector<std::array<bool, 4>> within{};  ///< by point + most * rectangle: on the inner side of each edge

  bool contains(Id rectangle, Id point) const {
    return within[pair(rectangle, point)] == std::array{true, true, true, true};
  }
  static std::size_t pair(Id rectangle, Id point) { return point + std::size_t{most} * rectangle; }

  Beyond inside(Id rectangle, Id point, Slot side, const MovingSet<Point>& x) const {
    const int axis = side % 2;
    const Rectangle& r = inner()[rectangle];
    if (side < 2) return {x[point].axis(axis), r.low.axis(axis), 1, -margin};
    return {x[point].axis(axis), r.high.axis(axis), -1, -margin};
  }
  Beyond certificate(Slot slot, const MovingSet<Point>& x) const {
    const Id point = slot / 4 % most, rectangle = slot / 4 / most;
    Beyond holds = inside(rectangle, point, slot % 4, x);
    if (!within[slot / 4][slot % 4]) holds.sign = -holds.sign, holds.margin = -holds.margin;
    return holds;
  }
  std::array<Id, 1> members(Slot slot) const { return {slot / 4 % most}; }
  Effect repair(Slot slot, Repair<Point>&) {
    auto& bit = within[slot / 4][slot % 4];
    bit = !bit;
    return Effect::external;
  }
  Effect follow(std::span<const ElementChange> changes, Repair<Point>& repair) {
    for (const auto& [what, rectangle] : changes) {
      for (const Id point : repair.elements().ids()) {
        what == ElementChange::What::goes ? retire(rectangle, point, repair) : look(rectangle, point, repair);
      }
    }
    return Effect::external;
  }
  void insert(Id point, Repair<Point>& repair) {
    for (const Id rectangle : inner().elements().ids()) look(rectangle, point, repair);
  }
  void remove(Id point, Repair<Point>& repair) {
    for (const Id rectangle : inner().elements().ids()) retire(rectangle, point, repair);
  }
  void look(Id rectangle, Id point, Repair<Point>& repair) {
    const std::size_t i = pair(rectangle, point);
    if (within.size() <= i) within.resize(i + 1);
    for (Slot side = 0; side < 4; ++side) {
      within[i][side] = repair.sign(inside(rectangle, point, side, repair.elements())) >= 0;
      repair.certify(static_cast<Slot>(4 * i) + side);
    }
  }
  static void retire(Id rectangle, Id point, Repair<Point>& repair) {
    for (Slot side = 0; side < 4; ++side) repair.retire(static_cast<Slot>(4 * pair(rectangle, point)) + side);
  }
  /// To be called by Kinetic::edit().
  void set_margin(double wanted, Repair<Point>& repair) {
    margin = wanted;
    for (const Id point : repair.elements().ids()) insert(point, repair);
  }
  template <class Archive>
  void archive(Archive& archive) {
    archive(margin, within);
  }
};

/// Sets, structures and clock.
struct Scene {
  MovingSet<Point> points{};
  MovingSet<Rectangle> rectangle_set{};
  Kinetic<ElementsRule<Rectangle>> rectangles{rectangle_set, 0};
  Kinetic<InsideRule> inside{points, rectangles, 0};
  Simulator<Kinetic<ElementsRule<Rectangle>>, Kinetic<InsideRule>> simulator{0, rectangles, inside};

  /// States that are not those of the motions, exactly.
  int wrong() const {
    int count = 0;
    for (const Id r : rectangle_set.ids()) {
      for (const Id p : points.ids()) {
        bool in = true;
        for (int axis = 0; axis < 2; ++axis) {
          const double margin = inside.rule().margin;
          const Motion<1> low = rectangle_set[r].low.axis(axis), high = rectangle_set[r].high.axis(axis);
          in = in && sign_after(Beyond{points[p].axis(axis), low, 1, -margin}, simulator.now()) >= 0 &&
               sign_after(Beyond{high, points[p].axis(axis), 1, -margin}, simulator.now()) >= 0;
        }
        count += in != inside.rule().contains(r, p);
      }
    }
    return count;
  }
  int run_to(double t) {
    int count = 0;
    while (simulator.step(t)) {
      simulator.audit();
      if (simulator.next_time() > simulator.now()) count += wrong();
    }
    simulator.advance_to(t);
    return count + wrong();
  }
};

Rectangle random_rectangle(Random& random, Kind kind, double now) {
  return {random_plane_motion<1>(random, kind, now), random_plane_motion<1>(random, kind, now)};
}

}  // namespace

TEST_CASE("points in rectangles: a rule about elements of two sets", "[standing_on]") {
  std::uint64_t events = 0, edits = 0;
  for (const Kind kind : {Kind::generic, Kind::lattice, Kind::resting, Kind::scales}) {
    for (std::uint64_t seed = 400; seed < 404; ++seed) {
      CAPTURE(static_cast<int>(kind), seed);
      Random random(seed);
      Scene scene;
      for (Id id = 0; id < 8; ++id) scene.points.insert(id, random_plane_motion<1>(random, kind, 0), 0);
      for (Id id = 0; id < 3; ++id) scene.rectangle_set.insert(id, random_rectangle(random, kind, 0), 0);
      int wrong = scene.wrong();
      History history(20, scene.simulator, scene.points, scene.rectangle_set);
      for (int step = 0; step < 12; ++step) {
        wrong += scene.run_to(scene.simulator.now() + random_delay(random, kind));
        const double now = scene.simulator.now();
        const Id point = static_cast<Id>(random.below(8)), rectangle = static_cast<Id>(random.below(3));
        const std::size_t choice = random.below(5);
        if (choice == 0) scene.points.update(point, random_plane_motion<1>(random, kind, now), now);
        if (choice == 1) scene.rectangle_set.update(rectangle, random_rectangle(random, kind, now), now);
        if (choice == 2) {
          scene.rectangle_set.remove(rectangle, now);
          scene.rectangle_set.insert(rectangle, random_rectangle(random, kind, now), now);
        }
        if (choice == 3) {
          scene.points.remove(point, now);
          scene.points.insert(point, random_plane_motion<1>(random, kind, now), now);
        }
        if (choice == 4) {
          const double margin = random.integer(-1, 2);
          scene.inside.edit([&](InsideRule& rule, auto& repair) { rule.set_margin(margin, repair); }, now);
          ++edits;
        }
        scene.simulator.audit();
        wrong += scene.wrong();
      }
      const double end = scene.simulator.now();
      reverse(scene.simulator, scene.points, scene.rectangle_set);
      wrong += scene.run_to(scene.simulator.now() + 1);
      reverse(scene.simulator, scene.points, scene.rectangle_set);
      wrong += scene.run_to(end);
      CHECK(wrong == 0);
      events += scene.inside.measures().events;
    }
  }
  CHECK(events > 500);
  CHECK(edits > 10);
}

TEST_CASE("an edit of a rule comes after the events of its time, and is rolled back", "[edits]") {
  Scene scene;
  const auto at = [](double x, double vx) { return Point{{{{{x, vx}}, {{0, 0}}}}, 0}; };
  scene.points.insert(0, at(0, 1), 0);
  scene.rectangle_set.insert(0, {{{{{{5, 0}}, {{-1, 0}}}}, 0}, {{{{{9, 0}}, {{1, 0}}}}, 0}}, 0);
  History history(100, scene.simulator, scene.points, scene.rectangle_set);
  const auto contains = [&] { return scene.inside.rule().contains(0, 0); };
  const auto redraw = [&](double margin) {
    history.edit([&, margin] {
      scene.inside.edit(
          [&](InsideRule& rule, Repair<Point>& repair) {
            CHECK(contains() == (repair.now() >= 5));  // the event of this time has been
            rule.set_margin(margin, repair);
          },
          scene.simulator.now());
    });
  };
  history.advance_to(3);
  redraw(0);
  CHECK_FALSE(contains());
  history.advance_to(5);
  CHECK(contains());
  redraw(-1);
  CHECK_FALSE(contains());
  history.advance_to(6);
  CHECK(contains());
  history.roll_back(5);
  CHECK_FALSE(contains());
  CHECK(scene.inside.rule().margin == -1);
  history.roll_back(4);
  CHECK(scene.inside.rule().margin == 0);
  scene.simulator.audit();
  CHECK_THROWS_WITH(scene.inside.edit([](auto&, auto&) {}, 2), Catch::Contains("an edit at 2"));
  CHECK_THROWS_WITH(scene.inside.edit([](auto&, auto&) {}, 99), Catch::Contains("would pass over an event at 5"));
  CHECK_THROWS_AS(scene.inside.edit([](auto&, auto&) {}, never), std::invalid_argument);
  scene.simulator.audit();
}

}  // namespace test_elements_rule
