// The public test kit: right rules pass, and each kind of mistake is found.
#include "examples/list_in_forty_lines.hpp"
#include "kds/testing/trial.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

namespace test_trial {
namespace {

using namespace kds;
using namespace kds::testing;
using examples::ListRule;
using Value = Motion<2>;
using List = ListRule<Value>;
using Pen = Repair<Value, examples::NewNeighbour>;

int check_order(const List& rule, const MovingSet<Value>& values, double now) {
  int wrong = rule.order.size() != values.size();
  for (std::size_t i = 1; i < rule.order.size(); ++i) {
    wrong += sign_after(certificates::Order<2>{values[rule.order[i - 1]], values[rule.order[i]]}, now) < 0;
  }
  return wrong;
}

struct ForgetsMarks : List {
  Effect repair(Slot left, Pen&) {
    std::swap(order[place[left]], order[place[left] + 1]);
    std::swap(place[left], place[order[place[left]]]);
    return Effect::external;
  }
};
struct ForgetsToSave : List {
  int inserted = 0;
  void insert(Id id, Pen& repair) {
    ++inserted;
    List::insert(id, repair);
  }
  template <class Archive>
  void archive(Archive& archive) {
    int saved = inserted;  // and not loaded
    archive(order, place, saved);
  }
};
struct Throws : List {
  void remove(Id, Pen&) { throw std::runtime_error("not today"); }
};

/// What is found first in any kind of motion.
template <class Rule, class Check>
std::string first_mistake(const Check& check) {
  for (const Kind kind : all_kinds) {
    const Findings found = try_rule({.seed = 5, .kind = kind}, Rule{}, random_motion<2>, check);
    if (!found.right()) return found.first;
  }
  return "";
}

}  // namespace

TEST_CASE("a right list passes a trial", "[testing]") {
  const auto check = [](const List& rule, const MovingSet<Value>& values, double now) {
    int wrong = rule.order.size() != values.size();
    for (std::size_t i = 1; i < rule.order.size(); ++i) {
      wrong += sign_after(certificates::Order<2>{values[rule.order[i - 1]], values[rule.order[i]]}, now) < 0;
    }
    return wrong;
  };
  for (const Kind kind : all_kinds) {  // random bits, lattices, clocks where doubles are a second apart ...
    const Findings found = try_rule({.seed = 1, .kind = kind}, List{}, random_motion<2>, check);
    CHECK(found.first == "");
    CHECK(found.states > 20);
  }
}

TEST_CASE("mistakes are found in a trial, and named", "[testing]") {
  CHECK(first_mistake<List>(check_order) == "");
  CHECK_THAT(first_mistake<ForgetsMarks>(check_order), Catch::Contains("seed 5: ListRule: "));
  CHECK_THAT(first_mistake<ForgetsToSave>(check_order), Catch::Contains("another run ends in another state"));
  CHECK_THAT(first_mistake<Throws>(check_order), Catch::Contains("not today"));
  const auto never_right = [](const List&, const MovingSet<Value>&, double) { return 1; };
  CHECK_THAT(first_mistake<List>(never_right), Catch::Contains("the state at 0 is wrong"));
  const auto wrong_when_reversed = [](const List&, const MovingSet<Value>& values, double) {
    return values.backwards() ? 1 : 0;
  };
  CHECK_THAT(first_mistake<List>(wrong_when_reversed), Catch::Contains("is wrong"));
  CHECK(try_rule({.backwards = false}, List{}, random_motion<2>, wrong_when_reversed).right());
}

TEST_CASE("a trial edits the rule, too", "[testing]") {
  int edits = 0;
  const auto edit = [&](auto& list, Random& random, double now) {
    if (!random.one_in(3)) return;
    ++edits;
    list.edit([](List& rule, Pen& repair) { rule.renew(0, rule.order.size(), rule.order.size(), repair); }, now);
  };
  const Findings found = try_rule({.seed = 6, .steps = 30}, List{}, random_motion<2>, check_order, edit);
  CHECK(found.first == "");
  CHECK(edits > 5);
}

}  // namespace test_trial
