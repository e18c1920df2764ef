// A rule on several structures, which may stand on each other: what it is told, when, and in which order.
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "kds/testing/trial.hpp"
#include "structures/delaunay.hpp"
#include "structures/gabriel_graph.hpp"
#include "structures/ranked_list.hpp"
#include "tests/structures/random_values.hpp"
#include "tests/structures/told_edges.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace test_standing_on_several {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::DirectionOrder;
using structures::ByDirection;
using structures::DelaunayRule;
using structures::EdgeChange;
using structures::GabrielGraphRule;
using structures::NewNeighbour;
using structures::RankedListRule;
using structures::TriangleChange;

using Path = certificates::PlaneMotion<1>;
using Delaunay = DelaunayRule<Path>;

/// From left to right: a ranking that needs no argument.
struct ByX : ByDirection<Path, 2> {
  ByX() : ByDirection<Path, 2>{{1, 0}} {}
};
using List = RankedListRule<ByX>;

constexpr std::array<double, 2> upwards{0, 1};

/// The edges of a triangulation that join neighbours from left to right, and which of them lead up: by what it has been
/// told alone, with a certificate for each.
struct StepsRule : StandsOn<Delaunay, List> {
  static constexpr const char* name = "Steps";
  static constexpr From<0> triangulation{};
  static constexpr From<1> list{};
  EdgesTold edges{};
  std::vector<Id> right{};   ///< by the left one, as told
  std::vector<int> leads{};  ///< by the left one: 1 up, -1 down, 0 if the two are not joined
  std::size_t elements = 0;

  std::optional<DirectionOrder<Path, 2>> certificate(Slot left, const MovingSet<Path>& x) const {
    if (left >= leads.size() || leads[left] == 0) return std::nullopt;
    return up(left, leads[left], x);
  }
  std::array<Id, 2> members(Slot left) const { return {left, right[left]}; }
  Effect repair(Slot left, Repair<Path>&) {
    if (inner(list).right(left) != right[left]) throw std::logic_error("it has not been told of a neighbour");
    leads[left] = -leads[left];
    return Effect::external;
  }
  Effect follow(From<0>, std::span<const EdgeChange> changes, Repair<Path>& repair) {
    require_same_elements(repair);
    for (const EdgeChange& change : changes) edges.take(change);
    for (const EdgeChange& change : changes) {
      for (const Id id : change.ends) look(id, repair);
    }
    return Effect::internal;
  }
  Effect follow(From<1>, std::span<const NewNeighbour> changes, Repair<Path>& repair) {
    require_same_elements(repair);
    for (const auto& [left] : changes) {
      if (left >= right.size()) right.resize(left + std::size_t{1}, nobody), leads.resize(left + std::size_t{1}, 0);
      right[left] = inner(list).right(left);
      look(left, repair);
    }
    return Effect::external;
  }
  void insert(Id, Repair<Path>& repair) { require_same_elements(repair), ++elements; }
  void remove(Id, Repair<Path>& repair) { require_same_elements(repair), --elements; }

  template <class Archive>
  void archive(Archive& archive) {
    archive(edges, right, leads, elements);
  }

 private:
  DirectionOrder<Path, 2> up(Id left, int sign, const MovingSet<Path>& x) const {
    const Path &a = x[left], &b = x[right[left]];
    return sign > 0 ? DirectionOrder<Path, 2>{a, b, upwards} : DirectionOrder<Path, 2>{b, a, upwards};
  }
  void look(Id left, Repair<Path>& repair) {
    if (left >= right.size()) return;
    // An end that has gone may still be named by an edge of which the other inner rule has not told yet.
    const bool joined = inner(list).contains(left) && right[left] != nobody && edges.joins(left, right[left]);
    leads[left] = !joined ? 0 : repair.sign(up(left, 1, repair.elements())) >= 0 ? 1 : -1;
    repair.certify(left);
  }
  /// Both inner rules have taken up the same edit.
  void require_same_elements(const Repair<Path>& repair) const {
    const Delaunay& delaunay = inner(triangulation);
    for (const Id id : repair.elements().ids()) {
      const bool known = delaunay.mesh().contains(id) || (id < repair.elements().end_id() && delaunay.vertex(id) != id);
      if (!delaunay.flat() && known != inner(list).contains(id)) throw std::logic_error("one knows it, the other not");
    }
  }
};

/// Tells what it is told.
struct PassesOnRule : StandsOn<Delaunay>, Quiet<Path> {
  static constexpr const char* name = "PassesOn";
  using Change = EdgeChange;
  Effect repair(Slot, Repair<Path, EdgeChange>&) { return Effect::internal; }
  Effect follow(std::span<const EdgeChange> changes, Repair<Path, EdgeChange>& repair) {
    for (const EdgeChange& change : changes) repair.report(change);
    return Effect::external;
  }
  std::vector<EdgeChange> changes_from_nothing() const { return std::get<0>(inner().changes_from_nothing()); }
};
/// On two structures of one triangulation.
struct OnTwoRule : StandsOn<PassesOnRule, PassesOnRule>, Quiet<Path> {
  static constexpr const char* name = "OnTwo";
  Effect repair(Slot, Repair<Path>&) { return Effect::internal; }
  template <std::size_t I>
  Effect follow(From<I>, std::span<const EdgeChange>, Repair<Path>&) {
    return Effect::external;
  }
};

int check_steps(const StepsRule& rule, const MovingSet<Path>& set, double now) {
  int wrong = rule.elements != set.size();
  std::set<std::array<Id, 2>> edges;
  const auto& numbered = rule.inner(StepsRule::triangulation).edges();
  for (std::uint32_t edge = 0; edge < numbered.end(); ++edge) {
    if (numbered.contains(edge)) edges.insert(numbered.ends(edge));
  }
  const auto& order = rule.inner(StepsRule::list).order();
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Id a = order[i], b = i + 1 < order.size() ? order[i + 1] : nobody;
    const bool joined = b != nobody && edges.contains({std::min(a, b), std::max(a, b)});
    const int leads = a < rule.leads.size() ? rule.leads[a] : 0;
    if (!joined) {
      wrong += leads != 0;
    } else {
      const int sign = sign_after(DirectionOrder<Path, 2>{set[a], set[b], upwards}, now);
      wrong += leads == 0 || sign * leads < 0;
    }
  }
  return wrong;
}

/// Stands on a triangulation, twice, and on a graph that stands on it too.
struct DiamondRule : StandsOn<Delaunay, GabrielGraphRule<Path>, Telling<Delaunay, TriangleChange>>, Quiet<Path> {
  static constexpr const char* name = "Diamond";
  using Change = int;
  using Pen = Repair<Path, int>;
  EdgesTold all{}, graph{};
  int calls = 0;

  Effect repair(Slot, Pen&) { return Effect::internal; }
  Effect follow(From<0>, std::span<const EdgeChange> changes, Pen& repair) {
    for (const EdgeChange& change : changes) all.take(change);
    return told(repair);
  }
  Effect follow(From<1>, std::span<const EdgeChange> changes, Pen& repair) {
    for (const EdgeChange& change : changes) {
      if (change.what == EdgeChange::What::came && !all.ends.contains(change.edge)) {
        throw std::logic_error("the graph tells of an edge of which the triangulation has not");
      }
      graph.take(change);
    }
    for (const auto& [edge, ends] : graph.ends) {
      if (!all.ends.contains(edge)) throw std::logic_error("the graph keeps an edge that has gone");
    }
    return told(repair);
  }
  Effect follow(From<2>, std::span<const TriangleChange>, Pen& repair) { return told(repair); }
  /// Reports as an element comes, besides what it reports as it follows.
  void insert(Id, Pen& repair) { repair.report(-1); }
  void remove(Id, Pen&) {}
  std::vector<int> changes_from_nothing() const { return {calls}; }
  template <class Archive>
  void archive(Archive& archive) {
    archive(all, graph, calls);
  }

 private:
  Effect told(Pen& repair) {
    repair.report(++calls);
    return Effect::external;
  }
};
/// On the bottom and the top of that.
struct AboveDiamondRule : StandsOn<DiamondRule, Delaunay>, Quiet<Path> {
  static constexpr const char* name = "AboveDiamond";
  int calls = 0, inserted = 0, follows = 0;

  Effect repair(Slot, Repair<Path>&) { return Effect::internal; }
  Effect follow(From<0>, std::span<const int> changes, Repair<Path>&) {
    for (const int change : changes) {
      if (change == -1) {
        ++inserted;
      } else if (std::exchange(calls, change) >= change && change != 0) {
        throw std::logic_error("it is told again");
      }
    }
    if (calls != inner().calls) throw std::logic_error("it has not been told all");
    ++follows;
    return Effect::internal;
  }
  Effect follow(From<1>, std::span<const EdgeChange>, Repair<Path>&) {
    if (calls != inner().calls) throw std::logic_error("it is told of the bottom first");
    return Effect::internal;
  }
  template <class Archive>
  void archive(Archive& archive) {
    archive(calls, inserted, follows);
  }
};

}  // namespace

TEST_CASE("a rule stands on a triangulation and a list of the same points", "[standing_on]") {
  std::size_t events = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 320; seed < 324; ++seed) {
      CAPTURE(static_cast<int>(kind), seed);
      const auto found = testing::try_rule({seed, kind, 16, 1 + 4 * (seed % 3), 12, seed % 2 == 0 ? never : 0.5},
                                           StepsRule{}, random_plane_motion<1>, check_steps);
      CHECK(found.first == "");
      events += found.events.size();
    }
  }
  CHECK(events > 1000);
}

TEST_CASE("it is called after all that it stands on, however they stand on each other", "[standing_on]") {
  int follows = 0, inserted = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 330; seed < 332; ++seed) {
      CAPTURE(static_cast<int>(kind), seed);
      const auto check = [&](const AboveDiamondRule& rule, const MovingSet<Path>&, double) {
        const auto& graph = rule.inner().inner(From<1>());
        int wrong = rule.calls != rule.inner().calls;
        for (const auto& [edge, ends] : rule.inner().graph.ends) wrong += !graph.contains(edge);
        for (std::uint32_t edge = 0; edge < graph.end_edge(); ++edge) {
          wrong += graph.contains(edge) != rule.inner().graph.ends.contains(edge);
        }
        follows = std::max(follows, rule.follows);
        inserted = std::max(inserted, rule.inserted);
        return wrong;
      };
      CHECK(testing::try_rule({seed, kind, 16, 6, 12}, AboveDiamondRule{}, random_plane_motion<1>, check).first == "");
    }
  }
  CHECK(follows > 50);
  CHECK(inserted > 5);
}

TEST_CASE("listeners are called after those of all inner structures", "[standing_on]") {
  MovingSet<Path> set;
  std::string calls;
  Random random(360);
  for (Id id = 0; id < 20; ++id) set.insert(id, random_plane_motion<1>(random, Kind::generic, 0), 0);
  const auto writes = [&calls](char letter) {
    return [&calls, letter](const auto&, const KineticEvent&) { calls.push_back(letter); };
  };
  const auto a = writes('a'), b = writes('b'), c = writes('c'), d = writes('d');
  Kinetic<Delaunay, decltype(a)> triangulation(set, 0, {}, a);
  Kinetic<PassesOnRule, decltype(b)> left(triangulation, 0, {}, b);
  Kinetic<PassesOnRule, decltype(c)> right(triangulation, 0, {}, c);
  Kinetic<OnTwoRule, decltype(d)> both({left, right}, 0, {}, d);
  Simulator simulator(0, triangulation, left, right, both);
  simulator.advance_to(0.2);
  CAPTURE(calls);
  REQUIRE(calls.size() > 40);
  for (std::size_t i = 0, end = 0; i < calls.size(); i = end) {  // events, each from where it begins to where it ends
    for (end = i + 1; end < calls.size() && calls[end] > calls[end - 1]; ++end) continue;
    const std::string event = calls.substr(i, end - i);
    REQUIRE((event == "abcd" || event == "a"));  // the second changes no edge
  }
}

}  // namespace test_standing_on_several
