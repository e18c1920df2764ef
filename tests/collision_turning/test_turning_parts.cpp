// The parts of a world that are about bodies that turn, each by itself.
#include "collision/parallel/motion_changes.hpp"
#include "collision/world/bodies_image.hpp"
#include "collision/world/resting/resting_contacts.hpp"
#include "collision/world/turning/tumbling.hpp"
#include "collision/world/turning/turning_rest.hpp"
#include "kds/audit.hpp"
#include "tests/collision/world/through_bytes.hpp"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

namespace kds::collision::test_turning_parts {
namespace {

using Catch::Contains;
using certificates::RigidMotion;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::collision::tests::through_bytes;

template <int Degree>
using Description = BasicBodyDescription<RigidMotion<Degree>>;

/// Adds a body that has entered.
template <int Degree>
BodySlot add(Bodies<RigidMotion<Degree>>& bodies, const Description<Degree>& description) {
  auto shape = std::make_shared<const PlacedShape>(place(description.shape, description.orientation));
  const BodySlot slot = bodies.add(description, std::move(shape), description.motion.front());
  bodies[slot].entered = true;
  return slot;
}

/// Bodies that precess.
struct Spinning {
  using Motion = RigidMotion<1>;

  WorldOptions options;
  WorldCounters counters;
  Bodies<Motion> bodies;
  Tumbling<Motion> tumbling{bodies, options, counters};

  static Motion motion() {
    Motion motion{{{Vector3d(1, 2, 3), Vector3d(0.5, 0, 0)}}};
    motion.angular_velocity = Vector3d(3, 0.2, -0.1);
    return motion;
  }
  /// One that turns about its middle axis, nearly, and so does not do so for long.
  BodySlot add(const Vector3d& moments = {2, 1, 3}) {
    const BodySlot slot = test_turning_parts::add<1>(bodies, {.shape = Box{{1, 2, 3}}, .motion = {motion()}});
    bodies[slot].tumbles = true;
    bodies[slot].entered = false;  // or it would go on with the piece that it has
    tumbling.add(slot, principal_inertia(moments.asDiagonal()));
    bodies.move(slot, tumbling.take_up(slot, motion(), 0));
    bodies[slot].entered = true;
    return slot;
  }
  /// Takes the next piece of some body.
  BodySlot turn_on() {
    const auto piece = tumbling.take_next();
    bodies.move(piece.slot, piece.motion);
    return piece.slot;
  }
};

/// Bodies that may come to rest, with a record of what they are told.
struct Lying final : RestingListener<RigidMotion<2>> {
  using Motion = RigidMotion<2>;
  static constexpr double gravity = 10;

  WorldOptions options;
  Clock clock;
  Bodies<Motion> bodies;
  TurningRest<Motion> rest{bodies, options, clock};
  BodySlot floor = add<2>(bodies, {.shape = Box{{9, 9, 1}}, .motion = {at({0, 0, -1}, 0)}, .fixed = true});
  std::vector<BodySlot> taken_up;
  std::vector<std::tuple<bool, BodySlot, BodySlot>> told;  ///< begins or ends, of whom

  Lying() { rest.set_listener(*this); }

  void take_up(BodySlot slot, const Motion& motion) override {
    bodies.move(slot, motion);
    taken_up.push_back(slot);
  }
  void changed(BodySlot, BodySlot) override {}
  void let_pass(BodySlot, BodySlot) override {}
  void tell_rebound_suppressed(BodySlot, BodySlot) override {}
  void tell_resting(bool begins, const detail::RestingContact& contact) override {
    told.emplace_back(begins, contact.a, contact.b);
  }
  void tell_passes(const detail::RestingContact&) override {}
  void tell_touched(BodySlot) override {}

  static Motion at(const Vector3d& position, double pull, double start = 0) {
    return {{{position, Vector3d::Zero(), Vector3d(0, 0, -pull / 2)}, start}};
  }
  /// A ball that touches the floor.
  BodySlot add_ball(double x) {
    const BodySlot slot = add<2>(
        bodies,
        {.shape = Sphere{1}, .motion = {at({x, 0, 1}, gravity)}, .inertia = 0.4, .restitution = 0.3, .friction = 0.5});
    bodies.accelerate_freely(slot, bodies.motion(slot));
    return slot;
  }
  /// A ball touches the floor again, after a flight that was too short to see, at this multiple of the shortest flight.
  bool touch(BodySlot ball, double flights) {
    clock.now = flights * options.shortest_flight;
    const double x = bodies.path(ball).coefficients[0][0];
    if (!rest.carries(ball)) bodies.move(ball, at({x, 0, 1}, gravity, clock.now));
    return meet(ball, {.time = clock.now, .point = {x, 0, 0}, .normal = {0, 0, 1}});
  }
  /// Of a ball and the floor.
  bool meet(BodySlot ball, const Contact& contact) {
    return rest.comes_to_rest(floor, ball, contact, [](BodySlot) { return Mobility::of_spherical(1, 1 / 0.4); });
  }
  /// Of two balls side by side.
  bool meet_beside(BodySlot a, BodySlot b) {
    const double x = bodies.path(a).coefficients[0][0] + 1;
    return rest.comes_to_rest(a, b, {.time = clock.now, .point = {x, 0, 1}, .normal = {1, 0, 0}},
                              [](BodySlot) { return Mobility::of_spherical(1, 1 / 0.4); });
  }
  bool is_still(BodySlot slot) const {
    const auto& c = bodies.path(slot).coefficients;
    return c[1].isZero(0) && c[2].isZero(0) && bodies.motion(slot).angular_velocity.isZero(0);
  }
};

}  // namespace

TEST_CASE("Tumbling: piece after piece, each where the one before ends, near the free rotation", "[turning]") {
  Spinning part;
  CHECK(part.tumbling.next_time() == never);
  const BodySlot slot = part.add();
  const Vector3d momentum = part.tumbling.turning(slot, 0).angular_momentum;
  double last = 0;
  for (int i = 0; i < 200; ++i) {
    const double t = part.tumbling.next_time();
    REQUIRE(t > last);
    REQUIRE(t < never);
    CHECK_NOTHROW(part.tumbling.audit(t));
    const Quaterniond before = part.bodies.motion(slot).restarted(t).orientation;
    REQUIRE(part.turn_on() == slot);
    CHECK(part.bodies.path(slot).start == t);
    CHECK(part.bodies.motion(slot).orientation.angularDistance(before) < 1e-12);
    CHECK(part.tumbling.turning(slot, t).angular_momentum == momentum);  // to the bit
    CHECK_NOTHROW(part.tumbling.audit(t));
    last = t;
  }
  CHECK(part.counters.rotation_pieces == 200);
  part.tumbling.remove(slot);
  CHECK_FALSE(part.tumbling.has(slot));
  CHECK(part.tumbling.next_time() == never);
}

TEST_CASE("Tumbling: of pieces that end at one time the body with the lowest slot takes its next first", "[turning]") {
  Spinning part;
  const BodySlot a = part.add(), b = part.add(), c = part.add();
  for (int i = 0; i < 20; ++i) {
    const double t = part.tumbling.next_time();
    for (const BodySlot slot : {a, b, c}) {
      REQUIRE(part.tumbling.next_time() == t);
      REQUIRE(part.turn_on() == slot);
    }
    CHECK(part.bodies.motion(a) == part.bodies.motion(c));
  }
}

TEST_CASE("Tumbling: the audit finds a piece that is over, and a body that is turned otherwise", "[turning]") {
  Spinning part;
  const BodySlot slot = part.add();
  const double ends = part.tumbling.next_time();
  CHECK_THROWS_WITH(part.tumbling.audit(next_up(ends)), Contains("body 0: its piece of rotation is over"));
  auto motion = part.bodies.motion(slot);
  motion.orientation = Quaterniond(0, 1, 0, 0);
  part.bodies.move(slot, motion);
  CHECK_THROWS_WITH(part.tumbling.audit(0), Contains("body 0: it is off its free rotation"));
}

TEST_CASE("Tumbling: a copy goes on alike, and an image without one of its bodies is refused", "[turning]") {
  Spinning part, copy;
  part.add(), part.add();
  for (int i = 0; i < 5; ++i) part.turn_on();
  copy.add(), copy.add();
  for (const BodySlot slot : {0u, 1u}) copy.bodies.move(slot, part.bodies.motion(slot));
  const double now = part.bodies.path(0).start;
  auto image = through_bytes(part.tumbling.image());
  CHECK_NOTHROW(image.check(part.bodies.image(), now));
  copy.tumbling.become(image);
  copy.tumbling.audit(now);
  for (int i = 0; i < 40; ++i) {
    REQUIRE(copy.tumbling.next_time() == part.tumbling.next_time());
    const BodySlot slot = part.turn_on();
    REQUIRE(copy.turn_on() == slot);
    CHECK(copy.bodies.motion(slot) == part.bodies.motion(slot));
  }
  image.of[1].reset();
  CHECK_THROWS_WITH(image.check(part.bodies.image(), now), Contains("tumbling[1]: is of no body, or missing"));
}

TEST_CASE("Tumbling: a body that was left alone has the piece that it would have otherwise", "[turning]") {
  Spinning watched, part;
  const BodySlot slot = watched.add();
  part.add();
  const double until = 2;
  while (watched.tumbling.next_time() < until) watched.turn_on();
  REQUIRE(part.tumbling.next_time() < until);
  REQUIRE(part.tumbling.can_leave_alone(slot, until));
  part.tumbling.leave_alone(slot, until);
  CHECK(part.tumbling.is_alone(slot));
  CHECK(part.tumbling.next_time() == until);
  part.bodies.move(slot, part.tumbling.catch_up(slot, until));
  CHECK_FALSE(part.tumbling.any_alone());
  CHECK(part.bodies.motion(slot) == watched.bodies.motion(slot));
  CHECK(part.tumbling.next_time() == watched.tumbling.next_time());
  CHECK(part.counters.rotation_pieces == watched.counters.rotation_pieces);
  part.tumbling.audit(until);
}

TEST_CASE("Tumbling: points keep within what is told of all pieces to come", "[turning]") {
  double fullest = 0;
  for (const Vector3d& moments : {Vector3d(2, 1, 3), Vector3d(1, 1.9, 2.8), Vector3d(1, 1, 2), Vector3d(1, 1, 0.1)}) {
    for (const double error : {1e-3, 0.1}) {
      Spinning part{.options = {.orientation_error = error}};
      const BodySlot slot = part.add(moments);
      std::vector<LooselyTurning<1>> told;
      for (int piece = 0; piece < 60; ++piece) {
        const RigidMotion<1> motion = part.bodies.motion(slot);
        const double starts = motion.start(), ends = part.tumbling.next_time();
        for (const LooselyTurning<1>& loose : told) {
          const double t0 = loose.motion.start();
          if (starts > t0 + 1 / 3.0) continue;  // a radian
          for (int i = 0; i <= 4; ++i) {
            for (int d = 0; d < 3; ++d) {
              const double t = starts + 0.25 * i * (ends - starts), s = t - t0;
              const Vector3d x = Vector3d::Unit(d), from = loose.motion.position(x, t0).vector;
              const Vector3d straight = from + s * loose.motion.velocity(x, t0).vector;
              const double off = (motion.position(x, t).vector - straight).norm();
              const double most = loose.off + loose.rate_error * s + loose.bend * s * s / 2;
              REQUIRE(off <= most);
              fullest = std::max(fullest, off / most);
            }
          }
        }
        told.push_back(part.tumbling.loosely_turning(slot, ends));
        part.turn_on();
      }
    }
  }
  CHECK(fullest > 0.6);
}

TEST_CASE("Rest of bodies that turn: a ball comes to rest when it has been calm for eight flights", "[turning]") {
  Lying part;
  const BodySlot ball = part.add_ball(0);
  for (int flight = 0; flight < 8; ++flight) REQUIRE_FALSE(part.touch(ball, flight));
  CHECK(part.rest.empty());
  CHECK_FALSE(part.rest.progress(ball).is_none());
  REQUIRE(part.touch(ball, 8.5));
  CHECK(part.rest.holds(part.floor, ball));
  CHECK(part.rest.carries(ball));
  CHECK_FALSE(part.rest.carries(part.floor));
  CHECK(part.is_still(ball));
  CHECK(part.taken_up == std::vector{ball});
  CHECK(part.told == std::vector{std::tuple(true, part.floor, ball)});
  CHECK(part.rest.partners(ball) == std::vector{part.floor});
  CHECK(part.rest.next_time() == never);
  part.rest.audit(part.clock.now);

  part.rest.drop_all(part.floor);
  CHECK_FALSE(part.rest.solved());
  part.rest.solve();
  CHECK(part.rest.empty());
  CHECK(part.rest.progress(ball).is_none());
  CHECK(part.bodies.path(ball).coefficients[2] == Vector3d(0, 0, -Lying::gravity / 2));
  CHECK(part.told.back() == std::tuple(false, part.floor, ball));
}

TEST_CASE("Rest of bodies that turn: one that moves is not calm, and has to be calm anew", "[turning]") {
  Lying part;
  const BodySlot ball = part.add_ball(0);
  for (int flight = 0; flight < 8; ++flight) REQUIRE_FALSE(part.touch(ball, flight));
  auto fast = part.bodies.motion(ball);
  fast.path.coefficients[1][0] = 1;
  part.bodies.move(ball, fast);
  CHECK_FALSE(part.meet(ball, {.time = part.clock.now, .normal = {0, 0, 1}}));
  CHECK(part.rest.progress(ball).is_none());
  for (int flight = 9; flight < 17; ++flight) CHECK_FALSE(part.touch(ball, flight));
  CHECK(part.touch(ball, 17.5));
}

TEST_CASE("Rest of bodies that turn: who lies with a body, or strikes who does, shares its island", "[turning]") {
  using Slots = std::vector<BodySlot>;
  using Islands = std::vector<Slots>;
  Lying part;
  const Slots balls{part.add_ball(0), part.add_ball(2), part.add_ball(4), part.add_ball(6)};
  part.rest.shared().set_owned([&](BodySlot slot) { return slot == balls[0]; });
  part.rest.begin_shared();
  for (const BodySlot ball : balls) part.touch(ball, 0);
  part.meet_beside(balls[2], balls[3]);
  CHECK(part.rest.shared().take_shared().empty());  // of copies alone
  CHECK(part.rest.shared().take_concerned().empty());
  CHECK(part.rest.leans(balls[2]));
  CHECK_FALSE(part.rest.leans(balls[1]));

  part.meet_beside(balls[0], balls[1]);
  CHECK(part.rest.shared().take_shared() == Slots{balls[1]});
  CHECK(part.rest.shared().take_concerned() == Islands{Slots{balls[0], balls[1]}});
  CHECK(part.rest.island(balls[1]) == Slots{balls[0], balls[1]});

  part.rest.meet(balls[1], balls[2]);
  CHECK(part.rest.shared().take_shared() == Slots{balls[2], balls[3]});
  CHECK(part.rest.shared().take_concerned() == Islands{Slots{balls[0], balls[1]}, Slots{balls[2], balls[3]}});
  part.rest.begin_shared();
  CHECK(part.rest.shared().take_shared() == Slots{balls[1]});
  CHECK(part.rest.shared().take_concerned().empty());

  part.rest.take_touched();
  auto fast = part.bodies.motion(balls[3]);
  fast.path.coefficients[1][0] = 1;
  part.bodies.move(balls[3], fast);
  part.meet(balls[3], {.time = part.clock.now, .normal = {0, 0, 1}});
  CHECK_FALSE(part.rest.leans(balls[2]));
  const Slots touched = part.rest.take_touched();
  CHECK(std::find(touched.begin(), touched.end(), balls[2]) != touched.end());
  for (int flight = 1; flight <= 9 && !part.rest.carries(balls[0]); ++flight) {
    for (const BodySlot ball : {balls[1], balls[0]}) part.touch(ball, flight);
  }
  REQUIRE(part.rest.carries(balls[0]));
  const Slots stopped = part.rest.take_touched();
  for (const BodySlot ball : {balls[0], balls[1]}) {
    CHECK(std::find(stopped.begin(), stopped.end(), ball) != stopped.end());
  }
  part.rest.shared().take_concerned();
  part.rest.drop_all(balls[0]);
  part.rest.solve();
  CHECK(part.rest.shared().take_concerned().front() == Slots{balls[0], balls[1]});

  // Contacts that are remembered for a collapse link bodies for as long.
  CHECK(part.rest.divisible());
  part.rest.begin_shared();
  part.rest.note_blow({.a = balls[0], .b = balls[3], .point = {0, 0, 0}, .normal = {1, 0, 0}, .time = part.clock.now});
  CHECK(part.rest.shared().take_shared() == Slots{balls[3]});
  CHECK(part.rest.island(balls[0]) == Slots{balls[0], balls[3]});
  CHECK_FALSE(part.rest.divisible());
  part.clock.now += 1e-8;
  CHECK(part.rest.divisible());
  CHECK_FALSE(part.rest.leans(balls[0]));
}

TEST_CASE("Rest of bodies that turn: another world goes on with all that lies with each other", "[turning]") {
  Lying part, other;
  const std::vector balls{part.add_ball(0), part.add_ball(2)};
  for (const double x : {0.0, 2.0}) other.add_ball(x);
  for (int flight = 0; flight < 8; ++flight) {
    for (const BodySlot ball : balls) REQUIRE_FALSE(part.touch(ball, flight));
    part.meet_beside(balls[0], balls[1]);
  }
  const auto same_slot = [](BodySlot number) { return number; };
  const auto go_on = [&] {
    for (const BodySlot ball : balls) {
      other.bodies.move(ball, part.bodies.motion(ball));
      other.rest.go_on_from(ball, part.rest.progress(ball), same_slot);
    }
    CHECK_NOTHROW(other.rest.require_listed());
    for (const BodySlot ball : balls) CHECK(same_bits(other.rest.progress(ball), part.rest.progress(ball)));
  };
  go_on();
  for (const BodySlot ball : balls) other.rest.let_go(ball);
  CHECK(other.rest.progress(balls[0]).is_none());
  other.rest.go_on_from(balls[0], part.rest.progress(balls[0]), same_slot);
  CHECK_THROWS_AS(other.rest.require_listed(), std::runtime_error);
  other.rest.let_go(balls[0]);
  CHECK_THROWS_AS(other.rest.go_on_from(balls[0], part.rest.progress(balls[0]), [](BodySlot) { return no_body; }),
                  std::runtime_error);
  other.rest.let_go(balls[0]);

  for (const BodySlot ball : balls) part.touch(ball, 8.5);  // They come to rest.
  REQUIRE(part.rest.carries(balls[0]));
  other.clock = part.clock;
  go_on();
  CHECK(other.rest.holds(other.floor, balls[0]));
  other.rest.audit(other.clock.now);
  part.rest.set_aside();
  CHECK(part.rest.empty());
  CHECK_FALSE(part.rest.kept()[balls[0]].is_none());
  part.rest.go_on();
  CHECK(same_bits(other.rest.progress(balls[1]), part.rest.progress(balls[1])));
  part.rest.audit(part.clock.now);
}

TEST_CASE("Rest of bodies that turn: what decides later when a body rests is in its progress", "[turning]") {
  Lying part;
  const std::vector balls{part.add_ball(0), part.add_ball(2)};
  auto belt = part.bodies.motion(part.floor);
  belt.path.coefficients[1][0] = 0x1p-10;
  part.bodies.move(part.floor, belt);
  for (int flight = 0; flight <= 8; ++flight) {
    if (flight == 4) part.touch(balls[1], flight), part.meet_beside(balls[0], balls[1]);
    REQUIRE_FALSE(part.touch(balls[0], flight));
  }
  const auto progress = part.rest.progress(balls[0]);
  REQUIRE_FALSE(progress.is_none());
  CHECK(progress.state()->since == 0);
  CHECK(progress.state()->looked == part.clock.now);  // The other has not been calm for long enough.
  CHECK(progress.state()->carrier.velocity == Vector3d(0x1p-10, 0, 0));
  CHECK(progress.state()->links.size() == 2);
}

TEST_CASE("Rest of bodies that turn: what decides nothing any more is not in a progress", "[turning]") {
  Lying part, other;
  const std::vector balls{part.add_ball(0), part.add_ball(2)};
  for (const double x : {0.0, 2.0}) other.add_ball(x);
  const auto still = part.bodies.motion(part.floor);
  auto belt = still;
  belt.path.coefficients[1][0] = 0x1p-10;
  part.bodies.move(part.floor, belt);
  const auto goes_on = [&](BodySlot ball) {
    other.clock = part.clock;
    other.rest.go_on_from(ball, part.rest.progress(ball), [](BodySlot number) { return number; });
    const bool same = same_bits(other.rest.progress(ball), part.rest.progress(ball));
    other.rest.let_go(ball);
    return same;
  };
  for (int flight = 0; flight <= 8; ++flight) {
    if (flight == 4) part.touch(balls[1], flight), part.meet_beside(balls[0], balls[1]);
    part.touch(balls[0], flight);
  }
  REQUIRE(part.rest.progress(balls[0]).state()->looked == part.clock.now);
  auto fast = part.bodies.motion(balls[1]);
  fast.path.coefficients[1][1] = 1;
  part.bodies.move(balls[1], fast);
  part.meet(balls[1], {.time = part.clock.now, .normal = {0, 0, 1}});  // parts from the other
  CHECK(part.rest.progress(part.floor).is_none());
  CHECK(goes_on(balls[0]));

  fast = part.bodies.motion(balls[0]);
  fast.path.coefficients[1][1] = 1;
  part.bodies.move(balls[0], fast);
  part.meet(balls[0], {.time = part.clock.now, .normal = {0, 0, 1}});
  CHECK(part.rest.progress(balls[0]).is_none());
  part.bodies.move(part.floor, still);
  part.touch(balls[0], 9);  // It is calm anew.
  REQUIRE(part.rest.progress(balls[0]).state());
  CHECK(part.rest.progress(balls[0]).state()->looked == -never);
  for (int flight = 10; flight < 40 && !part.rest.carries(balls[0]); ++flight) part.touch(balls[0], flight);
  REQUIRE(part.rest.carries(balls[0]));
  const Vector3d impulse(0x1p-30, 0, 0);
  const auto mobility = [](BodySlot) { return Mobility::of_spherical(1, 1 / 0.4); };
  REQUIRE_FALSE(part.rest.strike(balls[0], -impulse, balls[1], impulse, impulse, mobility));
  CHECK(part.rest.progress(balls[0]).state()->ignored.velocity[0] != 0);
  CHECK(goes_on(balls[0]));
  CHECK(other.rest.empty());
  CHECK_FALSE(part.rest.leans(part.floor));
  part.rest.drop_all(part.floor);
  part.rest.solve();
  part.touch(balls[0], 50);
  REQUIRE(part.rest.progress(balls[0]).state());
  CHECK(part.rest.progress(balls[0]).state()->ignored.since == -never);
}

TEST_CASE("Rest of bodies that turn: how what carried a body moves is not in its progress", "[turning]") {
  Lying part;
  const std::vector balls{part.add_ball(0), part.add_ball(2)};
  auto belt = part.bodies.motion(part.floor);
  belt.path.coefficients[1][0] = 0x1p-10;
  part.bodies.move(part.floor, belt);
  part.touch(balls[1], 0);
  part.meet_beside(balls[0], balls[1]);
  REQUIRE(part.rest.progress(balls[0]).state()->carrier.velocity[0] != 0);
  part.rest.drop_all(balls[1]);
  REQUIRE(part.rest.progress(balls[0]).state());  // It is calm.
  CHECK(part.rest.progress(balls[0]).state()->carrier.velocity[0] == 0);
}

TEST_CASE("Rest of bodies that turn: who has lost others, or is looked at with them, has changed", "[turning]") {
  using Slots = std::vector<BodySlot>;
  Lying part;
  const Slots balls{part.add_ball(0), part.add_ball(2), part.add_ball(4)};
  part.rest.shared().set_owned([&](BodySlot slot) { return slot == balls[0]; });
  part.rest.begin_shared();
  const auto touched = [&](BodySlot slot) {
    const Slots all = part.rest.take_touched();
    return std::find(all.begin(), all.end(), slot) != all.end();
  };
  // A row that nothing holds: what is found of the last follows from a contact of the others.
  for (const int flight : {0, 1, 2, 3, 4, 5, 6, 7, 9}) {
    part.clock.now = flight * part.options.shortest_flight;
    for (const BodySlot ball : balls) {
      const double x = part.bodies.path(ball).coefficients[0][0];
      part.bodies.move(ball, Lying::at({x, 0, 1}, Lying::gravity, part.clock.now));
    }
    if (flight < 8) part.meet_beside(balls[1], balls[2]);
    part.rest.take_touched();
    part.meet_beside(balls[0], balls[1]);
  }
  CHECK(touched(balls[2]));
  REQUIRE(part.rest.progress(balls[2]).state());
  CHECK(part.rest.progress(balls[2]).state()->looked == part.clock.now);
  // One that does not rest, and goes, concerns those that it was about to lie with.
  part.rest.shared().take_concerned();
  part.rest.drop_all(balls[2]);
  CHECK(part.rest.shared().take_concerned() == std::vector<Slots>{balls});
  part.rest.begin_shared();
  CHECK(part.rest.take_touched().empty());
  for (const BodySlot ball : balls) part.rest.drop_all(ball);

  // A floor that goes concerns what rests on it.
  const double before = part.clock.now / part.options.shortest_flight;
  for (int flight = 1; flight <= 40 && !part.rest.carries(balls[0]); ++flight) {
    for (const BodySlot ball : {balls[0], balls[1]}) part.touch(ball, before + flight);
    part.meet_beside(balls[0], balls[1]);
  }
  REQUIRE(part.rest.carries(balls[0]));
  part.rest.begin_shared();
  part.rest.drop_all(part.floor);
  const auto concerned = part.rest.shared().take_concerned();
  REQUIRE_FALSE(concerned.empty());
  CHECK(concerned.front() == Slots{balls[0], balls[1]});
}

TEST_CASE("Rest of bodies that turn: all of a progress is compared, and sent as it is", "[turning]") {
  using State = TurningRestProgress::State;
  const detail::TouchedPlace place{{1, 2, 3}, {4, 5, 6}, {0, 0, 1}, 0.5};
  const detail::LyingPair pair{true, {place}, {0, 0, 1}, {1, 0, 0}};
  const State state{.links = {{7, pair}, {9, pair}},
                    .since = 0.25,
                    .looked = 0.5,
                    .rests = true,
                    .ignored = {0.125, {1, 0, 0}, {0, 1, 0}},
                    .carrier = {{1, 0, 0}, {0, 0, 1}, 0.5}};
  const std::vector<void (*)(State&)> changes{
      [](State& s) { s.links.pop_back(); },
      [](State& s) { s.links[1].other = 8; },
      [](State& s) { s.links[1].pair.rests = false; },
      [](State& s) { s.links[1].pair.normal[2] = -1; },
      [](State& s) { s.links[1].pair.point[1] = -0.0; },
      [](State& s) { s.links[1].pair.places.clear(); },
      [](State& s) { s.links[1].pair.places[0].on_a[0] = 0; },
      [](State& s) { s.links[1].pair.places[0].on_b[0] = 0; },
      [](State& s) { s.links[1].pair.places[0].normal[1] = -0.0; },
      [](State& s) { s.links[1].pair.places[0].time = 0.25; },
      [](State& s) { s.since = never; },
      [](State& s) { s.looked = -never; },
      [](State& s) { s.rests = false; },
      [](State& s) { s.ignored.since = 0; },
      [](State& s) { s.ignored.velocity[1] = -0.0; },
      [](State& s) { s.ignored.angular_velocity[0] = -0.0; },
      [](State& s) { s.carrier.velocity[1] = -0.0; },
      [](State& s) { s.carrier.half_acceleration[0] = -0.0; },
      [](State& s) { s.carrier.start = 0; },
  };
  const TurningRestProgress before(state);
  CHECK(same_bits(before, TurningRestProgress(state)));
  for (std::size_t i = 0; i < changes.size(); ++i) {
    INFO("change " << i);
    State changed = state;
    changes[i](changed);
    const TurningRestProgress after(changed);
    CHECK_FALSE(same_bits(before, after));
    CHECK(same_bits(after, through_bytes(after)));
  }
  CHECK_FALSE(same_bits(before, TurningRestProgress()));
  CHECK(same_bits(TurningRestProgress(), through_bytes(TurningRestProgress())));
}

TEST_CASE("Rest of bodies that turn: of two histories time, motion, turning and rest are compared", "[turning]") {
  Spinning part;
  const BodySlot slot = part.add();
  const MotionChange<Spinning::Motion> change{1, Spinning::motion(), 0.5, part.tumbling.progress(slot), {}};
  CHECK(same_bits(change, change));
  auto other = change;
  other.time = 0.25;
  CHECK_FALSE(same_bits(change, other));
  other = change, other.motion.angular_velocity[1] = -0.2;
  CHECK_FALSE(same_bits(change, other));
  other = change, other.turning = {};
  CHECK_FALSE(same_bits(change, other));
  other = change, other.resting = TurningRestProgress(TurningRestProgress::State{.since = 0.5});
  CHECK_FALSE(same_bits(change, other));
}

TEST_CASE("Rest of bodies that turn: what wakes together gets its motions by slot", "[turning]") {
  Lying part;
  const std::vector balls{part.add_ball(-3), part.add_ball(0), part.add_ball(3)};
  for (const BodySlot ball : {balls[2], balls[0], balls[1]}) {
    for (int flight = 0; flight <= 9; ++flight) part.touch(ball, flight);
    REQUIRE(part.rest.carries(ball));
  }
  part.taken_up.clear();
  part.rest.drop_all(part.floor);
  part.rest.solve();
  CHECK(part.taken_up == balls);
}

TEST_CASE("Rest of bodies that turn: a copy comes to rest when the first does", "[turning]") {
  Lying part, copy;
  const BodySlot ball = part.add_ball(0);
  copy.add_ball(0);
  for (int flight = 0; flight < 5; ++flight) part.touch(ball, flight);
  copy.clock = part.clock;
  copy.bodies.move(ball, part.bodies.motion(ball));
  const auto image = through_bytes(part.rest.image());
  CHECK_NOTHROW(image.check(part.bodies.image(), part.clock.now, {.response = Response::elastic}));
  copy.rest.become(image);
  for (Lying* each : {&part, &copy}) {
    for (int flight = 5; flight < 8; ++flight) REQUIRE_FALSE(each->touch(ball, flight));
    REQUIRE(each->touch(ball, 8.5));
    each->rest.audit(each->clock.now);
  }
  // And one of both at rest wakes alike.
  Lying third;
  third.add_ball(0);
  third.clock = part.clock;
  third.bodies.move(ball, part.bodies.motion(ball));
  third.rest.become(through_bytes(part.rest.image()));
  third.rest.audit(third.clock.now);
  CHECK(third.rest.holds(third.floor, ball));
  third.rest.drop_all(ball);
  CHECK(third.told.back() == std::tuple(false, third.floor, ball));
}

TEST_CASE("Rest of bodies that turn: the audit finds what rests and moves otherwise, or is not there", "[turning]") {
  Lying part;
  const BodySlot ball = part.add_ball(0);
  for (int flight = 0; flight <= 9; ++flight) part.touch(ball, flight);
  REQUIRE(part.rest.carries(ball));
  CHECK_NOTHROW(part.rest.audit(part.clock.now));
  const auto still = part.bodies.motion(ball);
  auto moves = still;
  moves.path.coefficients[1] = Vector3d(0, 1, 0);
  part.bodies.move(ball, moves);
  CHECK_THROWS_WITH(part.rest.audit(part.clock.now),
                    Contains("body 1: it rests, and does not move with what it rests on"));
  part.bodies.move(ball, still);
  CHECK_NOTHROW(part.rest.audit(part.clock.now));
  part.bodies[ball].entered = false;
  CHECK_THROWS_WITH(part.rest.audit(part.clock.now), Contains("body 1: it rests on another, and is not there"));
  part.bodies[ball].entered = true;

  auto image = part.rest.image();
  image.pairs.clear();
  CHECK_THROWS_WITH(image.check(part.bodies.image(), part.clock.now, {.response = Response::elastic}),
                    Contains("rests on nothing"));
  image = part.rest.image();
  image.carriers[ball].velocity[0] = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(image.check(part.bodies.image(), part.clock.now, {.response = Response::elastic}),
                    Contains("the motion of what carries it is not finite"));
}

}  // namespace kds::collision::test_turning_parts
