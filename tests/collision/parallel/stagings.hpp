// Random scenes of all that is divided: scripts, bodies that enter later, attached sensors, ignored pairs, timers; of
// bodies that keep their orientation and of bodies that turn.
#pragma once

#include "tests/collision/parallel/compared_runs.hpp"
#include "tests/support/random_numbers.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace kds::collision::tests {

using kds::tests::Random;

/// Makes scenes of one type of motion.
template <class Motion>
class StageMaker {
  using Vector = Eigen::Vector3d;

 public:
  explicit StageMaker(std::uint64_t seed) : random_(seed), seed_(seed) {
    coarse_ = random_.one_in(3), jumps_ = random_.one_in(4), walls_ = random_.one_in(2);
    bodies_ = 20 + random_.below(turns<Motion> ? 50 : 120);
    side_ = std::cbrt(static_cast<double>(bodies_)) * random_.between(1.5, 3.5);
    if (coarse_) side_ = std::ceil(side_);
    falls_ = Motion::degree == 2 && turns<Motion> && random_.one_in(3);
    end_time_ = random_.between(0.5, turns<Motion> ? 1.5 : 2.5);
  }

  Staging<Motion> scene() {
    WorldOptions options;
    options.response = random_.one_in(3) ? Response::none : Response::elastic;
    if (walls_) options.walls = Walls{Vector::Constant(-1), Vector::Constant(side_ + 1)};
    const std::array kinds{BroadPhaseKind::automatic, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap};
    options.broad_phase = kinds[random_.below(kinds.size())];
    const bool scripted = random_.one_in(2), attached = random_.one_in(2), ignored = random_.one_in(2);
    std::vector<BasicBodyDescription<Motion>> bodies;
    for (std::size_t i = 0; i < bodies_; ++i) bodies.push_back(body(scripted));
    if (falls_) bodies.push_back(floor());
    for (int large = !walls_ && random_.one_in(2) ? random_.integer(1, 3) : 0; large > 0; --large)
      bodies.push_back(paddle(scripted));
    if (attached) {
      for (BodyId owner = 0, owners = bodies.size(); owner < owners; ++owner) {
        if (random_.one_in(5)) bodies.push_back(sensor_of(owner));
      }
    }
    std::vector<std::pair<BodyId, BodyId>> pairs;
    for (std::size_t i = 0; ignored && i < 2 * bodies_; ++i) {
      const BodyId a = random_.below(bodies_), b = random_.below(bodies_);
      if (a != b) pairs.emplace_back(a, b);
    }
    const double timer = random_.one_in(3) ? random_.between(0, end_time_) : -1;
    const auto fill = [=](BasicWorld<Motion>& world) {
      for (const auto& description : bodies) world.add_body(description);
      for (const auto& [a, b] : pairs) world.ignore_pair(a, b);
      if (timer >= 0) world.set_timer(timer);
    };
    return {options, fill, end_time_,
            "seed " + std::to_string(seed_) + ", " + std::to_string(bodies.size()) + " bodies"};
  }

  /// How it may be run, in so many domains at most.
  Manner manner(std::size_t most_domains) { return random_manner(random_, most_domains); }

 private:
  double number(double low, double high) {
    if (!coarse_) return random_.between(low, high);
    return random_.integer(static_cast<int>(2 * low), static_cast<int>(2 * high)) * 0.5;
  }
  Vector vector(double low, double high) {
    const double x = number(low, high), y = number(low, high), z = number(low, high);
    return {x, y, z};
  }
  double size() { return coarse_ ? 0.25 * random_.integer(1, 2) : random_.between(0.2, 0.6); }

  Motion motion(const Vector& place, double start) {
    Motion result;
    certificates::PointMotion<Motion::degree> path;
    path.start = start;
    path.coefficients[0] = place, path.coefficients[1] = vector(-3, 3);
    if constexpr (Motion::degree >= 2) {
      path.coefficients[2] = random_.one_in(2) ? Vector(vector(-1, 1)) : Vector(Vector::Zero());
      if (falls_) path.coefficients[2] = Vector(0, 0, -5);
    }
    for (std::size_t i = 3; i <= Motion::degree && !random_.one_in(3); ++i) path.coefficients[i] = vector(-0.5, 0.5);
    if constexpr (turns<Motion>) {
      result.path = path;
      if (random_.one_in(2))
        result.orientation.coeffs() = Eigen::Vector4d(1, number(-1, 1), number(-1, 1), 1).normalized();
      result.angular_velocity = vector(-4, 4);
    } else {
      result = path;
    }
    return result;
  }
  static auto& path_in(Motion& motion) {
    if constexpr (turns<Motion>) {
      return motion.path;
    } else {
      return motion;
    }
  }

  Shape shape() {
    if (random_.one_in(2)) return Sphere{size()};
    if (random_.one_in(2)) return Box{{size(), size(), size()}};
    return Capsule{size(), 0.25};
  }

  BasicBodyDescription<Motion> body(bool scripted) {
    BasicBodyDescription<Motion> body;
    body.shape = shape();
    double start = scripted && random_.one_in(4) ? number(0, 1) + 0.25 : 0;  // Some enter later.
    body.motion = {motion(vector(0, side_), start)};
    if (random_.one_in(4)) body.mass = random_.between(0.2, 5);
    body.fixed = random_.one_in(10);
    // Fixed bodies that move would press others against walls and make them faster without end.
    if (body.fixed && (walls_ || !random_.one_in(3))) stand(body.motion[0]);
    body.sensor = random_.one_in(12);
    if (random_.one_in(10)) body.restitution = random_.between(0.5, 1);
    if constexpr (turns<Motion>) {
      if (random_.one_in(2)) body.friction = random_.between(0, 1);
      if (random_.one_in(2)) body.tangential_restitution = random_.between(-1, 1);
      if (random_.one_in(3)) body.inertia = random_.between(0.1, 1);  // of all axes: it does not precess
      if (falls_) body.restitution = random_.between(0.3, 0.9);
    }
    if (scripted && !(body.fixed && walls_) && random_.one_in(4)) add_script(body, start);
    return body;
  }

  /// Some pieces go on where the last one ended, up to rounding, and some jump.
  void add_script(BasicBodyDescription<Motion>& body, double start) {
    for (int pieces = random_.integer(1, 4); pieces > 0; --pieces) {
      start += coarse_ ? 0.25 * random_.integer(1, 3) : random_.between(0.1, 0.8);
      const bool jumps = jumps_ && random_.one_in(4);
      Motion next = motion(vector(0, side_), start);
      if (!jumps) {
        path_in(next).coefficients[0] = path_of(body.motion.back()).position(start);
        if constexpr (turns<Motion>) next.orientation = body.motion.back().restarted(start).orientation;
      }
      if (random_.one_in(3)) stand(next);
      body.motion.push_back(next);
    }
  }

  void stand(Motion& motion) {
    for (std::size_t i = 1; i <= Motion::degree; ++i) path_in(motion).coefficients[i].setZero();
  }

  /// A large body that others do not move.
  BasicBodyDescription<Motion> paddle(bool scripted) {
    BasicBodyDescription<Motion> paddle;
    if (random_.one_in(2)) {
      paddle.shape = Sphere{1 + size()};
    } else {
      paddle.shape = Box{{2, 1 + size(), 0.25}};
    }
    paddle.motion = {motion(vector(0, side_), 0)};
    paddle.fixed = true;
    if (scripted) add_script(paddle, 0);
    return paddle;
  }

  BasicBodyDescription<Motion> sensor_of(BodyId owner) {
    BasicBodyDescription<Motion> sensor;
    sensor.shape = Sphere{size() + 0.25};
    sensor.sensor = true;
    sensor.attached_to = owner;
    return sensor;
  }

  BasicBodyDescription<Motion> floor() {
    BasicBodyDescription<Motion> floor;
    floor.shape = Box{{4 * side_, 4 * side_, 1}};
    Motion place = motion(Vector(0, 0, -2), 0);
    stand(place);
    if constexpr (turns<Motion>) place.angular_velocity.setZero(), place.orientation.setIdentity();
    floor.motion = {place};
    floor.fixed = true;
    return floor;
  }

  Random random_;
  std::uint64_t seed_;
  bool coarse_ = false, falls_ = false, jumps_ = false, walls_ = false;
  std::size_t bodies_ = 0;
  double side_ = 0, end_time_ = 1;
};

/// Scenes of some seeds, each run in one manner; throws what compare_runs() throws. More by hand: KDS_DOMAIN_SEEDS.
template <class Motion>
void compare_stagings(std::initializer_list<Seeds> seeds, Seen& seen) {
  compare_seeds<StageMaker<Motion>>("KDS_DOMAIN_SEEDS", seeds, seen);
}

}  // namespace kds::collision::tests
