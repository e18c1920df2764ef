// Random scenes of balls and boxes on a lattice that lean on each other and are struck at one time.
#pragma once

#include "tests/collision/parallel/compared_runs.hpp"
#include "tests/collision/random_scenes.hpp"
#include "tests/support/random_numbers.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace kds::collision::tests {

/// Makes scenes of rows, blocks and chains at rest on one floor, which may be a lift: with numbers of a lattice, so
/// that what happens at their ends happens at the same times.
template <int Degree>
class TieMaker {
  using Vector = Eigen::Vector3d;
  using Path = certificates::PointMotion<Degree>;
  using Description = BodyDescription<Degree>;

 public:
  explicit TieMaker(std::uint64_t seed) : random_(seed * 7919 + 5), seed_(seed) {}
  Staging<Path> scene() {
    WorldOptions options;
    options.response = Response::elastic;
    const int cells = random_.integer(1, 4);
    const double width = 6.0 * cells;
    const double rebound = random_.one_in(2) ? 0 : 0.5 * random_.integer(0, 2);
    rebound_ = rebound;
    const bool lifts = random_.one_in(3);
    Description ground;
    ground.fixed = true;
    ground.restitution = random_.one_in(2) ? 1 : 0.5;
    ground.shape = Box{{width + 10, width + 10, 1}};
    ground.motion = {motion<Degree>(Vector(0, 0, -1))};
    if (lifts) {
      double start = 0;
      for (int pieces = random_.integer(1, 3); pieces > 0; --pieces) {
        start += 0.25 * random_.integer(1, 3);
        const Vector velocity(0, 0, 0.5 * random_.integer(-1, 2));
        ground.motion.push_back(motion<Degree>(ground.motion.back().position(start), velocity, Vector::Zero(), start));
      }
    }
    bodies_.push_back(ground);
    chains_ = random_.one_in(2);
    const int kind = static_cast<int>(random_.below(4));
    for (int i = 0; i < cells; ++i) {
      for (int j = 0; j < cells; ++j) {
        if (cells > 2 && random_.one_in(3)) continue;
        group(Vector(6.0 * (i - 0.5 * (cells - 1)), 6.0 * (j - 0.5 * (cells - 1)), 0.5),
              random_.one_in(3) ? static_cast<int>(random_.below(4)) : kind);
      }
    }
    if (chains_ || random_.one_in(3))
      for (std::size_t i = bodies_.size(); i > 1; --i) std::swap(bodies_[i - 1], bodies_[random_.below(i)]);
    const auto fill = [bodies = bodies_](World<Degree>& world) {
      for (const auto& b : bodies) world.add_body(b);
    };
    return {options, fill, 0.5 * random_.integer(2, 5),
            "tie " + std::to_string(seed_) + ", " + std::to_string(bodies_.size()) + " bodies"};
  }
  Manner manner(std::size_t most_domains) {
    Manner manner = random_manner(random_, most_domains);
    if (random_.one_in(2)) manner.parallel.halo = random_.between(0.5, 3);
    return manner;
  }

 private:
  void add(const Vector& place, const Vector& velocity = Vector::Zero()) {
    Description body;
    body.shape = random_.one_in(5) ? Shape(Box{Vector::Constant(0.5)}) : Shape(Sphere{0.5});
    body.motion = {motion<Degree>(place, velocity + Vector(0, 0, Degree == 1 ? -1 : 0), Vector(0, 0, -8))};
    body.restitution = rebound_;
    if (random_.one_in(12)) body.restitution = 1;
    if (random_.one_in(8)) body.mass = 0.5 * random_.integer(1, 6);
    if (random_.one_in(40)) body.sensor = true;
    bodies_.push_back(body);
  }
  /// Hard balls in a row, the first of which is struck, lead to soft ones that lean on each other.
  void chain(const Vector& centre) {
    const double side = random_.one_in(2) ? 1 : -1;
    const bool across = random_.one_in(2);
    const auto at = [&](double x, double y, double z) {
      return Vector(centre + (across ? Vector(y, side * x, z) : Vector(side * x, y, z)));
    };
    const int hard = random_.integer(1, 4), soft = random_.integer(2, 4), layers = random_.integer(1, 2);
    const double from = -0.5 * random_.integer(0, 2 * (hard + soft - 1)), speed = random_.integer(1, 2),
                 far = speed * 0.5;
    const double press = random_.integer(0, 2);
    const auto put = [&](const Vector& place, const Vector& velocity, double rebound, double pull) {
      Description body;
      body.shape = Sphere{0.5};
      const Vector a = at(-pull, 0, -8) - centre;
      body.motion = {motion<Degree>(place, velocity + Vector(0, 0, Degree == 1 ? -1 : 0), a)};
      body.restitution = rebound;
      bodies_.push_back(body);
    };
    put(at(from - 1 - far, 0, 0), at(speed, 0, 0) - centre, 1, 0);
    for (int i = 0; i < hard; ++i) put(at(from + i, 0, 0), Vector::Zero(), 1, 0);
    for (int i = 0; i < soft; ++i) {
      put(at(from + hard + i, 0, 0), Vector::Zero(), 0, i == soft - 1 ? press : 0.5 * press * random_.integer(0, 2));
      if (layers > 1 && i > 0) put(at(from + hard + i - 0.5, 0, random_.one_in(2) ? 1 : 0.875), Vector::Zero(), 0, 0);
    }
  }
  void group(const Vector& centre, int kind) {
    if (chains_) return chain(centre);
    const int nx = random_.integer(1, 4), ny = random_.integer(1, 3), nz = random_.integer(1, 2);
    const double off = random_.one_in(2) ? 0 : 0.5;
    for (int i = 0; i < nx; ++i)
      for (int j = 0; j < ny; ++j)
        for (int k = 0; k < nz; ++k) add(centre + Vector(i - 0.5 * (nx - 1) + off, j - 0.5 * (ny - 1) + off, k));
    const double far = 1 + 0.5 * random_.integer(0, 2), speed = random_.integer(1, 3);
    const auto strike = [&](const Vector& side, double half) {
      add(centre + Vector(off, off, 0) + (half + far) * side, -speed * side);
    };
    if (kind == 0 || kind == 2) strike(Vector(1, 0, 0), 0.5 * nx), strike(Vector(-1, 0, 0), 0.5 * nx);
    if (kind == 1 || kind == 2) strike(Vector(0, 1, 0), 0.5 * ny), strike(Vector(0, -1, 0), 0.5 * ny);
    if (kind == 3) {
      for (int i = 0; i < nx; ++i)
        for (int j = 0; j < ny; ++j)
          if (random_.one_in(2)) add(centre + Vector(i - 0.5 * (nx - 1) + off, j - 0.5 * (ny - 1) + off, nz + far));
    }
  }
  Random random_;
  std::uint64_t seed_;
  double rebound_ = 0;
  bool chains_ = false;
  std::vector<Description> bodies_;
};

}  // namespace kds::collision::tests
