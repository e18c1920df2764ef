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
struct Rest {
  Vector3d linear, angular;
};

class Descent {
 public:
  Descent(std::span<const Load> loads, std::span<const Foothold> footholds)
      : loads_(loads), footholds_(footholds), forces_(footholds.size(), Vector3d::Zero()) {
    for (const Load& load : loads) greatest_ = std::max(greatest_, norm(load.acceleration));
    start();
  }

  void sweep() {
    for (std::size_t k = 0; k < footholds_.size(); ++k) step(k);
    for (std::size_t k = footholds_.size(); k-- > 0;) step(k);
  }

  /// The greatest of what is left, over the greatest acceleration.
  double left() const {
    double most = 0;
    for (std::size_t i = 0; i < loads_.size(); ++i) {
      most = std::max({most, norm(rest_[i].linear), norm(rest_[i].angular) * loads_[i].size});
    }
    return greatest_ > 0 ? most / greatest_ : 0;
  }

  /// Calculates what is left from the forces, without what sweeps have added up of roundings.
  void start() {
    rest_.clear();
    for (const Load& load : loads_) rest_.push_back({load.acceleration, Vector3d::Zero()});
    for (std::size_t k = 0; k < footholds_.size(); ++k) push(footholds_[k], forces_[k]);
  }

 private:
  void push(const Foothold& at, const Vector3d& force) {
    const auto give = [&](std::uint32_t i, const Vector3d& arm, const Vector3d& f) {
      if (i == Foothold::fixed) return;
      const Load& load = loads_[i];
      rest_[i].linear += f / load.mass;
      rest_[i].angular += cross(arm, f) / (load.mass * load.size * load.size);
    };
    give(at.a, at.arm_a, -force);
    give(at.b, at.arm_b, force);
  }

  void step(std::size_t k) {
    constexpr double relaxation = 1.5;  // below 2, so that the sum of squares cannot grow
    const Foothold& at = footholds_[k];
    Vector3d approach = Vector3d::Zero();
    double mobility = 0;  // at least the acceleration along it that a force of 1 gives
    const auto look = [&](std::uint32_t i, const Vector3d& arm, double sign) {
      if (i == Foothold::fixed) return;
      approach += sign * (rest_[i].linear + cross(rest_[i].angular, arm));
      mobility += (1 + squared_norm(arm) / (loads_[i].size * loads_[i].size)) / loads_[i].mass;
    };
    look(at.a, at.arm_a, -1);
    look(at.b, at.arm_b, 1);
    const Vector3d force = in_cone(forces_[k] - (relaxation / mobility) * approach, at);
    push(at, force - forces_[k]);
    forces_[k] = force;
  }

  /// The nearest force that the foothold can give.
  static Vector3d in_cone(const Vector3d& force, const Foothold& at) {
    const double along = dot(at.normal, force);
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
  std::vector<Rest> rest_;
  double greatest_ = 0;
};

}  // namespace

bool balanced(std::span<const Load> loads, std::span<const Foothold> footholds) {
  constexpr int most_sweeps = 512;  // to and fro
  constexpr int pause = 8;
  constexpr double progress = 0.875;  // in a pause, or there is little hope
  Descent descent(loads, footholds);
  double before = descent.left();
  for (int sweeps = 1; sweeps <= most_sweeps; ++sweeps) {
    descent.sweep();
    const bool enough = descent.left() <= balance_rounding / 2;
    if (!enough && sweeps % pause != 0) continue;
    descent.start();
    const double left = descent.left();
    if (left <= balance_rounding) return true;
    if (sweeps % pause == 0 && !(left <= progress * before)) return false;
    if (sweeps % pause == 0) before = left;
  }
  return false;
}

}  // namespace kds::collision
