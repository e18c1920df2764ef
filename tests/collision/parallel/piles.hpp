// Random scenes of bodies that lean on each other: piles, rows, towers, cradles, on all that carries them.
#pragma once

#include "tests/collision/parallel/compared_runs.hpp"
#include "tests/collision/random_scenes.hpp"
#include "tests/support/random_numbers.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

namespace kds::collision::tests {

/// Makes scenes in which bodies come to lean on each other, here and there, and are struck.
template <int Degree>
class PileMaker {
  using Vector = Eigen::Vector3d;
  using Path = certificates::PointMotion<Degree>;
  using Description = BodyDescription<Degree>;

 public:
  explicit PileMaker(std::uint64_t seed) : random_(seed), seed_(seed) {
    coarse_ = random_.one_in(3);
    width_ = coarse_ ? 16 : random_.between(8, 30);
    radius_ = coarse_ ? 0.5 : random_.between(0.3, 0.6);
    rebound_ = random_.one_in(3) ? 0 : random_.one_in(2) ? 0.5 : random_.between(0, 0.9);
    tilted_ = random_.one_in(5);
    if constexpr (Degree >= 3) curved_ = random_.one_in(2);
    end_time_ = random_.between(0.3, 2);
  }

  Staging<Path> scene() {
    WorldOptions options;
    options.response = Response::elastic;
    const bool on_wall = random_.one_in(4);
    if (on_wall || random_.one_in(3)) {
      options.walls = Walls{Vector(-2, -2, on_wall ? 0 : -6), Vector(width_ + 2, 6, 14), random_.one_in(2) ? 1 : 0.5};
    }
    const std::array kinds{BroadPhaseKind::automatic, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap};
    options.broad_phase = kinds[random_.below(kinds.size())];
    if constexpr (Degree >= 3) {
      if (random_.one_in(3)) options.window = random_.between(0.1, 1);
    }
    if (!on_wall) add_ground();
    for (int groups = random_.integer(2, 7); groups > 0; --groups) add_group();
    for (int single = random_.integer(0, 12); single > 0; --single) {  // They strike the others.
      const Vector place(number(0, width_), number(0, 4), number(2, 6));
      add(place, Vector(number(-4, 4), number(-4, 4), number(-4, 0)));
    }
    if (random_.one_in(5)) add_lift();
    return stage(random_, seed_, options, bodies_, 2 * radius_, end_time_);
  }

  /// How it may be run, in so many domains at most.
  Manner manner(std::size_t most_domains) {
    Manner manner = random_manner(random_, most_domains);
    if (random_.one_in(2)) manner.parallel.halo = random_.between(1, 6);
    return manner;
  }

 private:
  double number(double low, double high) {
    if (!coarse_) return random_.between(low, high);
    return random_.integer(static_cast<int>(2 * low), static_cast<int>(2 * high)) * 0.5;
  }

  void add(const Vector& place, const Vector& velocity = Vector(0, 0, Degree == 1 ? -1 : 0)) {
    Description body;
    const double size = !coarse_ && random_.one_in(6) ? 0.6 * radius_ : radius_;
    body.shape = Sphere{size};
    if (random_.one_in(4)) body.shape = Box{Vector::Constant(size)};
    body.motion = {motion<Degree>(place, velocity, Vector(0, 0, -5))};
    for (std::size_t i = 3; i <= Degree && curved_; ++i) {
      const double x = number(-1, 1), z = number(-1, 2);
      body.motion[0].coefficients[i] = Vector(x, 0, z);
    }
    body.restitution = random_.one_in(8) ? 1 : rebound_;
    if (random_.one_in(6)) body.mass = random_.between(0.2, 5);
    if (random_.one_in(40)) {  // It is given another motion on the way, or is somewhere else at once.
      const double t = number(0, end_time_) + 0.1;
      const Vector to = random_.one_in(2) ? body.motion[0].position(t) : Vector(number(0, width_), number(0, 4), 5);
      body.motion.push_back(motion<Degree>(to, Vector(number(-2, 2), number(-2, 2), 0), Vector(0, 0, -5), t));
    }
    bodies_.push_back(body);
  }

  /// A row, a tower, a pyramid, or a heap that falls together.
  void add_group() {
    const double d = 2 * radius_, gap = coarse_ || random_.one_in(2) ? 0 : random_.between(0, 0.2 * d);
    const Vector foot(number(0, width_), number(0, 4), radius_ + (random_.one_in(2) ? 0 : number(0, 1)));
    switch (random_.below(4)) {
      case 0: {
        const Vector along = random_.one_in(2) ? Vector(d + gap, 0, 0) : Vector(0, d + gap, 0);
        for (int i = random_.integer(2, 6); i > 0; --i) add(foot + i * along);
        return;
      }
      case 1:
        for (int i = random_.integer(2, 4); i > 0; --i) add(foot + Vector(gap, 0, (i - 1) * (d + gap)));
        return;
      case 2:
        for (const double x : {0.0, 1.0, 2.0}) add(foot + Vector(x * (d + gap), 0, 0));
        for (const double x : {0.5, 1.5}) add(foot + Vector(x * (d + gap), 0, d));
        return;
      default:
        for (int i = random_.integer(3, 9); i > 0; --i) {
          add(foot + Vector(number(-1, 1), number(-1, 1), i * (d + gap)));
        }
    }
  }

  /// A box, a trough of two slopes, a dome, a mesh, or steps.
  void add_ground() {
    const Vector middle(0.5 * width_, 2, 0);
    Description ground;
    ground.fixed = true;
    ground.restitution = random_.one_in(3) ? 1 : 0.5;
    const auto put = [&](const Shape& shape, const Vector& centre) {
      ground.shape = shape;
      ground.motion = {motion<Degree>(centre)};
      bodies_.push_back(ground);
    };
    switch (random_.below(5)) {
      case 0:
        if (tilted_) ground.orientation = unit_quaternion(1, 0.05, random_.between(-0.1, 0.1), 0);
        return put(Box{{width_, 8, 1}}, middle - Vector(0, 0, 1));
      case 1:
        for (const double side : {-1.0, 1.0}) {
          ground.orientation = unit_quaternion(1, side * 0.2, 0, 0);
          put(Box{{width_, 6, 1}}, middle + Vector(0, side * 6, 0));
        }
        return;
      case 2:
        return put(Sphere{4 * width_}, middle - Vector(0, 0, 4 * width_));
      case 3:
        return put(MeshShape{cube(), width_}, middle - Vector(0, 0, width_));
      default:
        put(Box{{width_, 8, 1}}, middle - Vector(width_, 0, 1));
        put(Box{{width_, 8, 1}}, middle + Vector(width_, 0, -1.5));
    }
  }

  /// A large box that goes up and down, or across.
  void add_lift() {
    Description lift;
    lift.fixed = true;
    lift.shape = Box{{0.3 * width_, 3, 0.25}};
    lift.motion = {motion<Degree>(Vector(0.5 * width_, 2, 0.25))};
    double start = 0;
    for (int pieces = random_.integer(1, 3); pieces > 0; --pieces) {
      start += number(0.5, 1);
      const Vector velocity(random_.one_in(2) ? number(-1, 1) : 0, 0, number(0, 0.5));
      lift.motion.push_back(motion<Degree>(lift.motion.back().position(start), velocity, Vector::Zero(), start));
    }
    bodies_.push_back(lift);
  }

  Random random_;
  std::uint64_t seed_;
  bool coarse_ = false, tilted_ = false;
  bool curved_ = false;  ///< forces change with time
  double width_ = 16, radius_ = 0.5, rebound_ = 0.5, end_time_ = 1;
  std::vector<Description> bodies_;
};

/// Scenes of some seeds, each run in one manner; throws what compare_runs() throws. More by hand: KDS_PILE_SEEDS.
template <int Degree>
void compare_piles(std::initializer_list<Seeds> seeds, Seen& seen) {
  compare_seeds<PileMaker<Degree>>("KDS_PILE_SEEDS", seeds, seen);
}

}  // namespace kds::collision::tests
