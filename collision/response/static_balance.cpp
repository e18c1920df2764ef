#include "collision/response/static_balance.hpp"

#include "collision/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// What is not balanced of a body: its acceleration, or velocity, and the angular one.
struct Unbalanced {
  Vector3d linear, angular;
};

// The moment of inertia of a load is taken as mass times size squared: it only weighs errors, all of which go to zero.
Unbalanced at_first(const Load& load) { return {load.acceleration, Vector3d::Zero()}; }
Vector3d pushed_by(const Load& load, const Vector3d& force) { return force / load.mass; }
Vector3d turned_by(const Load& load, const Vector3d& torque) { return torque / (load.mass * load.size * load.size); }
/// How much a force at the end of an arm accelerates that end, at most.
double mobility(const Load& load, const Vector3d& arm) {
  return (1 + squared_norm(arm) / (load.size * load.size)) / load.mass;
}

Unbalanced at_first(const StruckBody& body) { return {body.velocity.velocity, body.velocity.angular_velocity}; }
Vector3d pushed_by(const StruckBody& body, const Vector3d& force) { return body.mobility.inverse_mass * force; }
Vector3d turned_by(const StruckBody& body, const Vector3d& torque) { return body.mobility.turned_by(torque); }
double mobility(const StruckBody& body, const Vector3d& arm) {
  double turns = body.mobility.inverse_moment;
  if (!body.mobility.spherical) {  // the trace is at least the greatest
    const auto& inverse = body.mobility.inverse_inertia;
    turns = inverse(0, 0) + inverse(1, 1) + inverse(2, 2);
  }
  return body.mobility.inverse_mass + squared_norm(arm) * turns;
}

/// [Nesterov83]: each step is from a point beyond the last one, in the direction of the last step, by ever more of it;
/// from the start again where that leads uphill [ODonoghue15].
template <class Body>
class Descent {
 public:
  Descent(std::span<const Body> loads, std::span<const Foothold> footholds)
      : loads_(loads),
        footholds_(footholds),
        forces_(footholds.size(), Vector3d::Zero()),
        ahead_(forces_),
        steps_(footholds.size()) {
    for (const Body& load : loads) greatest_ = std::max(greatest_, norm(at_first(load).linear));
    std::vector<double> held(loads.size(), 0);  // by how many footholds
    for (const Foothold& at : footholds) {
      for (const std::uint32_t i : {at.a, at.b}) {
        if (i != Foothold::fixed) ++held[i];
      }
    }
    // The square of a sum of n vectors is at most n times the sum of their squares: so no step is too long.
    for (std::size_t k = 0; k < footholds.size(); ++k) {
      double sum = 0;
      const auto add = [&](std::uint32_t i, const Vector3d& arm) {
        if (i == Foothold::fixed) return;
        sum += held[i] * mobility(loads[i], arm);
      };
      add(footholds[k].a, footholds[k].arm_a), add(footholds[k].b, footholds[k].arm_b);
      steps_[k] = 1 / sum;
    }
  }

  void step() {
    balance(ahead_);
    double uphill = 0;
    const double next = (1 + std::sqrt(1 + 4 * pace_ * pace_)) / 2;
    const double beyond = (pace_ - 1) / next;
    for (std::size_t k = 0; k < footholds_.size(); ++k) {
      const Vector3d force = in_cone(ahead_[k] - steps_[k] * approach(footholds_[k]), footholds_[k]);
      const Vector3d change = force - forces_[k];
      uphill += certificates::dot(ahead_[k] - force, change) / steps_[k];
      ahead_[k] = force + beyond * change;
      forces_[k] = force;
    }
    pace_ = next;
    if (uphill > 0) pace_ = 1, ahead_ = forces_;
  }

  /// Finds what is left of each body.
  void look() { balance(forces_); }
  const Unbalanced& left_of(std::size_t i) const { return unbalanced_[i]; }
  /// The greatest acceleration at first.
  double greatest() const { return greatest_; }

 private:
  /// What these forces leave.
  void balance(std::span<const Vector3d> forces) {
    unbalanced_.clear();
    for (const Body& load : loads_) unbalanced_.push_back(at_first(load));
    const auto give = [&](std::uint32_t i, const Vector3d& arm, const Vector3d& force) {
      if (i == Foothold::fixed) return;
      unbalanced_[i].linear += pushed_by(loads_[i], force);
      unbalanced_[i].angular += turned_by(loads_[i], cross(arm, force));
    };
    for (std::size_t k = 0; k < footholds_.size(); ++k) {
      give(footholds_[k].a, footholds_[k].arm_a, -forces[k]);
      give(footholds_[k].b, footholds_[k].arm_b, forces[k]);
    }
  }

  /// The acceleration of b's point seen from a's.
  Vector3d approach(const Foothold& at) const {
    Vector3d relative = Vector3d::Zero();
    if (at.b != Foothold::fixed) relative += unbalanced_[at.b].linear + cross(unbalanced_[at.b].angular, at.arm_b);
    if (at.a != Foothold::fixed) relative -= unbalanced_[at.a].linear + cross(unbalanced_[at.a].angular, at.arm_a);
    return relative;
  }

  /// The nearest force that the foothold can give.
  static Vector3d in_cone(const Vector3d& force, const Foothold& at) {
    if (!at.pull.isZero(0)) {
      const Vector3d along = at.normal + at.friction * at.pull;
      return std::max(0.0, certificates::dot(force, along) / squared_norm(along)) * along;
    }
    const double along = certificates::dot(at.normal, force);
    const Vector3d across = force - along * at.normal;
    const double sideways = norm(across);
    const double mu = at.friction;
    if (sideways <= mu * along) return force;
    if (mu * sideways <= -along) return Vector3d::Zero();
    const double pushes = (along + mu * sideways) / (1 + mu * mu);
    if (sideways == 0) return pushes * at.normal;
    return pushes * at.normal + (mu * pushes / sideways) * across;
  }

  std::span<const Body> loads_;
  std::span<const Foothold> footholds_;
  std::vector<Vector3d> forces_;
  std::vector<Vector3d> ahead_;  ///< where the next step begins
  std::vector<double> steps_;
  std::vector<Unbalanced> unbalanced_;
  double greatest_ = 0;
  double pace_ = 1;
};

}  // namespace

bool balanced(std::span<const Load> loads, std::span<const Foothold> footholds, std::vector<double>* left) {
  constexpr int most_steps = 2048;
  constexpr int pause = 32;
  constexpr int most_hopeless = 4;
  constexpr double progress = 0.875;  // of `least`: a pause after which more is left counts as hopeless
  Descent<Load> descent(loads, footholds);
  const auto part = [&](std::size_t i) {
    const Unbalanced& rest = descent.left_of(i);
    const double most = std::max(norm(rest.linear), norm(rest.angular) * loads[i].size);
    return descent.greatest() > 0 ? most / descent.greatest() : 0;
  };
  const auto most_left = [&] {
    descent.look();
    double most = 0;
    for (std::size_t i = 0; i < loads.size(); ++i) most = std::max(most, part(i));
    return most;
  };
  double least = most_left();
  int hopeless = 0;
  for (int steps = 0; steps < most_steps && least > balance_rounding && hopeless < most_hopeless; steps += pause) {
    for (int k = 0; k < pause; ++k) descent.step();
    const double most = most_left();
    hopeless = most <= progress * least ? 0 : hopeless + 1;
    if (hopeless < most_hopeless) least = std::min(least, most);
  }
  if (left != nullptr) {
    left->clear();
    for (std::size_t i = 0; i < loads.size(); ++i) left->push_back(part(i));
  }
  return least <= balance_rounding;
}

bool StruckBody::slower_than(double speed) const {
  return norm(velocity.velocity) + norm(velocity.angular_velocity) * size <= speed;
}

bool takes_impact(std::span<StruckBody> bodies, std::span<const Foothold> footholds) {
  constexpr int most_steps = 512;
  constexpr int pause = 16;
  constexpr double enough = 0x1p-3;  // of `still_speed`: then the descent ends
  const auto slower_than = [&](double part) {
    return std::all_of(bodies.begin(), bodies.end(),
                       [&](const StruckBody& body) { return body.slower_than(part * body.still_speed); });
  };
  if (slower_than(1)) return true;
  const std::vector<StruckBody> struck(bodies.begin(), bodies.end());
  Descent<StruckBody> descent(struck, footholds);
  for (int steps = 0; steps < most_steps && !slower_than(enough); steps += pause) {
    for (int k = 0; k < pause; ++k) descent.step();
    descent.look();
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      bodies[i].velocity = {descent.left_of(i).linear, descent.left_of(i).angular};
    }
  }
  return slower_than(1);
}

}  // namespace kds::collision
