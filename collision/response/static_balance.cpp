#include "collision/response/static_balance.hpp"

#include "collision/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// What is not balanced of a body: its acceleration, and its angular acceleration if its moment of inertia were mass
/// times size squared. Which moment it has does not matter: both are to be zero.
struct Unbalanced {
  Vector3d linear, angular;
};

/// [Nesterov83]: each step is from a point beyond the last one, in the direction of the last step, by ever more of it;
/// from the start again where that leads uphill [ODonoghue15].
class Descent {
 public:
  Descent(std::span<const Load> loads, std::span<const Foothold> footholds)
      : loads_(loads),
        footholds_(footholds),
        forces_(footholds.size(), Vector3d::Zero()),
        ahead_(forces_),
        steps_(footholds.size()) {
    for (const Load& load : loads) greatest_ = std::max(greatest_, norm(load.acceleration));
    std::vector<double> held(loads.size(), 0);  // by how many footholds
    for (const Foothold& at : footholds) {
      for (const std::uint32_t i : {at.a, at.b}) {
        if (i != Foothold::fixed) ++held[i];
      }
    }
    // The square of a sum of n vectors is at most n times the sum of their squares: so no step is too long.
    for (std::size_t k = 0; k < footholds.size(); ++k) {
      double mobility = 0;
      const auto add = [&](std::uint32_t i, const Vector3d& arm) {
        if (i == Foothold::fixed) return;
        mobility += held[i] * (1 + squared_norm(arm) / (loads[i].size * loads[i].size)) / loads[i].mass;
      };
      add(footholds[k].a, footholds[k].arm_a), add(footholds[k].b, footholds[k].arm_b);
      steps_[k] = 1 / mobility;
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

  /// The greatest of what is left, over the greatest acceleration.
  double left() {
    balance(forces_);
    double most = 0;
    for (std::size_t i = 0; i < loads_.size(); ++i) {
      most = std::max({most, norm(unbalanced_[i].linear), norm(unbalanced_[i].angular) * loads_[i].size});
    }
    return greatest_ > 0 ? most / greatest_ : 0;
  }

 private:
  /// What these forces leave.
  void balance(std::span<const Vector3d> forces) {
    unbalanced_.clear();
    for (const Load& load : loads_) unbalanced_.push_back({load.acceleration, Vector3d::Zero()});
    const auto give = [&](std::uint32_t i, const Vector3d& arm, const Vector3d& force) {
      if (i == Foothold::fixed) return;
      const Load& load = loads_[i];
      unbalanced_[i].linear += force / load.mass;
      unbalanced_[i].angular += cross(arm, force) / (load.mass * load.size * load.size);
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

  std::span<const Load> loads_;
  std::span<const Foothold> footholds_;
  std::vector<Vector3d> forces_;
  std::vector<Vector3d> ahead_;  ///< where the next step begins
  std::vector<double> steps_;
  std::vector<Unbalanced> unbalanced_;
  double greatest_ = 0;
  double pace_ = 1;
};

}  // namespace

bool balanced(std::span<const Load> loads, std::span<const Foothold> footholds) {
  constexpr int most_steps = 2048;
  constexpr int pause = 32;
  constexpr double progress = 0.875;  // in a pause, or there is little hope
  Descent descent(loads, footholds);
  double least = descent.left();
  int hopeless = 0;
  for (int steps = 0; steps < most_steps && least > balance_rounding; steps += pause) {
    for (int k = 0; k < pause; ++k) descent.step();
    const double left = descent.left();
    hopeless = left <= progress * least ? 0 : hopeless + 1;
    if (hopeless >= 4) return false;
    least = std::min(least, left);
  }
  return least <= balance_rounding;
}

}  // namespace kds::collision
