// Elastic balls in a box with walls, and what the rounding of their motions does to energy and momentum.
#pragma once

#include "collision/world.hpp"
#include "tests/support/random_numbers.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace accuracy {

using Eigen::Vector3d;
using Long = long double;  // sums are kept in it, so that what is measured is not the measuring
using Vector3l = Eigen::Matrix<Long, 3, 1>;

struct GasOptions {
  std::size_t balls = 64;
  double packing = 0.15;  ///< volume of the balls over that of the box
  double speed = 1;       ///< units / s
  double mass_ratio = 1;  ///< of the heaviest to the lightest; each ball is one or the other if > 1
  double gravity = 0;     ///< units / s^2 along -z; needs degree 2
  double start_time = 0;  ///< s
  double offset = 0;      ///< coordinates of the corner of the box
  std::uint64_t seed = 1;
};

/// What contacts of balls did, one by one and in sum.
struct Drift {
  std::uint64_t contacts = 0;
  Long energy = 0;                               ///< sum of the changes at contacts over the energy at the start
  Long energy_square = 0;                        ///< sum of their squares
  Long worst_energy = 0;                         ///< greatest change at one contact, over the energy of the two balls
  Long pair_energy = 0, pair_energy_square = 0;  ///< sums of changes over the energy of the two balls
  Vector3l momentum = Vector3l::Zero();          ///< sum of the changes at contacts
  Long momentum_square = 0;
  Long all_energy = 0;  ///< total now less total at the start, over the total at the start: walls and restarts too
};

template <int Degree>
class Gas final : private kds::collision::WorldListener<Degree> {
 public:
  using World = kds::collision::World<Degree>;
  using Motion = kds::certificates::PointMotion<Degree>;

  explicit Gas(const GasOptions& options) : Gas(options, fill(options)) {}

  /// Runs on to the n-th contact of two balls.
  void run_to(std::uint64_t n) {
    while (drift_.contacts < n) {
      if (!world_.step()) throw std::runtime_error("the gas has come to rest");
    }
    drift_.all_energy = (total_energy() - energy_at_start_) / energy_at_start_;
  }

  const Drift& drift() const { return drift_; }
  const World& world() const { return world_; }
  Long momentum_scale() const { return momentum_scale_; }  ///< sum of all |momenta| at the start
  Long energy_at_start() const { return energy_at_start_; }

 private:
  struct Filling {
    double side;
    std::vector<kds::collision::BodyDescription<Degree>> bodies;
  };

  static Filling fill(const GasOptions& o) {
    kds::tests::Random random(o.seed);
    Filling filling;
    double volume = 0;
    std::vector<double> radii;
    for (std::size_t i = 0; i < o.balls; ++i) {
      radii.push_back(random.between(0.5, 1));
      volume += 4.0 / 3.0 * std::numbers::pi * radii.back() * radii.back() * radii.back();
    }
    filling.side = std::cbrt(volume / o.packing);
    std::sort(radii.rbegin(), radii.rend());
    for (const double r : radii) {
      Vector3d at;
      bool free = false;
      for (int tries = 0; !free; ++tries) {
        if (tries > 1'000'000) throw std::runtime_error("no room for a ball");
        for (int d = 0; d < 3; ++d) at[d] = random.between(r, filling.side - r);
        free = true;
        for (std::size_t j = 0; j < filling.bodies.size() && free; ++j) {
          const double sum_of_radii = (r + radii[j]) * (1 + 1e-6);
          free = (filling.bodies[j].motion[0].coefficients[0] - Vector3d::Constant(o.offset) - at).squaredNorm() >
                 sum_of_radii * sum_of_radii;
        }
      }
      kds::collision::BodyDescription<Degree> body;
      body.shape = kds::collision::Sphere{r};
      body.mass = o.mass_ratio > 1 ? (random.one_in(2) ? o.mass_ratio : 1.0) : random.between(0.5, 2);
      Motion motion;
      motion.start = o.start_time;
      motion.coefficients[0] = at + Vector3d::Constant(o.offset);
      for (int d = 0; d < 3; ++d) motion.coefficients[1][d] = random.between(-1, 1) * o.speed;
      if constexpr (Degree == 2) motion.coefficients[2] = Vector3d(0, 0, -0.5 * o.gravity);
      body.motion = {motion};
      filling.bodies.push_back(std::move(body));
    }
    return filling;
  }

  static kds::collision::WorldOptions world_options(const GasOptions& o, double side) {
    kds::collision::WorldOptions options;
    options.start_time = o.start_time;
    options.window = 4 / o.speed;
    options.response = kds::collision::Response::elastic;
    options.walls = kds::collision::Walls{Vector3d::Constant(o.offset), Vector3d::Constant(o.offset + side)};
    return options;
  }

  Gas(const GasOptions& o, const Filling& filling) : world_(world_options(o, filling.side), this), gravity_(o.gravity) {
    for (const auto& body : filling.bodies) {
      world_.add_body(body);
      motions_.push_back(body.motion[0]);
    }
    world_.advance_to(o.start_time);
    base_ = o.offset;
    energy_at_start_ = total_energy();
    for (std::size_t i = 0; i < motions_.size(); ++i) {
      momentum_scale_ += static_cast<Long>(filling.bodies[i].mass) * velocity(motions_[i], o.start_time).norm();
    }
  }

  static Vector3l velocity(const Motion& m, double t) {
    Vector3l v = m.coefficients[1].template cast<Long>();
    if constexpr (Degree == 2) v += 2 * (static_cast<Long>(t) - m.start) * m.coefficients[2].template cast<Long>();
    return v;
  }
  Long kinetic(kds::collision::BodyId id, const Motion& m, double t) const {
    return static_cast<Long>(world_.mass(id)) * velocity(m, t).squaredNorm() / 2;
  }
  /// Kinetic, and what gravity gives above the floor.
  Long total_energy() const {
    const double t = world_.now();
    Long sum = 0;
    for (kds::collision::BodyId id = 0; id < motions_.size(); ++id) {
      const Motion& m = world_.motion(id);
      sum += kinetic(id, m, t);
      if constexpr (Degree == 2) {
        const Long tau = static_cast<Long>(t) - m.start;
        const Long height = m.coefficients[0][2] + tau * (m.coefficients[1][2] + tau * m.coefficients[2][2]) - base_;
        sum += static_cast<Long>(world_.mass(id)) * gravity_ * height;
      }
    }
    return sum;
  }

  void contact(World&, const kds::collision::PairEvent& e) override {
    const double t = e.contact.time;
    Long before = 0, after = 0;
    Vector3l change = Vector3l::Zero();
    for (const auto id : {e.a, e.b}) {
      const Motion& now = world_.motion(id);
      before += kinetic(id, motions_[id], t);
      after += kinetic(id, now, t);
      change += static_cast<Long>(world_.mass(id)) * (velocity(now, t) - velocity(motions_[id], t));
      motions_[id] = now;
    }
    ++drift_.contacts;
    const Long error = after - before;
    drift_.energy += error / energy_at_start_;
    drift_.energy_square += (error / energy_at_start_) * (error / energy_at_start_);
    drift_.pair_energy += error / before;
    drift_.pair_energy_square += (error / before) * (error / before);
    drift_.worst_energy = std::max(drift_.worst_energy, std::abs(error / before));
    drift_.momentum += change;
    drift_.momentum_square += change.squaredNorm();
  }
  void wall(World&, const kds::collision::WallEvent& e) override { motions_[e.body] = world_.motion(e.body); }

  World world_;
  Long gravity_;
  Long base_ = 0;
  std::vector<Motion> motions_;  // as before the next contact
  Long energy_at_start_ = 0;
  Long momentum_scale_ = 0;
  Drift drift_;
};

}  // namespace accuracy
