// What the benchmark of speed stands on: scenes without overlap, and a frame simulation that finds the engine's
// contacts.
#include "tests/benchmarks/speed/isolated.hpp"
#include "tests/benchmarks/speed/methods.hpp"
#include "tests/benchmarks/speed/peers/frame_simulation.hpp"
#include "tests/benchmarks/speed/race.hpp"
#include "tests/benchmarks/speed/scenes.hpp"

#include <catch2/catch.hpp>

#include <sys/mman.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <tuple>
#include <vector>

namespace test_speed {
namespace {

using namespace speed;

/// Pairs that overlap or touch, and balls that are not inside the box.
std::size_t misplaced(const BallScene& scene) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < scene.balls.size(); ++i) {
    const auto& a = scene.balls[i];
    const bool inside =
        (a.position.array() >= a.radius).all() && (a.position.array() <= scene.side.array() - a.radius).all();
    wrong += inside ? 0 : 1;
    for (std::size_t j = 0; j < i; ++j) {
      const auto& b = scene.balls[j];
      wrong += (a.position - b.position).norm() <= a.radius + b.radius ? 1 : 0;
    }
  }
  return wrong;
}

/// Tests all pairs: the plainest broad phase there is.
class AllBoxes {
 public:
  AllBoxes(const BallScene&, const std::vector<SweptBox>& boxes) : boxes_(boxes) {}
  void move(std::uint32_t i, const SweptBox& box) { boxes_[i] = box; }
  void update() {}
  template <class Found>
  void for_each_pair(Found found) {
    for (std::uint32_t i = 0; i < boxes_.size(); ++i) {
      for (std::uint32_t j = 0; j < i; ++j) {
        if (overlap(boxes_[i], boxes_[j])) found(j, i);
      }
    }
  }
  template <class Found>
  void renew(std::uint32_t i, const SweptBox& box, Found found) {
    boxes_[i] = box;
    for (std::uint32_t j = 0; j < boxes_.size(); ++j) {
      if (j != i && overlap(box, boxes_[j])) found(j);
    }
  }

 private:
  std::vector<SweptBox> boxes_;
};

}  // namespace

TEST_CASE("speed scenes: balls lie apart inside the box, whatever is asked for", "[speed]") {
  for (const Flatness flatness : {Flatness::cube, Flatness::slab, Flatness::line}) {
    for (const double packing : {0.001, 0.25}) {
      for (const double spread : {1.0, 1000.0}) {
        for (const std::size_t bodies : {1, 10, 400}) {
          SceneOptions options;
          options.bodies = bodies;
          options.packing = packing;
          options.size_spread = spread;
          options.draw = Draw::logarithmic;
          options.flatness = flatness;
          const BallScene scene = make_scene(options);
          INFO(bodies << " balls, packing " << packing << ", sizes 1:" << spread << ", " << name(flatness));
          CHECK(scene.balls.size() == bodies);
          CHECK(misplaced(scene) == 0);
          CHECK(scene.packing <= packing * (1 + 1e-12));
          if (bodies == 400 && spread == 1 && flatness == Flatness::cube) CHECK(scene.packing > 0.999 * packing);
        }
      }
    }
  }
}

TEST_CASE("speed scenes: spreads, means and shares are those asked for", "[speed]") {
  SceneOptions options;
  options.bodies = 4000;
  options.at_rest = 0.5;
  const BallScene scene = make_scene(options);
  double least = 1e9, most = 0, sum = 0;
  std::size_t resting = 0;
  for (const auto& ball : scene.balls) {
    least = std::min(least, ball.radius);
    most = std::max(most, ball.radius);
    sum += ball.radius;
    resting += ball.velocity.isZero(0) ? 1 : 0;
  }
  CHECK(sum / 4000 == Approx(1));
  CHECK(most / least == Approx(3).epsilon(0.01));
  CHECK(std::abs(static_cast<double>(resting) - 2000) < 200);  // six standard deviations
  CHECK_THROWS_AS(make_scene({.bodies = 0}), std::invalid_argument);
  CHECK_THROWS_AS(make_scene({.packing = 0.5}), std::invalid_argument);
}

TEST_CASE("speed peers: the frame simulation finds the engine's contacts at the engine's times", "[speed]") {
  const auto by_bodies = [](std::vector<Meeting>& list) {
    std::sort(list.begin(), list.end(), [](const Meeting& x, const Meeting& y) {
      return std::tuple(x.a, x.b, x.time) < std::tuple(y.a, y.b, y.time);
    });
  };
  for (const double rate : {1.0, 7.0, 300.0}) {
    SceneOptions options;
    options.bodies = 60;
    options.packing = 0.15;
    options.at_rest = 0.3;
    options.seed = 11;
    const BallScene scene = make_scene(options);
    const Drive drive{rate, 3};
    std::vector<Meeting> expected, found;
    run_method(scene, methods().front(), drive, &expected);
    const PeerOutcome outcome = run_peer<AllBoxes>(scene, drive, &found);
    by_bodies(expected);
    by_bodies(found);
    INFO("rate " << rate);
    REQUIRE(expected.size() > 40);
    REQUIRE(found.size() == expected.size());
    CHECK(outcome.tests >= found.size());
    std::size_t others = 0;
    double worst = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      others += found[i].a == expected[i].a && found[i].b == expected[i].b ? 0 : 1;
      worst = std::max(worst, std::abs(found[i].time - expected[i].time));
    }
    CHECK(others == 0);
    CHECK(worst < 1e-9);
  }
}

TEST_CASE("speed race: what takes too long is ended, and different events are noticed", "[speed]") {
  const auto spin = [](double seconds) {
    return [seconds] {
      const double begin = kds::benchmarks::thread_seconds();
      while (kds::benchmarks::thread_seconds() - begin < seconds) {
      }
      Run run;
      run.run = seconds;
      run.events = seconds < 0.015 ? 1 : 2;
      return run;
    };
  };
  RaceOptions options;
  options.rounds = 2;
  options.floor = 0.05;
  options.least = 0;
  const auto results = race({{"quick", spin(0.01)}, {"slow", spin(0.02)}, {"hopeless", spin(10)}}, options);
  CHECK_FALSE(results[0].cut);
  CHECK_FALSE(results[1].cut);
  CHECK(results[2].cut);
  CHECK_THROWS_AS(check_agreement(results, "test"), std::runtime_error);
  CHECK_NOTHROW(check_agreement({results[0], results[2]}, "test"));
  CHECK_THROWS_AS(isolated(1, []() -> int { throw std::runtime_error("a run that fails, on purpose"); }),
                  std::runtime_error);
}

TEST_CASE("speed race: rounds go on until ratios are known", "[speed]") {
  // Counts runs of all processes; each of which says how long it has taken.
  void* memory = mmap(nullptr, 2 * sizeof(int), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  REQUIRE(memory != MAP_FAILED);
  int* const runs = new (memory) int[2]{0, 0};
  /// Its round k takes `seconds`, and so much more in every other one.
  const auto entrant = [&](int which, double seconds, double more) {
    return [=] {
      Run run;
      run.run = seconds * (1 + (++runs[which] / 2 % 2 == 0 ? more : 0));
      return run;
    };
  };
  RaceOptions options;
  options.rounds = 9;
  options.most_rounds = 40;
  options.least = 0;
  const auto rounds_of = [&](int which) { return (runs[which] + 1) / 2; };  // of two runs each, but for the first
  const auto race_of = [&](double seconds, double more) {
    runs[0] = runs[1] = 0;
    return race({{"first", entrant(0, 1e-3, 0)}, {"other", entrant(1, seconds, more)}}, options);
  };
  const auto steady = race_of(1.1e-3, 0);
  CHECK(rounds_of(0) == 9);
  CHECK(rounds_of(1) == 9);
  CHECK(ratio(steady[1], steady[0]).median == Approx(1.1));
  race_of(1.1e-3, 0.015);  // 1.5 %: within 1 % either way
  CHECK(rounds_of(1) == 9);
  const auto unsteady = race_of(1.1e-3, 0.1);
  CHECK(rounds_of(0) == 40);
  CHECK(rounds_of(1) == 40);
  const Ratio r = ratio(unsteady[1], unsteady[0]);
  CHECK(r.low == Approx(1.1));
  CHECK(r.high == Approx(1.21));
  race_of(3e-3, 0.1);
  CHECK(rounds_of(1) == 9);  // far: no more than that
  munmap(memory, 2 * sizeof(int));
}

TEST_CASE("speed race: a ratio is the median over rounds", "[speed]") {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Result x, y;
  x.best.run = x.best_run = 5;
  y.best.run = y.best_run = 2;
  x.rounds = {{100, 50}, {3, 1.5}, {6, 6}};
  y.rounds = {{1, 1}, {2, 1}, {4, 2}};
  CHECK(ratio(x, y).median == 2.5);  // best over best: two rounds are too few
  x.best.setup = 1;
  CHECK(ratio(x, y).median == 3);
  CHECK(ratio(x, y, &Round::run).median == 2.5);
  x.rounds.insert(x.rounds.end(), {{none, none}, {30, 30}});  // a slow moment of the machine, for both
  y.rounds.insert(y.rounds.end(), {{7, 7}, {20, 10}});
  CHECK(ratio(x, y).median == 1.5);
  CHECK(ratio(x, y).low == 1.5);
  CHECK(ratio(x, y).high == 1.5);
  CHECK(ratio(x, y, &Round::run).median == 3);  // of 1.5, 3, 3
  CHECK(ratio(y, x).median == 1 / 1.5);
  x.cut = true;
  CHECK(ratio(x, y).median == 3);

  Result many, one;
  many.rounds.push_back({1, 1});
  one.rounds.push_back({1, 1});
  for (int k = 0; k < 100; ++k) {  // 0 ... 99, shuffled: 37 and 100 have no common divisor
    many.rounds.push_back({static_cast<double>(37 * k % 100), 0});
    one.rounds.push_back({1, 1});
  }
  CHECK(ratio(many, one).median == 49.5);
  CHECK(ratio(many, one).low == 39);  // the 40th and the 61st: the interval of textbooks for n = 100
  CHECK(ratio(many, one).high == 60);
}

}  // namespace test_speed
