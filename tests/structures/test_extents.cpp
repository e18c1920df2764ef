// Extents in directions, against exact brute force.
#include "certificates/plane_motion.hpp"
#include "certificates/point_motion.hpp"
#include "kds/testing/trial.hpp"
#include "structures/extents.hpp"
#include "tests/structures/random_values.hpp"
#include "tests/support/exact_algebra.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <map>
#include <stdexcept>
#include <vector>

namespace test_extents {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::PlaneMotion;
using certificates::PointMotion;
using structures::ExtentsRule;
using structures::kdop_directions;
using testing::Findings;
using testing::try_rule;

/// How far in a direction, as a function of the clock.
template <class Path, std::size_t Dimension>
oracle::Polynomial along(const Path& path, const std::array<double, Dimension>& direction) {
  oracle::Polynomial sum;
  for (std::size_t d = 0; d < Dimension; ++d) {
    const auto axis = path.axis(static_cast<int>(d));
    sum = sum + oracle::Polynomial(oracle::rational(direction[d])) *
                    oracle::Polynomial::motion({axis.position.c.begin(), axis.position.c.end()}, axis.start);
  }
  return sum;
}

template <class Path, std::size_t Dimension>
int check_extents(const ExtentsRule<Path, Dimension>& rule, const MovingSet<Path>& set, double now) {
  int wrong = 0;
  for (std::size_t i = 0; i < rule.directions().size(); ++i) {
    std::optional<Id> most, least;
    std::map<Id, oracle::Polynomial> reaches;
    for (const Id id : set.ids()) reaches[id] = along(set[id], rule.directions()[i]);
    for (const Id id : set.ids()) {
      const auto compare = [&](Id other) { return (reaches[id] - reaches[other]).sign_after(oracle::rational(now)); };
      if (!most || compare(*most) > 0) most = id;
      if (!least || compare(*least) < 0) least = id;
    }
    wrong += rule.foremost(i) != most || rule.hindmost(i) != least;
  }
  return wrong;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the extents of a k-DOP are those of the extreme points, exactly", "[extents]",
                       ((int Degree), Degree), 1, 2) {
  std::size_t events = 0;
  for (const Kind kind : all_kinds) {
    for (const int k : {6, Degree == 1 ? 26 : 18}) {
      const std::uint64_t seed = 700 + static_cast<std::uint64_t>(k);
      CAPTURE(Degree, static_cast<int>(kind), k, seed);
      const Findings found = try_rule({seed, kind, 8, 7, 12, k == 6 ? never : 0.5},
                                      ExtentsRule<PointMotion<Degree>, 3>(kdop_directions(k)),
                                      random_point_motion<Degree>, check_extents<PointMotion<Degree>, 3>);
      CHECK(found.first == "");
      events += found.events.size();
    }
  }
  CHECK(events > 20);
}

TEST_CASE("directions are any, but not none", "[extents]") {
  using Rule = ExtentsRule<PlaneMotion<1>, 2>;
  CHECK_THROWS_AS(Rule({}), std::invalid_argument);
  CHECK_THROWS_AS(Rule({{0, 0}}), std::invalid_argument);
  CHECK_THROWS_AS(Rule({{1, std::nan("")}}), std::invalid_argument);
  CHECK_THROWS_AS(kdop_directions(8), std::invalid_argument);
  for (const int k : {6, 14, 18, 26}) CHECK(kdop_directions(k).size() == static_cast<std::size_t>(k / 2));

  MovingSet<PlaneMotion<1>> set;
  Kinetic<Rule> extents(set, 0, Rule({{0.6, 0.8}, {0, -2}}));
  CHECK_FALSE(extents.rule().foremost(0));
  set.add({{{{{0, 0}}, {{0, 1}}}}, 0}, 0);
  set.add({{{{{5, 0}}, {{0, 0}}}}, 0}, 0);
  CHECK(extents.rule().foremost(0) == 1);
  CHECK(extents.rule().hindmost(0) == 0);
  Simulator simulator(0, extents);
  simulator.advance_to(3.5);
  CHECK(extents.rule().foremost(0) == 1);
  simulator.advance_to(4);
  CHECK(extents.rule().foremost(0) == 0);
  CHECK(extents.rule().extent(0, set, 4)[0] == 3.0);
  CHECK(extents.rule().extent(1, set, 4) == std::array<double, 2>{-8, 0});
}

TEST_CASE("extents keep to their measures", "[extents]") {
  const std::uint64_t seed = 730;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<PointMotion<2>> set;
  const Id n = 100;
  for (Id id = 0; id < n; ++id) set.insert(id, random_point_motion<2>(random, Kind::generic, 0), 0);
  const std::uint64_t lanes = 2 * 7;
  const auto levels = static_cast<std::uint64_t>(std::ceil(std::log2(n)));
  Kinetic<ExtentsRule<PointMotion<2>, 3>> extents(set, 0, ExtentsRule<PointMotion<2>, 3>(kdop_directions(14)));
  Simulator simulator(0, extents);
  while (simulator.step()) {
  }
  const Measures m = extents.measures();
  CHECK(m.held == lanes * (n - 1));
  CHECK(m.most_held == lanes * (n - 1));        // compact
  CHECK(m.most_per_element <= lanes * levels);  // local
  CHECK(m.most_touched <= levels + 1);          // responsive
  CHECK(m.external > lanes);
  CHECK(m.external < m.events);
}

TEST_CASE("points that move together keep their extents by id", "[extents][degeneracy]") {
  MovingSet<PlaneMotion<2>> set;
  using Rule = ExtentsRule<PlaneMotion<2>, 2>;
  Kinetic<Rule> extents(set, 0, Rule({{1, 0}, {0, 1}}));
  const PlaneMotion<2> path{{{{{0.1, 0.2, 0.3}}, {{1, 2, 3}}}}, 0.5};
  for (const Id id : {4, 2, 9}) set.insert(id, path, 0);
  CHECK(extents.rule().foremost(0) == 2);
  CHECK(extents.rule().hindmost(1) == 2);
  CHECK(extents.next_time() == never);
  set.remove(2, 1);
  CHECK(extents.rule().foremost(0) == 4);
  extents.audit(1);
}

}  // namespace test_extents
