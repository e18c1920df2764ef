// What structures tell of their changes: these alone, replayed, give what the structure answers, with present motions.
#include "kds/testing/trial.hpp"
#include "structures/aabb_tree.hpp"
#include "structures/champion.hpp"
#include "structures/closest_pair.hpp"
#include "structures/extents.hpp"
#include "structures/heap.hpp"
#include "structures/hull_edges.hpp"
#include "structures/k_nearest.hpp"
#include "structures/kth_smallest.hpp"
#include "structures/nearest_neighbours.hpp"
#include "tests/structures/exact_plane.hpp"
#include "tests/structures/random_values.hpp"
#include "tests/structures/told_edges.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

namespace test_told_changes {
namespace {

using namespace kds;
using namespace kds::tests;
using Value = Motion<2>;
using Path = certificates::PlaneMotion<1>;

/// Answers under numbers, each made of some elements.
using Answers = std::map<std::uint32_t, std::vector<Id>>;

/// Answers that have been told, and how their elements moved then.
template <class Element>
class Told {
 public:
  const Answers& answers() const { return answers_; }
  void put(std::uint32_t number, std::vector<Id> ids, const MovingSet<Element>& x) {
    std::vector<Element>& motions = motions_[number];
    motions.clear();
    for (const Id id : ids) motions.push_back(x[id]);
    answers_[number] = std::move(ids);
  }
  void put_new(std::uint32_t number, std::vector<Id> ids, const MovingSet<Element>& x) {
    if (answers_.contains(number)) throw std::logic_error("something comes that is there");
    put(number, std::move(ids), x);
  }
  void erase(std::uint32_t number) {
    answers_.erase(number);
    motions_.erase(number);
  }
  void require(std::uint32_t number, const std::vector<Id>& ids) const {
    const auto known = answers_.find(number);
    if (known == answers_.end() || known->second != ids) throw std::logic_error("something goes that is not there");
  }
  /// Whether nobody has got a new motion of which it has not been told; that time has been turned round is not told.
  bool up_to_date(const MovingSet<Element>& x) const {
    return std::all_of(answers_.begin(), answers_.end(), [&](const auto& answer) {
      const std::vector<Element>& motions = motions_.at(answer.first);
      return std::equal(answer.second.begin(), answer.second.end(), motions.begin(),
                        [&](Id id, const Element& motion) { return x[id] == motion || x[id] == reversed(motion); });
    });
  }
  template <class Archive>
  void archive(Archive& archive) {
    std::vector<std::uint32_t> numbers;
    std::vector<std::vector<Id>> ids;
    std::vector<std::vector<Element>> motions;
    for (const auto& [number, its_ids] : answers_) {
      numbers.push_back(number), ids.push_back(its_ids), motions.push_back(motions_.at(number));
    }
    archive(numbers, ids, motions);
    answers_.clear(), motions_.clear();
    for (std::size_t i = 0; i < numbers.size(); ++i) answers_[numbers[i]] = ids[i], motions_[numbers[i]] = motions[i];
  }

 private:
  Answers answers_;
  std::map<std::uint32_t, std::vector<Element>> motions_;
};

/// Hears what a rule tells, and keeps just that. `Of` says what rule it is, what is told, how that changes the answers,
/// and what the rule itself answers.
template <class Of>
struct ToldRule : StandsOn<Telling<typename Of::Rule, typename Of::Heard>>, Quiet<typename Of::Rule::Element> {
  static constexpr const char* name = "Told";
  using Element = typename Of::Rule::Element;
  Told<Element> told{};

  Effect repair(Slot, Repair<Element>&) { return Effect::internal; }
  Effect follow(std::span<const typename Of::Heard> changes, Repair<Element>& repair) {
    for (const auto& change : changes) Of::take(change, this->inner(), repair.elements(), told);
    return Effect::external;
  }
  template <class Archive>
  void archive(Archive& archive) {
    archive(told);
  }
};

/// Runs trials with all kinds of motions. Returns how often something has been told in events.
template <class Of, class Make>
std::size_t trials(std::uint64_t seed, const Make& make, testing::TrialOptions options = {.seed = 0}) {
  using Element = typename Of::Rule::Element;
  const auto check = [](const ToldRule<Of>& rule, const MovingSet<Element>& x, double) {
    return (rule.told.answers() != Of::answers(rule.inner(), x)) + !rule.told.up_to_date(x);
  };
  std::size_t told = 0;
  for (const Kind kind : all_kinds) {
    for (int run = 0; run < 12; ++run) {
      CAPTURE(static_cast<int>(kind), seed);
      options.seed = seed++;
      options.kind = kind;
      options.window = seed % 2 == 0 ? never : 0.4;
      const testing::Findings found = testing::try_rule(options, ToldRule<Of>{}, make, check);
      CHECK(found.first == "");
      for (const KineticEvent& event : found.events) told += event.slot == no_slot;
    }
  }
  return told;
}

struct OfHeap {
  using Rule = structures::HeapRule<structures::ByValue<Value>>;
  using Heard = structures::TopChange;
  static void take(const Heard& change, const Rule&, const MovingSet<Value>& x, Told<Value>& told) {
    change.top == nobody ? told.erase(0) : told.put(0, {change.top}, x);
  }
  static Answers answers(const Rule& rule, const MovingSet<Value>&) {
    return rule.top() ? Answers{{0, {*rule.top()}}} : Answers{};
  }
};

/// Two directions: rules that others stand on are made without arguments.
struct ExtentsInTwo : structures::ExtentsRule<Path, 2> {
  ExtentsInTwo() : structures::ExtentsRule<Path, 2>({{1, 0}, {1, -2}}) {}
};
struct OfExtents {
  using Rule = ExtentsInTwo;
  using Heard = structures::ExtremeChange;
  static std::uint32_t number(std::size_t direction, bool foremost) {
    return static_cast<std::uint32_t>(2 * direction + foremost);
  }
  static void take(const Heard& change, const Rule&, const MovingSet<Path>& x, Told<Path>& told) {
    const std::uint32_t end = number(change.direction, change.foremost);
    change.id == nobody ? told.erase(end) : told.put(end, {change.id}, x);
  }
  static Answers answers(const Rule& rule, const MovingSet<Path>&) {
    Answers answers;
    for (const std::size_t direction : {0, 1}) {
      if (!rule.foremost(direction)) continue;
      answers[number(direction, true)] = {*rule.foremost(direction)};
      answers[number(direction, false)] = {*rule.hindmost(direction)};
    }
    return answers;
  }
};

struct FourthSmallest : structures::KthSmallestRule<Value> {
  FourthSmallest() : structures::KthSmallestRule<Value>(3) {}
};
struct OfLeast {
  using Rule = FourthSmallest;
  using Heard = structures::LeastChange;
  static void take(const Heard& change, const Rule&, const MovingSet<Value>& x, Told<Value>& told) {
    if (change.what == Heard::What::came) return told.put_new(change.id, {change.id}, x);
    told.require(change.id, {change.id});
    told.erase(change.id);
  }
  static Answers answers(const Rule& rule, const MovingSet<Value>& x) {
    Answers answers;
    for (const Id id : x.ids()) {
      if (rule.contains(id)) answers[id] = {id};
    }
    return answers;
  }
};
struct OfLast {
  using Rule = FourthSmallest;
  using Heard = structures::LastChange;
  static void take(const Heard& change, const Rule&, const MovingSet<Value>& x, Told<Value>& told) {
    change.last == nobody ? told.erase(0) : told.put(0, {change.last}, x);
  }
  static Answers answers(const Rule& rule, const MovingSet<Value>&) {
    return rule.kth() == nobody ? Answers{} : Answers{{0, {rule.kth()}}};
  }
};

struct OfClosestPair {
  using Rule = structures::ClosestPairRule<Path>;
  using Heard = structures::AnswerChange<Rule::Pair>;
  static void take(const Heard& change, const Rule&, const MovingSet<Path>& x, Told<Path>& told) {
    change.answer ? told.put(0, {(*change.answer)[0], (*change.answer)[1]}, x) : told.erase(0);
  }
  static Answers answers(const Rule& rule, const MovingSet<Path>&) {
    return rule.pair() ? Answers{{0, {(*rule.pair())[0], (*rule.pair())[1]}}} : Answers{};
  }
};

struct OfNearest {
  using Rule = structures::NearestNeighboursRule<Path>;
  using Heard = structures::NearestChange;
  static void take(const Heard& change, const Rule& rule, const MovingSet<Path>& x, Told<Path>& told) {
    const std::optional<Id> nearest = rule.nearest(change.id);
    nearest ? told.put(change.id, {change.id, *nearest}, x) : told.erase(change.id);
  }
  static Answers answers(const Rule& rule, const MovingSet<Path>& x) {
    Answers answers;
    for (const Id id : x.ids()) {
      if (rule.nearest(id)) answers[id] = {id, *rule.nearest(id)};
    }
    return answers;
  }
};

struct ThreeNearest : structures::KNearestRule<Path> {
  ThreeNearest() : structures::KNearestRule<Path>(3) {}
};
struct OfKNearest {
  using Rule = ThreeNearest;
  using Heard = structures::NearestChange;
  static void take(const Heard& change, const Rule& rule, const MovingSet<Path>& x, Told<Path>& told) {
    told.erase(change.id);
    const bool is_vertex = rule.inner().inner().vertex(change.id) == change.id;
    if (is_vertex && !rule.nearest(change.id).empty()) told.put(change.id, list(rule, change.id), x);
  }
  static Answers answers(const Rule& rule, const MovingSet<Path>& x) {
    Answers answers;
    for (const Id id : x.ids()) {
      if (rule.inner().inner().vertex(id) == id && !rule.nearest(id).empty()) answers[id] = list(rule, id);
    }
    return answers;
  }
  static std::vector<Id> list(const Rule& rule, Id id) {
    std::vector<Id> ids = rule.nearest(id);
    ids.push_back(id);
    return ids;
  }
};

template <class Triangulation>
struct OfHullEdges {
  using Rule = structures::HullEdgesRule<Path, Triangulation>;
  using Heard = structures::HullEdgeChange;
  static void take(const Heard& change, const Rule&, const MovingSet<Path>& x, Told<Path>& told) {
    const auto& [what, from, to] = change;
    if (what == Heard::What::came) return told.put_new(from, {from, to}, x);
    told.require(from, {from, to});
    what == Heard::What::went ? told.erase(from) : told.put(from, {from, to}, x);
  }
  static Answers answers(const Rule& rule, const MovingSet<Path>&) {
    const std::vector<Id> hull = rule.inner().hull();
    Answers answers;
    for (std::size_t i = 0; i < hull.size(); ++i) answers[hull[i]] = {hull[i], hull[(i + 1) % hull.size()]};
    return answers;
  }
};

struct FatTree : structures::AabbTreeRule<Path, 2> {
  FatTree() : structures::AabbTreeRule<Path, 2>({0.25, 0}) {}
};
struct OfPairs {
  using Rule = FatTree;
  using Heard = structures::PairChange;
  static constexpr std::uint32_t ids = 64;
  static void take(const Heard& change, const Rule&, const MovingSet<Path>& x, Told<Path>& told) {
    const auto& [what, a, b] = change;
    if (what == Heard::What::came) return told.put_new(ids * a + b, {a, b}, x);
    told.require(ids * a + b, {a, b});
    what == Heard::What::went ? told.erase(ids * a + b) : told.put(ids * a + b, {a, b}, x);
  }
  static Answers answers(const Rule& rule, const MovingSet<Path>&) {
    Answers answers;
    for (const auto& [a, b] : rule.pairs()) answers[ids * a + b] = {a, b};
    return answers;
  }
};

/// The longest side of the convex hull.
class LongestSideRule : public structures::ChampionRule<LongestSideRule, structures::HullEdgesRule<Path>,
                                                        certificates::DistanceOrder<Path>> {
 public:
  static constexpr const char* name = "LongestSide";

  const std::optional<std::array<Id, 2>>& side() const { return answer(); }

  Id candidate(const structures::HullEdgeChange& change) const { return change.from; }
  bool takes_part(Id from) const { return inner().contains(from); }
  std::array<Id, 2> ids(Id from) const { return {from, inner().next(from)}; }
  certificates::DistanceOrder<Path> better(Id side, Id other, const MovingSet<Path>& x) const {
    return {x[other], x[inner().next(other)], x[side], x[inner().next(side)]};
  }
  std::optional<std::array<Id, 2>> find_answer() const {
    return champion() == none ? std::nullopt : std::optional(ids(champion()));
  }
};

}  // namespace

TEST_CASE("a heap tells what is on top", "[told_changes][heap]") {
  CHECK(trials<OfHeap>(20000, random_motion<2>, {.steps = 40}) > 20);
}

TEST_CASE("extents tell which points are extreme", "[told_changes][extents]") {
  CHECK(trials<OfExtents>(20100, random_plane_motion<1>, {.steps = 40}) > 50);
}

TEST_CASE("the k least tell who is among them, and who is the last", "[told_changes][least]") {
  CHECK(trials<OfLeast>(20200, random_motion<2>, {.steps = 40}) > 50);
  CHECK(trials<OfLast>(20300, random_motion<2>, {.steps = 40}) > 50);
}

TEST_CASE("the k least tell what becomes of an edit of their number and of a ranking", "[told_changes][least]") {
  MovingSet<Value> set;
  for (Id id = 0; id < 6; ++id) set.insert(id, {{{1.0 * id, 0, 0}}, 0}, 0);
  Kinetic<FourthSmallest> least(set, 0);
  Kinetic<ToldRule<OfLeast>> among(least, 0);
  Kinetic<ToldRule<OfLast>> last(least, 0);
  CHECK(last.rule().told.answers() == Answers{{0, {3}}});
  const auto agree = [&] {
    return among.rule().told.answers() == OfLeast::answers(least.rule(), set) &&
           last.rule().told.answers() == OfLast::answers(least.rule(), set);
  };
  for (const std::size_t count : {2, 5, 0, 7, 6, 4}) {
    least.edit([count](FourthSmallest& rule, auto& repair) { rule.set_count(count, repair); }, 0);
    CHECK(agree());
    CHECK(among.rule().told.answers().size() == std::min<std::size_t>(count, 6));
  }
  least.edit([](FourthSmallest& rule, auto& repair) { rule.set_ranking({}, repair); }, 0);
  CHECK(agree());
}

TEST_CASE("a closest pair tells which it is", "[told_changes][closest_pair]") {
  const testing::TrialOptions options{.steps = 10, .first = 6, .most = 10};
  CHECK(trials<OfClosestPair>(20400, random_plane_motion<1>, options) > 20);
}

TEST_CASE("nearest neighbours tell whose is another", "[told_changes][nearest_neighbours]") {
  const testing::TrialOptions options{.steps = 10, .first = 2, .most = 10};
  CHECK(trials<OfNearest>(20500, random_plane_motion<1>, options) > 50);
  CHECK(trials<OfKNearest>(20600, random_plane_motion<1>, options) > 50);
}

TEST_CASE("a hull tells which of its edges come and go, also that of a triangulation", "[told_changes][hull]") {
  const testing::TrialOptions options{.steps = 20, .first = 3, .most = 12};
  CHECK(trials<OfHullEdges<structures::ConvexHullRule<Path>>>(20700, random_plane_motion<1>, options) > 50);
  CHECK(trials<OfHullEdges<structures::DelaunayRule<Path>>>(20800, random_plane_motion<1>, options) > 50);
}

TEST_CASE("a tree of boxes tells which pairs come and go", "[told_changes][aabb_tree]") {
  const testing::TrialOptions options{.steps = 10, .first = 4, .most = 8, .one_in = 8};
  const auto slow = [](Random& random, Kind kind, double now) {  // few boxes are passed in a second
    return random_plane_motion<1>(random, kind == Kind::scales ? Kind::generic : kind, now);
  };
  CHECK(trials<OfPairs>(20900, slow, options) > 50);
}

TEST_CASE("the longest side of a hull, by a rule that stands on its edges, is the longest", "[told_changes][hull]") {
  const auto check = [](const LongestSideRule& rule, const MovingSet<Path>& set, double now) {
    const std::vector<Id> hull = rule.inner().inner().hull();
    if (!rule.side()) return static_cast<int>(!hull.empty());
    const ExactPlane plane(set, now);
    const auto [a, b] = *rule.side();
    int wrong = rule.inner().next(a) != b;
    for (std::size_t i = 0; i < hull.size(); ++i) {
      wrong += plane.compare_distances(a, b, hull[i], hull[(i + 1) % hull.size()]) < 0;
    }
    return wrong;
  };
  std::size_t events = 0;
  for (const Kind kind : all_kinds) {
    const std::uint64_t seed = 21000;
    CAPTURE(static_cast<int>(kind), seed);
    const auto found = testing::try_rule({.seed = seed, .kind = kind, .steps = 16, .first = 6, .most = 12},
                                         LongestSideRule{}, random_plane_motion<1>, check);
    CHECK(found.first == "");
    events += found.events.size();
  }
  CHECK(events > 200);
}

}  // namespace test_told_changes
