// Structures on structures: what an outer one is told, when, and that snapshots, edits and errors go with it.
#include "examples/smallest_gap.hpp"
#include "kds/framework/history.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/framework/reverse.hpp"
#include "kds/framework/snapshot.hpp"
#include "kds/simulator.hpp"
#include "kds/testing/trial.hpp"
#include "structures/closest_pair.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

namespace test_standing_on {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::PlaneMotion;
using examples::ListRule;
using examples::SmallestGapRule;
using structures::ClosestPairRule;
using structures::DelaunayRule;
using structures::EdgeChange;

/// Every edge of the triangulation, by what it has been told alone. It has no certificates.
template <class Path>
struct EdgesRule : StandsOn<DelaunayRule<Path>> {
  static constexpr const char* name = "Edges";
  std::map<std::uint32_t, std::array<Id, 2>> edges{};
  std::set<Id> points{};
  int moved = 0;

  std::optional<certificates::Order<1>> certificate(Slot, const MovingSet<Path>&) const { return std::nullopt; }
  std::vector<Id> members(Slot) const { return {}; }
  Effect repair(Slot, Repair<Path>&) { return Effect::internal; }
  Effect follow(std::span<const EdgeChange> changes, Repair<Path>&) {
    for (const EdgeChange& change : changes) {
      const auto known = edges.find(change.edge);
      if (change.what == EdgeChange::What::came) {
        if (known != edges.end()) throw std::logic_error("an edge comes that is there");
        edges[change.edge] = change.ends;
      } else {
        if (known == edges.end() || known->second != change.ends) throw std::logic_error("an unknown edge");
        moved += change.what == EdgeChange::What::moved;
        if (change.what == EdgeChange::What::went) edges.erase(known);
      }
    }
    return Effect::external;
  }
  void insert(Id id, Repair<Path>&) { points.insert(id); }
  void remove(Id id, Repair<Path>& repair) {
    if (!repair.elements().contains(id)) throw std::logic_error("has gone before");
    points.erase(id);
  }
  template <class Archive>
  void archive(Archive& archive) {
    std::vector<std::uint32_t> numbers;
    std::vector<std::array<Id, 2>> all_ends;
    for (const auto& [edge, ends] : edges) numbers.push_back(edge), all_ends.push_back(ends);
    std::vector<Id> ids(points.begin(), points.end());
    archive(numbers, all_ends, ids, moved);
    edges.clear();
    for (std::size_t i = 0; i < numbers.size(); ++i) edges[numbers[i]] = all_ends[i];
    points = {ids.begin(), ids.end()};
  }
};

template <class Path>
int check_edges(const EdgesRule<Path>& rule, const MovingSet<Path>& set, double /*now*/) {
  const auto& mesh = rule.inner().mesh();
  std::set<std::array<Id, 2>> edges, told;
  for (const auto& [edge, ends] : rule.edges) told.insert(ends);
  for (structures::TriangleMesh::Edge h = 0; h < 3 * mesh.end_triangle(); ++h) {
    if (!mesh.in_use(h / 3) || mesh.origin(h) == nobody || mesh.target(h) == nobody) continue;
    edges.insert({std::min(mesh.origin(h), mesh.target(h)), std::max(mesh.origin(h), mesh.target(h))});
  }
  const std::vector<Id> ids = set.ids();
  const bool same_points = std::equal(ids.begin(), ids.end(), rule.points.begin(), rule.points.end());
  return (edges != told || told.size() != rule.edges.size()) + !same_points;
}

/// The smallest gap, by what has been told of it: a rule on a rule on a rule.
struct LastGapRule : StandsOn<SmallestGapRule> {
  static constexpr const char* name = "LastGap";
  std::optional<std::array<Id, 2>> pair{};

  std::optional<examples::Narrower> certificate(Slot, const MovingSet<Element>&) const { return std::nullopt; }
  std::array<Id, 0> members(Slot) const { return {}; }
  Effect repair(Slot, Repair<Element>&) { return Effect::internal; }
  Effect follow(std::span<const SmallestGapRule::Change> changes, Repair<Element>&) {
    pair = changes.back().answer;
    return Effect::external;
  }
  template <class Archive>
  void archive(Archive& archive) {
    archive(pair);
  }
};

/// Tells of what comes as an id, and of what goes as another type.
struct Gone {
  Id id;
};
struct TwoTopicsRule {
  using Element = Motion<2>;
  using Change = Changes<Id, Gone>;
  using Pen = Repair<Element, Change>;
  static constexpr const char* name = "TwoTopics";
  std::set<Id> there{};

  std::monostate certificate(Slot, const MovingSet<Element>&) const { return {}; }
  std::array<Id, 0> members(Slot) const { return {}; }
  Effect repair(Slot, Pen&) { return Effect::internal; }
  void insert(Id id, Pen& pen) { there.insert(id), pen.report(id); }
  void remove(Id id, Pen& pen) { there.erase(id), pen.report(Gone{id}); }
  std::tuple<std::vector<Id>, std::vector<Gone>> changes_from_nothing() const {
    return {std::vector<Id>(there.begin(), there.end()), std::vector<Gone>{}};
  }
};
template <class Told>
struct OneTopicRule : StandsOn<Telling<TwoTopicsRule, Told>> {
  static constexpr const char* name = "OneTopic";
  int calls = 0, changes = 0;

  std::monostate certificate(Slot, const MovingSet<Motion<2>>&) const { return {}; }
  std::array<Id, 0> members(Slot) const { return {}; }
  Effect repair(Slot, Repair<Motion<2>>&) { return Effect::internal; }
  Effect follow(std::span<const Told> told, Repair<Motion<2>>&) {
    ++calls;
    changes += static_cast<int>(told.size());
    return Effect::external;
  }
};
static_assert(std::same_as<StandsOn<TwoTopicsRule>::Heard, Id>);

/// The last of a list of samples.
struct LastRule : StandsOn<ListRule<Bounded>> {
  static constexpr const char* name = "Last";
  Id last = nobody;
  std::optional<certificates::InOrder<Bounded>> certificate(Slot, const MovingSet<Bounded>&) const { return {}; }
  std::array<Id, 0> members(Slot) const { return {}; }
  Effect repair(Slot, Repair<Bounded>&) { return Effect::internal; }
  Effect follow(std::span<const examples::NewNeighbour>, Repair<Bounded>&) {
    const Id before = std::exchange(last, inner().order.empty() ? nobody : inner().order.back());
    return last == before ? Effect::internal : Effect::external;
  }
};

using Value = Motion<2>;
using List = Kinetic<ListRule<Value>>;
using Gap = Kinetic<SmallestGapRule>;

template <class AnySimulator>
void run(AnySimulator& simulator) {
  while (simulator.step(20)) {
  }
}

void add_three(MovingSet<Value>& set) {
  set.insert(0, {{{0, 1, 0}}, 0}, 0);
  set.insert(1, {{{2, 0, 0}}, 0}, 0);
  set.insert(2, {{{9, -1, 0}}, 0}, 0);
}

}  // namespace

TEST_CASE("of a rule that tells of several things each outer rule hears what it asks for", "[standing_on]") {
  MovingSet<Value> set;
  add_three(set);
  Kinetic<TwoTopicsRule> inner(set, 0);
  Kinetic<OneTopicRule<Id>> comes(inner, 0);
  CHECK((comes.rule().calls == 1 && comes.rule().changes == 3));  // what leads to the present state
  set.remove(1, 0);                                               // heard by nobody
  CHECK(comes.rule().calls == 1);
  {
    Kinetic<OneTopicRule<Gone>> goes(inner, 0);
    CHECK((goes.rule().calls == 1 && goes.rule().changes == 0));
    set.remove(0, 0);
    set.insert(4, {{{5, 0, 0}}, 0}, 0);
    CHECK((goes.rule().calls == 2 && goes.rule().changes == 1));
    set.update(4, {{{6, 0, 0}}, 0}, 0);  // goes and comes
    CHECK((goes.rule().calls == 3 && goes.rule().changes == 2));
    goes.audit(0);
  }
  CHECK((comes.rule().calls == 3 && comes.rule().changes == 5));
  set.remove(2, 0);
  comes.audit(0);
  CHECK(comes.rule().calls == 3);
}

TEMPLATE_TEST_CASE_SIG("a triangulation tells which edges come and go, and nothing else", "[standing_on]",
                       ((int Degree), Degree), 1, 2) {
  using Path = PlaneMotion<Degree>;
  std::size_t events = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 300; seed < 303; ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      const auto found = testing::try_rule({seed, kind, 16, 1 + 4 * (seed % 3), 12}, EdgesRule<Path>{},
                                           random_plane_motion<Degree>, check_edges<Path>);
      CHECK(found.first == "");
      events += found.events.size();
    }
  }
  CHECK(events > 200);
}

TEST_CASE("several rules stand on one, and on each other", "[standing_on]") {
  for (const Kind kind : all_kinds) {
    const std::uint64_t seed = 310;
    CAPTURE(static_cast<int>(kind), seed);
    const auto check = [](const LastGapRule& rule, const MovingSet<Value>&, double) {
      return rule.pair != rule.inner().pair();
    };
    CHECK(testing::try_rule({seed, kind, 20}, LastGapRule{}, random_motion<2>, check).first == "");
  }
  MovingSet<PlaneMotion<1>> points;
  Random random(311);
  for (Id id = 0; id < 30; ++id) points.insert(id, random_plane_motion<1>(random, Kind::generic, 0), 0);
  Kinetic<DelaunayRule<PlaneMotion<1>>> triangulation(points, 0);
  Kinetic<EdgesRule<PlaneMotion<1>>> edges(triangulation, 0);
  Kinetic<ClosestPairRule<PlaneMotion<1>>> closest(triangulation, 0);
  Simulator simulator(0, triangulation, closest, edges);
  simulator.advance_to(0.2);
  points.update(3, random_plane_motion<1>(random, Kind::generic, 0.2), 0.2);
  const PlaneMotion<1> same = points[4];
  points.update(4, same, 0.2);
  CHECK(edges.rule().moved > 2);  // the triangulation takes it up where it is
  simulator.advance_to(0.4);
  simulator.audit();
  CHECK(check_edges(edges.rule(), points, 0.4) == 0);
  CHECK(edges.measures().followed > 10);
  CHECK(edges.measures().followed == edges.measures().external);
  CHECK(edges.measures().followed == closest.measures().followed);
  CHECK(edges.measures().followed <= triangulation.measures().events);
}

TEST_CASE("listeners are called when all structures are valid, the inner one's first", "[standing_on]") {
  MovingSet<Value> set;
  add_three(set);
  std::vector<std::string> calls;
  const Kinetic<SmallestGapRule>* outer = nullptr;
  const auto of_list = [&](const ListRule<Value>&, const KineticEvent& event) {
    calls.push_back("list " + std::to_string(event.slot));
    if (outer != nullptr) outer->audit(event.time);
    if (event.time == 2) set.insert(7, {{{50, 0, 0}}, 0}, event.time);
  };
  const auto of_gap = [&](const SmallestGapRule& rule, const KineticEvent& event) {
    calls.push_back((event.slot == no_slot ? "gap, followed, " : "gap, ") + std::to_string((*rule.pair())[1]));
    if (event.time == 2) CHECK(set.contains(7));
  };
  Kinetic<ListRule<Value>, decltype(of_list)> list(set, 0, {}, of_list);
  Kinetic<SmallestGapRule, decltype(of_gap)> gap(list, 0, {}, of_gap);
  Simulator simulator(0, list, gap);
  simulator.advance_to(2.5);
  simulator.audit();
  CHECK(calls == std::vector<std::string>{"list 0", "gap, followed, 1"});
  CHECK(gap.measures().followed == 1);
  CHECK(gap.measures().external == 0);  // the same two are the closest
}

TEST_CASE("an outer structure is made at a time when the inner one has events", "[standing_on]") {
  MovingSet<Value> set;
  add_three(set);
  List list(set, 0);
  Gap gap(list, 2);  // two swap at 2
  CHECK(list.rule().order == std::vector<Id>{1, 0, 2});
  Simulator simulator(2, list, gap);
  simulator.audit();
  CHECK_THROWS_WITH(Gap(list, 99), Catch::Contains("ListRule: an edit at 99"));
}

TEST_CASE("a structure that misses what the inner one does says so", "[standing_on]") {
  MovingSet<Value> set;
  add_three(set);
  List list(set, 0);
  SECTION("the outer one first") {
    set.insert(3, {{{20, -10, 0}}, 0}, 0);
    set.insert(4, {{{18, -8, 0}}, 0}, 0);
    Gap gap(list, 0);
    Simulator simulator(0, gap);
    CHECK_THROWS_WITH(run(simulator), Catch::Contains("must stand before it in the simulator"));
  }
  SECTION("not in the simulator") {
    set.insert(3, {{{2.5, 0, 0}}, 0}, 0);
    set.insert(4, {{{2.5, 0, 0.25}}, 0}, 0);
    Gap gap(list, 0);
    Simulator simulator(0, list);
    REQUIRE(gap.next_time() < never);
    CHECK_THROWS_WITH(run(simulator), Catch::Contains("SmallestGap: what it stands on has passed over"));
  }
  SECTION("loaded alone") {
    Gap gap(list, 0);
    Simulator both(0, list, gap);
    Simulator alone(0, list);
    const Snapshot before = save(alone, set);
    both.advance_to(3);
    restore(before, alone, set);
    CHECK_THROWS_WITH(gap.audit(0), Catch::Contains("SmallestGap: a structure that it stands on has changed"));
    CHECK_THROWS_WITH(set.remove(0, 0), Catch::Contains("SmallestGap: a structure that it stands on has changed"));
  }
}

TEST_CASE("structures on structures are rolled back together", "[standing_on]") {
  MovingSet<Value> set;
  add_three(set);
  List list(set, 0);
  Gap gap(list, 0);
  Simulator simulator(0, list, gap);
  History history(3, simulator, set);
  std::vector<std::optional<std::array<Id, 2>>> pairs;
  for (const double t : {1.0, 3.0, 5.0, 7.0}) {
    history.advance_to(t);
    if (t == 3) history.edit([&] { set.insert(8, {{{-9, 3, 0}}, 0}, simulator.now()); });
    pairs.push_back(gap.rule().pair());
  }
  CHECK(std::set(pairs.begin(), pairs.end()).size() > 1);
  for (const std::size_t i : {2, 1, 0}) {
    history.roll_back(2.0 * static_cast<double>(i) + 1);
    simulator.audit();
    CHECK(gap.rule().pair() == pairs[i]);
  }
}

TEST_CASE("a rule on samples is told when they are taken", "[standing_on]") {
  MovingSet<Bounded> set;
  set.sample_with([](Id id, double now) { return Bounded{id == 0 ? now : 3, 1, now}; }, 0.125);
  Kinetic<ListRule<Bounded>> list(set, 0);
  Kinetic<LastRule> last(list, 0);
  set.insert(0, {0, 1, 0}, 0);
  set.insert(1, {3, 1, 0}, 0);
  Simulator simulator(0, list, last);
  CHECK(last.rule().last == 1);
  simulator.advance_to(5);
  simulator.audit();
  CHECK(last.rule().last == 0);
}

}  // namespace test_standing_on
