// Random scenes of what rests on fixed bodies and walls: tables, steps, lifts, slopes, domes.
#pragma once

#include "tests/collision/parallel/compared_runs.hpp"
#include "tests/collision/random_scenes.hpp"
#include "tests/support/random_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

namespace kds::collision::tests {

/// By what else than forces bodies of a TableMaker move.
struct TableMotions {
  bool curved = false;         ///< terms of degree 3 and above, where there are any
  bool moving_ground = false;  ///< the ground has a velocity, and curves if bodies do
};

/// Makes scenes in which bodies fall on a ground, slide over it, and strike each other.
template <int Degree>
class TableMaker {
  using Vector = Eigen::Vector3d;
  using Path = certificates::PointMotion<Degree>;

 public:
  explicit TableMaker(std::uint64_t seed, const TableMotions& motions = {})
      : random_(seed), motions_(motions), seed_(seed) {
    coarse_ = random_.one_in(3);
    row_ = 4 + random_.below(7);
    spacing_ = coarse_ ? 2 : random_.between(1.5, 4);
    radius_ = coarse_ ? 0.5 : random_.between(0.3, 0.6);
    mixed_ = random_.one_in(4);
    rebound_ = random_.one_in(3) ? 1 : coarse_ ? 0.5 : random_.between(0.3, 1);
    sideways_ = random_.one_in(6);
    end_time_ = random_.between(0.5, 2.5);
  }

  Staging<Path> scene() {
    WorldOptions options;
    options.response = random_.one_in(8) ? Response::none : Response::elastic;
    const double side = spacing_ * static_cast<double>(row_ - 1);
    const bool on_wall = random_.one_in(3);
    if (on_wall || random_.one_in(2)) {
      options.walls =
          Walls{Vector(-2, -2, on_wall ? 0 : -4), Vector(side + 2, side + 2, 12), random_.one_in(2) ? 1 : 0.5};
    }
    const std::array kinds{BroadPhaseKind::automatic, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap};
    options.broad_phase = kinds[random_.below(kinds.size())];
    std::vector<BodyDescription<Degree>> bodies;
    if (!on_wall) add_ground(bodies, side);
    const bool lifted = random_.one_in(6);
    if (lifted) add_lift(bodies, side);
    for (std::size_t i = 0; i < row_ * row_; ++i) {
      const double x = spacing_ * static_cast<double>(i % row_), y = spacing_ * static_cast<double>(i / row_);
      bodies.push_back(body(Vector(x, y, lifted ? 1.5 : 0)));
    }
    for (int obstacles = random_.integer(0, 3); obstacles > 0; --obstacles) add_obstacle(bodies, side);
    const std::size_t owners = bodies.size();
    for (BodyId owner = 0; owner < owners; ++owner) {
      if (!random_.one_in(20)) continue;
      BodyDescription<Degree> sensor{.shape = Sphere{2 * radius_}, .sensor = true};
      sensor.attached_to = owner;
      bodies.push_back(sensor);
    }
    const double timer = random_.one_in(3) ? random_.between(0, end_time_) : -1;
    const auto fill = [=](World<Degree>& world) {
      for (const auto& description : bodies) world.add_body(description);
      if (timer >= 0) world.set_timer(timer);
    };
    return {options, fill, end_time_,
            "seed " + std::to_string(seed_) + ", " + std::to_string(bodies.size()) + " bodies"};
  }

  /// How it may be run, in so many domains at most.
  Manner manner(std::size_t most_domains) { return random_manner(random_, most_domains); }

 private:
  void add_terms(Path& path, double size) {
    for (int k = 3; k <= Degree && motions_.curved; ++k) {
      for (int d = 0; d < 3; ++d) {
        const double term = random_.one_in(3) ? 0 : number(-1, 1) * size / (k * (k - 1));
        path.coefficients[static_cast<std::size_t>(k)][d] = term;
      }
    }
  }

  double number(double low, double high) {
    if (!coarse_) return random_.between(low, high);
    return random_.integer(static_cast<int>(2 * low), static_cast<int>(2 * high)) * 0.5;
  }

  /// A body over a place on the ground, or on it.
  BodyDescription<Degree> body(const Vector& place) {
    BodyDescription<Degree> body;
    double size = mixed_ && random_.one_in(2) ? 0.5 * radius_ : radius_;
    Vector half = Vector::Constant(size);
    if (random_.one_in(5)) {
      body.shape = Box{half};
      body.fixed = random_.one_in(8);
    } else {
      body.shape = Sphere{size};
    }
    const double height = random_.one_in(2) ? 0 : number(0.5, 2);
    const Vector velocity(number(-4, 4), number(-4, 4), Degree == 1 ? -1 : 0);
    Vector force(0, 0, -5);
    if (sideways_) force.x() = number(-2, 2);
    body.motion = {motion<Degree>(place + Vector(0, 0, size + height), velocity, force)};
    if (body.fixed) body.motion[0] = motion<Degree>(place + Vector(0, 0, size));
    if (!body.fixed) add_terms(body.motion[0], 3);
    body.restitution = random_.one_in(12) ? 0 : rebound_;
    if (random_.one_in(6)) body.mass = random_.between(0.2, 5);
    return body;
  }

  /// Boxes whose tops are at heights of 0 and below, side by side, or one; or cubes that are meshes; or slopes; or
  /// domes, down which bodies slide in clusters.
  void add_ground(std::vector<BodyDescription<Degree>>& bodies, double side) {
    const int steps = random_.integer(1, 4);
    const bool mesh = random_.one_in(5), tilted = random_.one_in(4), dome = random_.one_in(8);
    const double width = (side + 4) / steps;
    for (int step = 0; step < steps; ++step) {
      const Vector centre(-2 + width * (step + 0.5), 0.5 * side, -1 - (coarse_ ? 0.5 : 0.3) * step);
      auto ground = fixed_body<Degree>(Box{{0.5 * width, 0.5 * side + 2, 1}}, motion<Degree>(centre));
      if (mesh) {
        ground.shape = MeshShape{cube(), std::max(width, side)};
        ground.motion = {motion<Degree>(centre - Vector(0, 0, std::max(width, side) - 1))};
      }
      if (tilted) ground.orientation = unit_quaternion(1, 0.05, random_.between(-0.2, 0.2), 0);
      if (dome) {
        const double radius = width + side;
        ground = fixed_body<Degree>(Sphere{radius}, motion<Degree>(centre + Vector(0, 0, 1 - radius)));
      }
      if (motions_.moving_ground) {
        const double w = number(-0.5, 0.5), v = number(-1, 1), u = number(-1, 1);
        ground.motion[0].coefficients[1] = Vector(u, v, w);
        add_terms(ground.motion[0], 1);
      }
      ground.restitution = random_.one_in(3) ? 1 : 0.5;
      bodies.push_back(ground);
    }
  }

  /// A large box that goes up and down.
  void add_lift(std::vector<BodyDescription<Degree>>& bodies, double side) {
    auto lift =
        fixed_body<Degree>(Box{{0.5 * side, 0.25 * side, 0.25}}, motion<Degree>({0.5 * side, 0.5 * side, 1.25}));
    double start = 0;
    for (int pieces = random_.integer(1, 3); pieces > 0; --pieces) {
      start += number(0.5, 1);
      const Vector velocity(0, 0, number(-0.5, 0.5)), force(0, 0, random_.one_in(4) ? 0.25 : 0);
      lift.motion.push_back(motion<Degree>(lift.motion.back().position(start), velocity, force, start));
      if (motions_.moving_ground) add_terms(lift.motion.back(), 1);
    }
    bodies.push_back(lift);
  }

  /// Fixed, or moving across the ground.
  void add_obstacle(std::vector<BodyDescription<Degree>>& bodies, double side) {
    const Vector place(number(0, side), number(0, side), 0.25);
    auto obstacle = fixed_body<Degree>(Sphere{0.5}, motion<Degree>(place));
    if (random_.one_in(2)) obstacle.shape = Box{{1, 0.25, 0.5}};
    if (random_.one_in(4)) obstacle.motion = {motion<Degree>(place, Vector(number(-1, 1), number(-1, 1), 0))};
    bodies.push_back(obstacle);
  }

  Random random_;
  TableMotions motions_;
  std::uint64_t seed_;
  bool coarse_ = false, mixed_ = false, sideways_ = false;
  std::size_t row_ = 5;
  double spacing_ = 2, radius_ = 0.5, rebound_ = 1, end_time_ = 1;
};

/// Scenes of some seeds, each run in one manner; throws what compare_runs() throws. More by hand: KDS_TABLE_SEEDS.
template <int Degree>
void compare_tables(std::initializer_list<Seeds> seeds, Seen& seen) {
  compare_seeds<TableMaker<Degree>>("KDS_TABLE_SEEDS", seeds, seen);
}

}  // namespace kds::collision::tests
