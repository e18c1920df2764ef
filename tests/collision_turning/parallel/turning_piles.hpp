// Random scenes of bodies that turn, fall, strike each other and come to rest: on floors, in stacks and in heaps.
#pragma once

#include "collision/shapes/convex_hull.hpp"
#include "tests/collision/parallel/compared_runs.hpp"
#include "tests/collision_turning/rest_scenes.hpp"
#include "tests/support/random_numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace kds::collision::tests {

/// Makes scenes in which bodies come to rest, here and there, and are struck.
class TurningPileMaker {
  using Vector = Eigen::Vector3d;
  using Motion = certificates::RigidMotion<2>;
  using Description = BasicBodyDescription<Motion>;

 public:
  explicit TurningPileMaker(std::uint64_t seed) : random_(seed), seed_(seed) {
    coarse_ = random_.one_in(3);
    width_ = coarse_ ? 16 : random_.between(10, 24);
    rebound_ = random_.one_in(3) ? 0 : random_.between(0, 0.6);
    friction_ = random_.one_in(5) ? 0 : random_.between(0.2, 1);
    end_time_ = random_.between(0.3, 0.9);
  }

  Staging<Motion> scene() {
    WorldOptions options;
    options.response = Response::elastic;
    options.shortest_flight = std::array{0.01, 0.02, 0.03}[random_.below(3)];
    if (random_.one_in(3)) options.walls = Walls{Vector(-3, -3, -8), Vector(width_ + 3, 7, 14), 0.5};
    const std::array kinds{BroadPhaseKind::automatic, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap};
    options.broad_phase = kinds[random_.below(kinds.size())];
    add_ground();
    for (int groups = random_.integer(5, 9); groups > 0; --groups) add_group();
    for (int single = random_.integer(0, 4); single > 0; --single) {  // They strike the others.
      const Vector place(number(0, width_), number(0, 4), number(1, 3));
      const double x = number(-3, 3), y = number(-3, 3), z = number(-3, 0);
      add(place, Vector(x, y, z));
    }
    const int more = random_.integer(0, 7);
    if (more < 2) add_lift(0.3 * width_);
    if (more == 2) add_lift(0.5);
    return stage(random_, seed_, options, bodies_, 1, end_time_);
  }

  /// How it may be run, in so many domains at most.
  Manner manner(std::size_t most_domains) {
    Manner manner = random_manner(random_, most_domains);
    manner.parallel.halo = random_.between(1.5, 4);
    return manner;
  }

 private:
  double number(double low, double high) {
    if (!coarse_) return random_.between(low, high);
    return random_.integer(static_cast<int>(2 * low), static_cast<int>(2 * high)) * 0.5;
  }

  Shape shape(double size) {
    const Vector half(size, size, size);
    switch (random_.below(coarse_ ? 4 : 6)) {
      case 0:
        return Sphere{size};
      case 1:
        return Box{Vector(0.4 * size, 0.4 * size, size)};
      case 2:
        return Capsule{0.5 * size, 0.5 * size};
      case 3: {
        std::vector<Vector> points;
        for (const double z : {-0.5, 0.5}) {
          for (const double x : {-1.0, 1.0}) {
            points.emplace_back(x * size, 0, z * size);
            for (const double y : {-0.75, 0.75}) points.emplace_back(0.5 * x * size, y * size, z * size);
          }
        }
        return convex_hull(points);
      }
      default:
        return Box{half};
    }
  }

  void add(const Vector& place, const Vector& velocity = Vector::Zero(), bool alike = false) {
    const double size = 0.5;
    const bool turned = !coarse_ && !alike && random_.one_in(2);
    Description body = kds::tests::rest::body(alike ? Shape(Box{Vector(size, size, size)}) : shape(size), place);
    body.motion[0].path.coefficients[1] = velocity;
    if (turned) {
      const double x = random_.between(-1, 1), y = random_.between(-1, 1), z = random_.between(-1, 1);
      body.motion[0].orientation = Eigen::Quaterniond(1, x, y, z).normalized();
      body.motion[0].angular_velocity = Vector(y, z, x);
    }
    body.restitution = random_.one_in(10) ? 1 : rebound_;
    body.friction = friction_, body.rolling_friction = random_.one_in(2) ? 0.1 : 0;
    if (random_.one_in(6)) body.mass = random_.between(0.2, 5);
    if (random_.one_in(4)) body.inertia = 0.2;
    if (random_.one_in(30)) {  // It is given another motion on the way, or is somewhere else at once.
      const double t = number(0, end_time_) + 0.1;
      Motion to = body.motion[0].restarted(t);
      if (random_.one_in(2)) to.path.coefficients[0] = Vector(number(0, width_), 2, 4);
      to.path.coefficients[1] = Vector(1, 0, 0);
      body.motion.push_back(to);
    }
    bodies_.push_back(body);
  }

  /// A row, a stack, or a heap that falls together.
  void add_group() {
    const double gap = coarse_ ? 0 : random_.between(0, 0.05);
    const double x = number(0, width_), y = number(0, 4);
    const Vector foot(x, y, 0.5 + (random_.one_in(2) ? 0 : number(0, 1)));
    switch (random_.below(5)) {
      case 0:
      case 4:
        for (int i = random_.integer(2, 4); i > 0; --i) add(foot + Vector(i * (1 + gap), 0, 0), Vector::Zero(), true);
        return;
      case 1:
        for (int i = random_.integer(2, 3); i > 0; --i)
          add(foot + Vector(gap, 0, (i - 1) * (1 + gap)), Vector::Zero(), true);
        return;
      case 2:
        for (const double a : {0.0, 1.0}) add(foot + Vector(a * (1 + gap), 0, 0), Vector::Zero(), true);
        return add(foot + Vector(0.5, 0, 1 + gap), Vector::Zero(), true);
      default:
        for (int i = random_.integer(2, 5); i > 0; --i) {
          const double dx = number(-0.5, 0.5), dy = number(-0.5, 0.5);
          add(foot + Vector(dx, dy, 1.75 * i));
        }
    }
  }

  void add_ground() {
    const Vector middle(0.5 * width_, 2, 0);
    const auto put = [&](const Shape& shape, const Vector& centre, double tilt = 0) {
      Description ground = kds::tests::rest::fixed(shape, centre, kds::tests::rest::tilted(tilt, {1, 0, 0}));
      ground.restitution = random_.one_in(3) ? 1 : 0.5, ground.friction = friction_, ground.rolling_friction = 0.1;
      bodies_.push_back(ground);
    };
    switch (random_.below(4)) {
      case 0:
        return put(HalfSpace{{0, 0, 1}}, Vector::Zero());
      case 1:
        return put(Box{{width_, 8, 1}}, middle - Vector(0, 0, 1), coarse_ ? 0 : random_.between(-0.1, 0.1));
      case 2:
        for (const double side : {-1.0, 1.0}) put(Box{{width_, 6, 1}}, middle + Vector(0, side * 6, 0), -side * 0.2);
        return;
      default:
        put(Box{{width_, 8, 1}}, middle - Vector(width_, 0, 1));
        put(Box{{width_, 8, 1}}, middle + Vector(width_, 0, -1.5));
    }
  }

  /// A box of some size that goes up and down, or across.
  void add_lift(double half) {
    Description lift = kds::tests::rest::fixed(Box{{half, 2, 0.25}}, {0.5 * width_, 2, 0.25});
    lift.friction = 0.5;
    double start = 0;
    for (int pieces = random_.integer(1, 3); pieces > 0; --pieces) {
      start += coarse_ ? 0.25 : random_.between(0.1, 0.5);
      Motion next = lift.motion.back().restarted(start);
      const double x = random_.one_in(2) ? number(-1, 1) : 0, z = number(0, 0.5);
      next.path.coefficients[1] = Vector(x, 0, z);
      lift.motion.push_back(next);
    }
    bodies_.push_back(lift);
  }

  Random random_;
  std::uint64_t seed_;
  bool coarse_ = false;
  double width_ = 16, rebound_ = 0.5, friction_ = 0.5, end_time_ = 1;
  std::vector<Description> bodies_;
};

/// Rows of crates that are pushed together across x = 0, with one on top, come to rest and are struck at one end, each
/// a little later than the one before; crates far away hold the middle of the scene there.
inline void add_struck_crates(TurningWorld<2>& world) {
  using Vector = Eigen::Vector3d;
  namespace rest = kds::tests::rest;
  world.add_body(rest::fixed(Box{{60, 60, 1}}, {0, 0, -1}));
  const auto add = [&](const Vector& place, const Vector& velocity, double restitution) {
    auto crate = rest::body(Box{{0.5, 0.5, 0.5}}, place);
    crate.motion[0].path.coefficients[1] = velocity;
    crate.restitution = restitution, crate.inertia = 0.2;
    world.add_body(crate);
  };
  for (int j = 0; j < 4; ++j) {
    const double y = 3.0 * j, middle = 0.37 * (j - 1.5), side = j % 2 == 0 ? 1 : -1;
    for (int k = -1; k <= 2; ++k) add({middle + 1.002 * (k - 0.5), y, 0.5}, {-0.02 * (k - 0.5), 0, 0}, 0.2);
    if (j % 2 == 1) add({middle, y, 1.501}, {0, 0, 0}, 0.2);
    add({middle + side * (3.5 + 0.5 * j), y + 0.1 * j, 0.75}, {side * -4.0, 0, 1}, 0.5);
  }
  for (const double x : {-12.0, -9.0, 9.0, 12.0}) {
    for (int j = 0; j < 3; ++j) add({x, 4.0 * j, 0.5}, {0, 0, 0}, 0.2);
  }
}

/// Makes scenes of rows of crates that are pushed together, some with others on top, across places at which borders may
/// be, and that are struck at their ends when they have come to rest, or before.
class TurningRowMaker {
  using Vector = Eigen::Vector3d;
  using Motion = certificates::RigidMotion<2>;

 public:
  explicit TurningRowMaker(std::uint64_t seed) : random_(seed), seed_(seed) {
    coarse_ = random_.one_in(4);
    rebound_ = random_.one_in(3) ? 0 : random_.between(0, 0.5);
    friction_ = random_.between(0.2, 0.8);
    end_time_ = random_.between(0.3, 0.6);
  }

  Staging<Motion> scene() {
    WorldOptions options = with_response(Response::elastic);
    options.shortest_flight = std::array{0.015, 0.03}[random_.below(2)];
    auto floor = kds::tests::rest::fixed(Box{{60, 60, 1}}, {0, 0, -1});
    floor.friction = friction_;
    if (random_.one_in(4)) {  // It begins to move, and stops.
      for (const double speed : {0.5, 0.0}) {
        Motion next = floor.motion.back().restarted(floor.motion.back().path.start + random_.between(0.2, 0.5));
        next.path.coefficients[1] = Vector(speed, 0, 0);
        floor.motion.push_back(next);
      }
    }
    bodies_.push_back(floor);
    for (int rows = random_.integer(2, 4), j = 0; j < rows; ++j) add_row(2.5 * j);
    for (int more = random_.integer(0, 4); more > 0; --more) {
      const double x = random_.between(-14, 14), y = random_.between(-3, 14);
      add({x, y, 0.5}, Vector::Zero());
    }
    return stage(random_, seed_, options, bodies_, 1, end_time_);
  }

  /// How it may be run, in so many domains at most.
  Manner manner(std::size_t most_domains) {
    Manner manner = random_manner(random_, most_domains);
    manner.parallel.halo = random_.between(1, 3.5);
    return manner;
  }

 private:
  void add(const Vector& place, const Vector& velocity) {
    auto crate = kds::tests::rest::body(Box{{0.5, 0.5, 0.5}}, place);
    if (random_.one_in(8)) crate.shape = Sphere{0.5};
    crate.motion[0].path.coefficients[1] = velocity;
    crate.restitution = rebound_, crate.friction = friction_, crate.rolling_friction = 0.1;
    if (random_.one_in(2)) crate.inertia = 0.2;
    if (random_.one_in(6)) crate.mass = random_.between(0.2, 5);
    bodies_.push_back(crate);
  }

  void add_row(double y) {
    const double gap = coarse_ ? 0 : 0.002, middle = coarse_ ? 0.5 * random_.integer(-4, 4) : random_.between(-4, 4);
    const int crates = random_.integer(2, 5);
    const auto place = [&](double k) { return middle + (1 + gap) * (k - 0.5 * (crates - 1)); };
    for (int k = 0; k < crates; ++k) add({place(k), y, 0.5}, {-0.02 * (k - 0.5 * (crates - 1)), 0, 0});
    if (random_.one_in(3)) add({place(random_.integer(0, crates - 2) + 0.5), y, 1.5 + gap / 2}, Vector::Zero());
    for (int stones = random_.integer(0, 2); stones > 0; --stones) {
      const double side = random_.one_in(2) ? 1 : -1, far = random_.between(1.25, 4), speed = random_.between(1, 6);
      const double off = coarse_ ? 0 : random_.between(-0.4, 0.4), up = random_.between(0, 2);
      add({middle + side * (0.5 * crates + far), y + off, 0.6}, {-side * speed, 0, up});
    }
  }

  Random random_;
  std::uint64_t seed_;
  bool coarse_ = false;
  double rebound_ = 0, friction_ = 0.5, end_time_ = 1;
  std::vector<BasicBodyDescription<Motion>> bodies_;
};

/// What a listener does at the k-th event: a body comes, goes, jumps, or is struck; what it lies on moves; or
/// properties change.
inline void change_turning_pile(TurningWorld<2>& world, const Event& event, std::uint64_t seed, std::size_t k,
                                std::size_t bodies) {
  using Vector = Eigen::Vector3d;
  Random random(seed * 100003 + k);
  const double t = world.now();
  const int what = random.integer(0, 9);
  const BodyId id = random.one_in(3) ? random.below(bodies + 3) : event.a;
  const double x = random.between(-1, 1), y = random.between(-1, 1), z = random.between(-1, 1);
  if (what == 0) world.set_timer(t + random.between(0, 0.3));
  if (!world.contains(id) || world.attached_to(id)) return;
  const bool fixed = world.fixed(id);
  auto motion = fixed ? world.motion(id) : world.free_motion(id);
  motion = motion.restarted(std::max(t, motion.path.start));
  if (what == 1) {
    const Vector above = motion.path.coefficients[0] + Vector(0, 0, 1.25);
    auto added = kds::tests::rest::body(Box{Vector(0.25, 0.5, 0.25)}, above, Eigen::Quaterniond::Identity(), {x, y, z});
    added.motion[0].path.start = t;
    world.add_body(added);
  }
  if (what <= 3 && what >= 2 && (!fixed || random.one_in(4))) return world.remove_body(id);
  if (what == 4) return world.set_restitution(id, 0.5 * random.integer(0, 2));
  if (what == 5) return world.set_filter(id, 1, random.one_in(2) ? 2 : 3);
  if (what == 6 && event.kind == Kind::contact && event.a != event.b && world.contains(event.a) &&
      world.contains(event.b))
    return world.ignore_pair(event.a, event.b);
  if (what < 7) return;
  motion.path.coefficients[1] += fixed ? Vector(0, 0, 0.25) : Vector(2 * x, 2 * y, 2 * z);
  if (!fixed && what == 9) motion.path.coefficients[0] += Vector(x, y, 1 + z);
  world.update_motion(id, motion);
}

}  // namespace kds::collision::tests
