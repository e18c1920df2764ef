// The kinetic AABB tree against brute force: fat boxes, pairs, reports, queries.
#include "certificates/plane_motion.hpp"
#include "certificates/point_motion.hpp"
#include "kds/testing/trial.hpp"
#include "structures/aabb_tree.hpp"
#include "tests/structures/random_values.hpp"
#include "tests/structures/to_log.hpp"
#include "tests/support/exact_algebra.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <vector>

namespace kds::structures {
template <class Path>
MovingBox<Path> restarted(const MovingBox<Path>& box, double t) {
  return {testing::detail::restarted_at(box.min, t), testing::detail::restarted_at(box.max, t)};
}
}  // namespace kds::structures

namespace test_aabb_tree {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::PlaneMotion;
using certificates::PointMotion;
using structures::AabbTreeRule;
using structures::MovingBox;
using structures::TreeBox;
using testing::Findings;
using testing::try_rule;

template <int Degree>
auto random_path(Random& random, Kind kind, double now, std::integral_constant<std::size_t, 1>) {
  return random_motion<Degree>(random, kind, now);
}
template <int Degree>
auto random_path(Random& random, Kind kind, double now, std::integral_constant<std::size_t, 2>) {
  return random_plane_motion<Degree>(random, kind, now);
}
template <int Degree>
auto random_path(Random& random, Kind kind, double now, std::integral_constant<std::size_t, 3>) {
  return random_point_motion<Degree>(random, kind, now);
}

/// Corners that move alike, grow apart, or go each its way and pass each other.
template <int Degree>
MovingBox<PointMotion<Degree>> random_box(Random& random, Kind kind, double now) {
  const auto path = [&] { return random_path<Degree>(random, kind, now, std::integral_constant<std::size_t, 3>{}); };
  MovingBox<PointMotion<Degree>> box{path(), {}};
  box.max = box.min;
  if (random.one_in(4)) box.max = path();
  for (int d = 0; d < 3; ++d) box.max.coefficients[0][d] += random.one_in(3) ? 0 : random.integer(0, 2);
  return box;
}

template <class Path>
oracle::Polynomial axis(const Path& path, std::size_t d) {
  if constexpr (requires { path.axis(0); }) {
    const auto motion = path.axis(static_cast<int>(d));
    return oracle::Polynomial::motion({motion.position.c.begin(), motion.position.c.end()}, motion.start);
  } else {
    return oracle::Polynomial::motion({path.position.c.begin(), path.position.c.end()}, path.start);
  }
}
template <class E>
oracle::Polynomial end(const E& element, std::size_t d, bool upper) {
  if constexpr (requires { element.min; }) {
    return axis(upper ? element.max : element.min, d);
  } else {
    return axis(element, d);
  }
}

bool not_above(const oracle::Polynomial& a, const oracle::Polynomial& b, double now) {
  return (b - a).sign_after(oracle::rational(now)) >= 0;
}

/// The pairs that were told of.
struct Told {
  std::set<std::array<Id, 2>>* pairs;
  int* wrong;
  double* last;
  void pair_began(Id a, Id b, double t) { *wrong += !(a < b) || !pairs->insert({a, b}).second, at(t); }
  void pair_ended(Id a, Id b, double t) { *wrong += pairs->erase({a, b}) != 1, at(t); }
  void at(double t) {
    *wrong += t < *last;
    *last = t;
  }
};

template <class E, std::size_t Dimension, class Listener>
int check_tree(const AabbTreeRule<E, Dimension, Listener>& rule, const MovingSet<E>& set, double now) {
  int wrong = 0;
  const std::vector<Id> ids = set.ids();
  for (const Id a : ids) {
    for (std::size_t d = 0; d < Dimension; ++d) {
      const TreeBox<Dimension>& box = rule.box(a);
      if (std::isfinite(box.min[d])) wrong += !not_above(oracle::rational(box.min[d]), end(set[a], d, false), now);
      if (std::isfinite(box.max[d])) wrong += !not_above(end(set[a], d, true), oracle::rational(box.max[d]), now);
    }
    for (const Id b : ids) {
      if (b <= a) continue;
      bool meet = true;
      for (std::size_t d = 0; d < Dimension; ++d) {
        meet = meet && not_above(end(set[a], d, false), end(set[b], d, true), now) &&
               not_above(end(set[b], d, false), end(set[a], d, true), now);
      }
      const bool paired = rule.paired(a, b);
      wrong += paired != rule.paired(b, a) || paired != rule.box(a).overlaps(rule.box(b));
      wrong += meet != rule.meet(set[a], set[b], now);
      // A box that is empty has ends that its fat box need not hold.
      const auto empty = [&](Id id) {
        for (std::size_t d = 0; d < Dimension; ++d) {
          if (!not_above(end(set[id], d, false), end(set[id], d, true), now)) return true;
        }
        return false;
      };
      wrong += meet && !paired && !empty(a) && !empty(b);
    }
  }
  TreeBox<Dimension> asked;
  asked.min.fill(-1);
  asked.max.fill(0.5);
  asked.max[0] = ids.size() % 2 == 0 ? std::numeric_limits<double>::infinity() : 0.25;
  std::vector<Id> expected;
  for (const Id id : ids) {
    bool inside = true;
    for (std::size_t d = 0; d < Dimension; ++d) {
      inside = inside && not_above(oracle::rational(asked.min[d]), end(set[id], d, true), now);
      if (asked.max[d] < 1) inside = inside && not_above(end(set[id], d, false), oracle::rational(asked.max[d]), now);
    }
    if (inside && rule.box(id).overlaps(asked)) expected.push_back(id);
  }
  return wrong + (rule.query(asked, set, now) != expected);
}

template <int Degree, std::size_t Dimension>
void run_points(std::uint64_t seed, Kind kind, structures::AabbTreeOptions options) {
  using Dimensions = std::integral_constant<std::size_t, Dimension>;
  using Path = decltype(random_path<Degree>(std::declval<Random&>(), kind, 0, Dimensions{}));
  CAPTURE(Degree, Dimension, static_cast<int>(kind), seed, options.slack, options.ahead);
  const auto make = [](Random& random, Kind k, double now) {
    return random_path<Degree>(random, k, now, Dimensions{});
  };
  const Findings found = try_rule({seed, kind, 12, 9, 12, seed % 2 == 0 ? never : 0.5, 5},
                                  AabbTreeRule<Path, Dimension>(options), make,
                                  check_tree<Path, Dimension, structures::NoPairListener>);
  CHECK(found.first == "");
  if (kind == Kind::generic && options.slack == 0.125) CHECK(found.events.size() > 20);
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("a kinetic AABB tree holds its points, their pairs and answers, exactly", "[aabb_tree]",
                       ((int Degree), Degree), 1, 2) {
  std::uint64_t seed = 900;
  for (const Kind kind : all_kinds) {
    run_points<Degree, 1>(seed++, kind, {kind == Kind::scales ? 0.0 : 0.125, kind == Kind::scales ? 0.25 : 0.0});
    run_points<Degree, 2>(seed++, kind, {0, 0.25});
    run_points<Degree, 3>(seed++, kind, {kind == Kind::scales ? 1e3 : 0.125, 0.125});
  }
}

TEMPLATE_TEST_CASE_SIG("a kinetic AABB tree of boxes, also of such as turn inside out", "[aabb_tree]",
                       ((int Degree), Degree), 1, 2) {
  using E = MovingBox<PointMotion<Degree>>;
  for (const Kind kind : all_kinds) {
    const std::uint64_t seed = 940;
    CAPTURE(Degree, static_cast<int>(kind), seed);
    CHECK(try_rule({seed, kind, 12, 8, 12, never, 5}, AabbTreeRule<E, 3>({kind == Kind::scales ? 1e3 : 0.0, 0.25}),
                   random_box<Degree>, check_tree<E, 3, structures::NoPairListener>)
              .first == "");
  }
}

TEST_CASE("a kinetic AABB tree tells of each pair when it begins and when it ends", "[aabb_tree]") {
  const std::uint64_t seed = 950;
  CAPTURE(seed);
  Random random(seed);
  using E = PlaneMotion<1>;
  MovingSet<E> set;
  const auto make = [&](double now) {
    return random_path<1>(random, Kind::generic, now, std::integral_constant<std::size_t, 2>{});
  };
  for (Id id = 0; id < 40; ++id) set.insert(id, make(0), 0);
  std::set<std::array<Id, 2>> pairs;
  int wrong = 0;
  double last = 0;
  using Rule = AabbTreeRule<E, 2, Told>;
  Kinetic<Rule> tree(set, 0, Rule({0.1, 0.05}, {&pairs, &wrong, &last}));
  Simulator simulator(0, tree);
  const auto check = [&] {
    std::set<std::array<Id, 2>> expected;
    for (const Id a : set.ids()) {
      for (const Id b : set.ids()) {
        if (a < b && tree.rule().box(a).overlaps(tree.rule().box(b))) expected.insert({a, b});
      }
    }
    const auto listed = tree.rule().pairs();
    wrong += expected != pairs || !std::equal(listed.begin(), listed.end(), pairs.begin(), pairs.end());
  };
  check();
  const std::size_t first = pairs.size();
  std::uint64_t changes = 0, external = 0;
  for (int step = 1; step <= 40; ++step) {
    while (simulator.next_time() <= step * 0.05) {
      const auto before = pairs;
      simulator.step();
      check();
      changes += before != pairs;
    }
    simulator.advance_to(step * 0.05);
    external = tree.measures().external;
    wrong += external != changes;
    const Id id = static_cast<Id>(random.below(40));
    if (set.contains(id)) {
      step % 2 == 0 ? set.remove(id, simulator.now()) : set.update(id, make(simulator.now()), simulator.now());
    } else {
      set.insert(id, make(simulator.now()), simulator.now());
    }
    check();
    simulator.audit();
  }
  CHECK(wrong == 0);
  CHECK(first > 0);
  CHECK(external > 50);
  for (const Id id : set.ids()) set.remove(id, simulator.now());
  CHECK(pairs.empty());
  CHECK(tree.rule().tree().size() == 0);
  CHECK(wrong == 0);
}

TEST_CASE("a kinetic AABB tree keeps to its measures", "[aabb_tree]") {
  const std::uint64_t seed = 960;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<PointMotion<1>> set;
  const Id n = 200;
  for (Id id = 0; id < n; ++id) {
    PointMotion<1> path;
    for (auto& c : path.coefficients) c = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    path.coefficients[0] *= 10;
    set.insert(id, path, 0);
  }
  using Rule = AabbTreeRule<PointMotion<1>, 3>;
  Kinetic<Rule> tree(set, 0, Rule({0, 0.5}));
  Simulator simulator(0, tree);
  simulator.advance_to(10);
  const Measures m = tree.measures();
  CHECK(m.held == 6 * n);
  CHECK(m.most_held == 6 * n);     // compact
  CHECK(m.most_per_element == 6);  // local
  CHECK(m.most_touched == 6);      // responsive
  CHECK(m.events <= 20 * n);       // once in 0.5 s each
  CHECK(m.events >= 19 * n);
  CHECK(tree.rule().tree().depth() < 4 * std::log2(n));

  set.update(3, set[3].restarted(10), 10);  // where it is, so it keeps its box
  const TreeBox<3> box = tree.rule().box(3);
  PointMotion<1> at_rest{{set[3].position(10), Eigen::Vector3d::Zero()}, 10};
  set.update(3, at_rest, 10);
  CHECK(tree.rule().box(3) == box);
  simulator.audit();
}

TEST_CASE("fat boxes must be fat", "[aabb_tree]") {
  using Rule = AabbTreeRule<Motion<1>, 1>;
  CHECK_THROWS_AS(Rule({0, 0}), std::invalid_argument);
  CHECK_THROWS_AS(Rule({-1, 1}), std::invalid_argument);
  CHECK_THROWS_AS(Rule({1, never}), std::invalid_argument);
  CHECK_THROWS_AS(Rule({std::nan(""), 1}), std::invalid_argument);
}

TEST_CASE("motions that leave the doubles have infinite boxes and no events", "[aabb_tree][degeneracy]") {
  MovingSet<Motion<2>> set;
  set.insert(0, {{{1e308, 1e308, 1e308}}, 0}, 0);
  set.insert(1, {{{0, 0, 0}}, 0}, 0);
  using Rule = AabbTreeRule<Motion<2>, 1>;
  Kinetic<Rule> tree(set, 0, Rule({0, 10}));
  CHECK(tree.next_time() == never);
  CHECK(tree.rule().paired(0, 1));
  CHECK(tree.rule().query({{-1}, {1}}, set, 0) == std::vector<Id>{1});
  tree.audit(0);
}

}  // namespace test_aabb_tree
