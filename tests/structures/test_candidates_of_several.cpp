// Rules that compare candidates of several inner structures, in one set and in several, against exact brute force.
#include "examples/closest_on_two_levels.hpp"
#include "kds/framework/history.hpp"
#include "kds/testing/trial.hpp"
#include "structures/ordered.hpp"
#include "structures/ranked_list.hpp"
#include "tests/structures/exact_plane.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace test_candidates_of_several {
namespace {

using namespace kds;
using namespace kds::tests;
using examples::ClosestOnTwoLevels;
using Path = certificates::PlaneMotion<1>;
using Delaunay = structures::DelaunayRule<Path>;

/// From left to right: a ranking that needs no argument.
struct FromLeft : structures::ByDirection<Path, 2> {
  FromLeft() : structures::ByDirection<Path, 2>{{1, 0}} {}
};
using List = structures::RankedListRule<FromLeft>;

/// The edges of a triangulation (2 i) and the steps from one point to the next on its right (2 i + 1), all in order of
/// length. An edit of one point changes candidates of both.
struct LengthsRule : structures::OrderedRule<LengthsRule, StandsOn<Delaunay, List>, certificates::DistanceOrder<Path>> {
  static constexpr const char* name = "Lengths";

  Candidate candidate(From<0>, const structures::EdgeChange& change) const { return 2 * change.edge; }
  Candidate candidate(From<1>, const structures::NewNeighbour& change) const { return 2 * change.left + 1; }
  bool takes_part(Candidate c) const {
    return c % 2 == 0 ? inner(From<0>()).edges().contains(c / 2) : inner(From<1>()).right(c / 2) != nobody;
  }
  std::array<Id, 2> ids(Candidate c) const {
    return c % 2 == 0 ? inner(From<0>()).edges().ends(c / 2) : std::array{c / 2, inner(From<1>()).right(c / 2)};
  }
  certificates::DistanceOrder<Path> in_order(Candidate i, Candidate j, const MovingSet<Path>& x) const {
    const auto [a, b] = ids(i);
    const auto [c, d] = ids(j);
    return {x[a], x[b], x[c], x[d]};
  }
  Effect swapped(Candidate, Candidate) const { return Effect::external; }
  Effect renewed() const { return Effect::external; }
};

int check_lengths(const LengthsRule& rule, const MovingSet<Path>& set, double now) {
  const ExactPlane plane(set, now);
  std::vector<std::uint32_t> all;
  const auto& edges = rule.inner(From<0>()).edges();
  for (std::uint32_t edge = 0; edge < edges.end(); ++edge) {
    if (edges.contains(edge)) all.push_back(2 * edge);
  }
  const auto& order = rule.inner(From<1>()).order();
  for (std::size_t i = 0; i + 1 < order.size(); ++i) all.push_back(2 * order[i] + 1);
  std::vector<std::uint32_t> listed = rule.order();
  int wrong = 0;
  for (std::size_t i = 1; i < listed.size(); ++i) {
    const auto [a, b] = rule.ids(listed[i - 1]);
    const auto [c, d] = rule.ids(listed[i]);
    wrong += plane.compare_distances(a, b, c, d) > 0;
  }
  std::sort(all.begin(), all.end());
  std::sort(listed.begin(), listed.end());
  return wrong + (all != listed);
}

/// The squares of all distances on a level just after a time, exactly.
struct ExactDistance {
  std::uint32_t level;
  std::array<Id, 2> ids;
  oracle::Polynomial square;
};
template <int Degree>
void add_distances(const MovingSet<certificates::PlaneMotion<Degree>>& set, std::uint32_t level,
                   std::vector<ExactDistance>& all) {
  const auto coordinate = [&](Id id, int d) {
    const auto axis = set[id].axis(d);
    return oracle::Polynomial::motion({axis.position.c.begin(), axis.position.c.end()}, axis.start);
  };
  for (const Id a : set.ids()) {
    for (const Id b : set.ids()) {
      if (a >= b) continue;
      const auto x = coordinate(a, 0) - coordinate(b, 0), y = coordinate(a, 1) - coordinate(b, 1);
      all.push_back({level, {a, b}, x * x + y * y});
    }
  }
}

struct TwoLevels {
  MovingSet<examples::Line> lower{};
  MovingSet<examples::Curve> upper{};
  Kinetic<structures::DelaunayRule<examples::Line>> lower_triangles{lower, 0};
  Kinetic<structures::DelaunayRule<examples::Curve>> upper_triangles{upper, 0};
  Kinetic<examples::Lower> lower_pair{lower_triangles, 0};
  Kinetic<examples::Upper> upper_pair{upper_triangles, 0};
  Kinetic<ElementsRule<examples::Curve>> upper_points{upper, 0};
  Kinetic<ClosestOnTwoLevels> closest{{lower_pair, upper_pair, upper_points}, 0};

  /// Whether no two points on one level are closer; and there are two, unless none are known.
  bool right(double now) const {
    const auto& answer = closest.rule().closest();
    if (!answer) return !lower_pair.rule().pair() && !upper_pair.rule().pair();
    std::vector<ExactDistance> all;
    if (lower_pair.rule().pair()) add_distances(lower, 0, all);
    if (upper_pair.rule().pair()) add_distances(upper, 1, all);
    const auto mine = std::find_if(all.begin(), all.end(), [&](const ExactDistance& each) {
      return each.level == answer->level && each.ids == answer->ids;
    });
    if (mine == all.end()) return false;
    return std::all_of(all.begin(), all.end(), [&](const ExactDistance& each) {
      return (each.square - mine->square).sign_after(oracle::rational(now)) >= 0;
    });
  }
};

template <class Set, class Make>
void edit_one(Set& set, Random& random, const Make& make, double now) {
  const std::vector<Id> ids = set.ids();
  const std::size_t choice = random.below(4);
  if (ids.size() < 2 || choice == 0) {
    set.enter(make(), now);
  } else if (choice == 1) {
    set.remove(ids[random.below(ids.size())], now);
  } else {
    const Id other = ids[random.below(ids.size())];
    set.update(ids[random.below(ids.size())], choice == 2 ? make() : set[other], now);
  }
}

}  // namespace

TEST_CASE("candidates of two structures on one set are in order together, exactly", "[candidates]") {
  std::size_t events = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 1200; seed < 1204; ++seed) {
      CAPTURE(static_cast<int>(kind), seed);
      const auto found =
          testing::try_rule({.seed = seed, .kind = kind, .steps = 12, .first = 5, .most = 9, .one_in = 4},
                            LengthsRule{}, random_plane_motion<1>, check_lengths);
      CHECK(found.first == "");
      events += found.events.size();
    }
  }
  CHECK(events > 500);
}

TEST_CASE("the best of candidates that move in two ways is the best, through edits on both sides", "[candidates]") {
  std::size_t changes = 0, on_level[2]{};
  for (const Kind kind : {Kind::generic, Kind::lattice, Kind::resting}) {
    for (std::uint64_t seed = 1210; seed < 1234; ++seed) {
      CAPTURE(static_cast<int>(kind), seed);
      Random random(seed);
      TwoLevels levels;
      Simulator simulator(0, levels.lower_triangles, levels.upper_triangles, levels.lower_pair, levels.upper_pair,
                          levels.upper_points, levels.closest);
      for (int edit = 0; edit < 24; ++edit) {
        const double now = simulator.now();
        if (random.one_in(2)) {
          edit_one(
              levels.lower, random, [&] { return random_plane_motion<1>(random, kind, now); }, now);
        } else {
          edit_one(
              levels.upper, random, [&] { return random_plane_motion<2>(random, kind, now); }, now);
        }
        simulator.audit();
        while (simulator.step(now + 0.125)) {
          simulator.audit();
          if (simulator.next_time() > simulator.now()) REQUIRE(levels.right(simulator.now()));
        }
        simulator.advance_to(now + 0.125);
        REQUIRE(levels.right(simulator.now()));
        if (levels.closest.rule().closest()) ++on_level[levels.closest.rule().closest()->level];
      }
      changes += levels.closest.measures().external;
    }
  }
  CHECK(changes > 20);
  CHECK((on_level[0] > 20 && on_level[1] > 20));
}

TEST_CASE("a rule on several structures of several sets is rolled back with them", "[candidates]") {
  Random random(1220);
  TwoLevels levels;
  for (int i = 0; i < 8; ++i) {
    levels.lower.add(random_plane_motion<1>(random, Kind::generic, 0), 0);
    levels.upper.add(random_plane_motion<2>(random, Kind::generic, 0), 0);
  }
  Simulator simulator(0, levels.lower_triangles, levels.upper_triangles, levels.lower_pair, levels.upper_pair,
                      levels.upper_points, levels.closest);
  History history(10, simulator, levels.lower, levels.upper);
  std::vector<std::optional<examples::PairOnLevel>> answers;
  for (const double t : {0.5, 1.0, 1.5, 2.0}) {
    history.advance_to(t);
    answers.push_back(levels.closest.rule().closest());
    history.edit([&] { levels.upper.update(3, levels.upper[4], simulator.now()); });
  }
  for (const std::size_t i : {2, 1, 0}) {
    history.roll_back(0.5 * static_cast<double>(i + 1) - 0.0625);
    history.advance_to(0.5 * static_cast<double>(i + 1));
    simulator.audit();
    CHECK(levels.closest.rule().closest() == answers[i]);
  }
}

}  // namespace test_candidates_of_several
