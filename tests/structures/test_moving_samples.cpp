// Samples that move on: positions and velocities at times, with a bound on the acceleration.
#include "certificates/direction_order.hpp"
#include "certificates/distance_order.hpp"
#include "certificates/in_circle.hpp"
#include "certificates/orientation.hpp"
#include "certificates/plane_motion.hpp"
#include "examples/list_in_forty_lines.hpp"
#include "kds/framework/snapshot.hpp"
#include "kds/simulator.hpp"
#include "structures/closest_pair.hpp"
#include "structures/heap.hpp"
#include "tests/structures/sampled_orbits.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <type_traits>
#include <vector>

namespace test_moving_samples {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::BoundedAccelerationPoint;
using certificates::PlaneMotion;
using examples::ListRule;

/// Values that swing: known to the sampler only.
struct Swing {
  double middle, width, frequency;
  double position(double t) const { return middle + width * std::sin(frequency * t); }
  double velocity(double t) const { return width * frequency * std::cos(frequency * t); }

  BoundedAcceleration moving(double t) const { return {position(t), velocity(t), width * frequency * frequency, t}; }
  Bounded resting(double t) const { return {position(t), width * frequency, t}; }
};

std::vector<Swing> swings(std::uint64_t seed, std::size_t n) {
  Random random(seed);
  std::vector<Swing> result(n);
  for (auto& s : result) s = {random.between(-4, 4), random.between(0, 0.6), random.between(0.1, 2)};
  return result;
}

template <class Sample>
struct Sampling {
  std::vector<Swing> swing;
  double tick;
  MovingSet<Sample> set;
  Sampling(std::uint64_t seed, std::size_t n, double tick_) : swing(swings(seed, n)), tick(tick_) {
    set.sample_with([this](Id id, double t) { return sample(id, t); }, tick);
    for (Id id = 0; id < n; ++id) set.insert(id, sample(id, 0), 0);
  }
  Sample sample(Id id, double t) const {
    if constexpr (MovingSample<Sample>) {
      return swing[id].moving(t);
    } else {
      return swing[id].resting(t);
    }
  }
};

}  // namespace

TEST_CASE("samples that move on: out of order by less than a tick's acceleration, and taken rarely",
          "[framework][bounded]") {
  for (const std::uint64_t seed : {900, 901, 902}) {
    CAPTURE(seed);
    const Id n = 12;
    const double end = 10;
    Sampling<BoundedAcceleration> moving(seed, n, 0.01);
    Sampling<Bounded> resting(seed, n, 0.01);
    Kinetic<ListRule<BoundedAcceleration>> list(moving.set, 0);
    Kinetic<structures::HeapRule<structures::ByValue<BoundedAcceleration>>> heap(moving.set, 0);
    Kinetic<ListRule<Bounded>> old(resting.set, 0);
    Simulator simulator(0, list, heap, old);
    if (seed == 902) simulator.set_window(0.5);
    int wrong = 0;
    for (double t = 0.05; t < end; t += 0.05) {
      simulator.advance_to(t);
      simulator.audit();
      const auto& order = list.rule().order;
      const auto slack = [&](Id a, Id b) {  // what two values can do against their samples within a tick
        return 0.5 * 0.01 * 0.01 * (moving.set[a].acceleration + moving.set[b].acceleration) * (1 + 1e-9) + 1e-14;
      };
      for (std::size_t i = 0; i + 1 < n; ++i) {
        const Id a = order[i], b = order[i + 1];
        wrong += moving.swing[a].position(t) > moving.swing[b].position(t) + slack(a, b);
      }
      for (Id id = 0; id < n; ++id) {  // each of log2 n certificates up to the top may be out by the slack
        const Id top = *heap.rule().top();
        wrong += moving.swing[id].position(t) > moving.swing[top].position(t) + 5e-4;
      }
    }
    CHECK(wrong == 0);
    CHECK(moving.set.samples() > n);
    CHECK(moving.set.samples() < 0.5 * resting.set.samples());  // although two structures ask for them
    CHECK(list.measures().events > n);
    CHECK(list.counters().events > 0);  // some samples cross before they may be taken anew
  }
}

TEST_CASE("certificates of points with bounded acceleration never fail late", "[plane][bounded]") {
  const std::uint64_t seed = 910;
  CAPTURE(seed);
  Random random(seed);
  int late = 0, wrong_sign = 0, ends = 0, tight = 0, epochs = 0;
  for (int round = 0; round < 300; ++round) {
    std::array<BoundedAccelerationPoint, 4> samples;
    std::array<PlaneMotion<2>, 4> truth;  // one of the motions that the samples allow: at full acceleration
    for (std::size_t i = 0; i < 4; ++i) {
      const double start = -random.unit(), x = random.between(-1, 1), y = random.between(-1, 1);
      const double u = random.between(-0.2, 0.2), v = random.between(-0.2, 0.2), a = random.between(0, 0.2);
      const auto bend = [&] { return 0.5 * (random.one_in(2) ? a : -a); };
      samples[i] = {{x, y}, {u, v}, a, start};
      truth[i] = {{{{{x, u, bend()}}, {{y, v, bend()}}}}, start};
    }
    const auto& [p, q, r, s] = samples;
    const auto& [a, b, c, d] = truth;
    const auto check = [&](const auto& sampled, const auto& real) {
      using C = std::remove_cvref_t<decltype(sampled)>;
      const Conservative<C> conservative{sampled};
      static_assert(Certificate<Conservative<C>>);
      const double promised = failure_time(conservative, 0);
      const double real_failure = failure_time(real, 0);
      late += sign_after(conservative, 0) > 0 && promised > real_failure;
      ends += promised > 0 && promised < never;
      wrong_sign += exact_sign(sampled, 0) <= 0 && promised != 0;
      tight += promised == real_failure && promised > 0;
      // The same function about every epoch, exactly: its value at 2.
      const auto near = conservative.template polynomial<Exact>(2.0);
      const auto far = conservative.template polynomial<Exact>(0.5);
      epochs += !((near(Exact(0.0)) - far(Exact(1.5))).sign() == 0);
    };
    using Sample = BoundedAccelerationPoint;
    using Path = PlaneMotion<2>;
    check(certificates::Orientation<Sample>{p, q, r}, certificates::Orientation<Path>{a, b, c});
    check(certificates::InCircle<Sample>{p, q, r, s}, certificates::InCircle<Path>{a, b, c, d});
    const std::array<double, 2> x{1, 0};
    check(certificates::DirectionOrder<Sample, 2>{p, q, x}, certificates::DirectionOrder<Path, 2>{a, b, x});
    check(certificates::DistanceOrder<Sample>{p, q, r, s}, certificates::DistanceOrder<Path>{a, b, c, d});
  }
  CHECK(late == 0);
  CHECK(wrong_sign == 0);
  CHECK(epochs == 0);
  CHECK(ends > 300);
  CHECK(tight > 15);  // In one dimension, towards each other at full acceleration, the bound is reached.
}

TEST_CASE("a Delaunay triangulation of moving samples is that of the truth where it is guaranteed",
          "[delaunay][bounded]") {
  using structures::DelaunayRule;
  const std::uint64_t seed = 920;
  CAPTURE(seed);
  Random random(seed);
  const Id n = 12;
  const Orbits orbits(random, n);  // known to the sampler only
  const auto sample = [&](Id id, double t) {
    return BoundedAccelerationPoint{orbits.position(id, t), orbits.velocity(id, t), orbits.acceleration(id), t};
  };
  MovingSet<BoundedAccelerationPoint> set;
  const double tick = 0.02, end = 8;
  set.sample_with(sample, tick);
  for (Id id = 0; id < n; ++id) set.insert(id, sample(id, 0), 0);
  Kinetic<DelaunayRule<BoundedAccelerationPoint>> delaunay(set, 0);
  Kinetic<structures::ClosestPairRule<BoundedAccelerationPoint>> pair(delaunay, 0);
  Simulator simulator(0, delaunay, pair);
  InCircleTests tests;
  for (double t = 0.125; t <= end; t += 0.125) {
    simulator.advance_to(t);
    simulator.audit();
    tests.count(delaunay, set, orbits, t);
  }
  CHECK(tests.wrong == 0);
  CHECK(tests.guaranteed > 0.9 * tests.all);
  CHECK(set.samples() > n);
  CHECK(set.samples() < 0.1 * n * end / tick);  // Sampling everything every tick takes n end / tick.
  CHECK(delaunay.rule().rebuilds() == 0);
}

TEST_CASE("samples that cross within a tick are put in order as they cross, and can be saved", "[framework][bounded]") {
  const auto sample = [](Id id, double t) { return BoundedAcceleration{id == 0 ? t : 1, id == 0 ? 1.0 : 0.0, 0.1, t}; };
  MovingSet<BoundedAcceleration> set;
  set.sample_with(sample, 10);
  CHECK_THROWS_AS(set.insert(0, {0, 0, -1, 0}, 0), std::invalid_argument);
  CHECK_THROWS_AS(set.insert(0, {0, never, 1, 0}, 0), std::invalid_argument);
  set.insert(0, sample(0, 0), 0);
  set.insert(1, sample(1, 0), 0);
  Kinetic<ListRule<BoundedAcceleration>> list(set, 0);
  Simulator simulator(0, list);
  CHECK(list.next_time() == 1);  // The guarantee ends before, but the sample is good for ten seconds.
  const Snapshot before = save(simulator, set);
  simulator.advance_to(1);
  CHECK(list.rule().order == std::vector<Id>{1, 0});
  CHECK(set.samples() == 0);
  CHECK(list.counters().events == 1);
  simulator.audit();
  CHECK(list.next_time() == 10);
  simulator.advance_to(10);
  CHECK(set.samples() == 2);
  restore(before, simulator, set);
  CHECK(list.next_time() == 1);
  CHECK_THROWS_AS(set.resample(7, 0), std::out_of_range);
}

namespace {

struct Calls {
  std::function<void(double)> function;
  void operator()(const ListRule<BoundedAcceleration>&, const KineticEvent& event) const {
    if (event.effect == Effect::external) function(event.time);
  }
};

/// At 10 the first two are to be sampled, and the last two have crossed. What is called then, and by the sampler.
struct Busy {
  static BoundedAcceleration sample(Id id, double t) {
    return {id < 2 ? 5.0 * id - 100 : id == 2 ? t : 10, id == 2 ? 1.0 : 0.0, 0.3, t};
  }
  MovingSet<BoundedAcceleration> set;
  Kinetic<ListRule<BoundedAcceleration>, Calls> list{set, 0};
  Simulator<Kinetic<ListRule<BoundedAcceleration>, Calls>> simulator{0, list};
  Busy() {
    set.sample_with(sample, 10);
    for (Id id = 0; id < 4; ++id) set.insert(id, sample(id, 0), 0);
  }
};

}  // namespace

TEST_CASE("samples that are due are taken even if a listener has thrown, or the sampler", "[framework][bounded]") {
  Busy busy;
  SECTION("the listener, in an edit") {
    busy.list.listener().function = [](double) { throw std::runtime_error("no more"); };
    CHECK_THROWS_WITH(busy.set.insert(7, {0, 0, 0, 10}, 10), "no more");
    CHECK_FALSE(busy.set.contains(7));
  }
  SECTION("the listener, in a step") {
    busy.list.listener().function = [](double) { throw std::runtime_error("no more"); };
    CHECK_THROWS_WITH(busy.simulator.step(), "no more");
  }
  SECTION("the sampler") {
    busy.list.listener().function = [](double) {};
    busy.set.sample_with([](Id, double) -> BoundedAcceleration { throw std::runtime_error("no more"); }, 10);
    CHECK_THROWS_WITH(busy.simulator.step(), "no more");
  }
  CHECK(busy.list.next_time() == 10);
  busy.list.audit(10);
  busy.list.listener().function = [](double) {};
  busy.set.sample_with(Busy::sample, 10);
  busy.simulator.advance_to(10);
  busy.simulator.audit();
  CHECK(busy.set[0].start == 10);
  CHECK(busy.set[1].start == 10);
  CHECK(busy.list.rule().order == std::vector<Id>{0, 1, 3, 2});
}

TEST_CASE("the listener of a crossing may remove what is to be sampled at its time", "[framework][bounded]") {
  Busy busy;
  busy.list.listener().function = [&](double t) { busy.set.remove(0, t); };
  busy.simulator.advance_to(10);
  busy.simulator.audit();
  CHECK(busy.list.rule().order == std::vector<Id>{1, 3, 2});
}

}  // namespace test_moving_samples
