#include "collision/response/least_constraint.hpp"

#include "collision/response/least_norm.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

namespace kds::collision {
namespace {

using Eigen::Vector3d;
using Rates = std::span<Vector3d>;
using Touches = std::span<Touch>;

/// Sweeps for a set of touches; at most this many touches are looked at in all. They bound the work where convergence
/// is slow (tall stacks, heavy above light) or there is no solution.
constexpr std::size_t most_updates = 1'000'000;
std::size_t most_sweeps(std::size_t touches) { return std::min(4096 + 64 * touches, 64 + most_updates / touches); }

/// Measured: the fewest sweeps for heaps of balls; with 1 they are half as many again.
constexpr double over_relaxation = 1.3;

double greatest(std::span<const Vector3d> rates) {
  double result = 0;
  for (const Vector3d& rate : rates) result = std::max(result, rate.cwiseAbs().maxCoeff());
  return result;
}

bool along_axis(const Vector3d& normal) {
  return std::abs(normal[0]) + std::abs(normal[1]) + std::abs(normal[2]) == 1 && normal.cwiseAbs().maxCoeff() == 1;
}

void push_guesses(Rates rates, Touches touches) {
  for (Touch& touch : touches) {
    const double guess = touch.push;
    touch.push = 0;
    if (guess > 0) give_push(rates, touch, guess);
  }
}

double aim_of(const Touch& touch, double target) {
  return target == 0 || along_axis(touch.normal) ? touch.least : touch.least + target;
}

/// Increases or reduces the push of each touch in turn to what it needs. Returns the largest change.
double sweep(Rates rates, Touches touches, double relaxation, double target) {
  double change = 0;
  for (Touch& touch : touches) {
    const double amount = std::max(relaxation * (aim_of(touch, target) - parting_rate(rates, touch)), -touch.push);
    if (amount == 0) continue;
    give_push(rates, touch, amount);
    change = std::max(change, std::abs(amount));
  }
  return change;
}

bool holds(std::span<const Vector3d> rates, std::span<const Touch> touches, double tolerance) {
  return std::all_of(touches.begin(), touches.end(),
                     [&](const Touch& touch) { return parting_rate(rates, touch) >= touch.least - tolerance; });
}

/// Rates that differ from those of a fixed body, or from rest, only by rounding are made equal to them, if all touches
/// allow it.
void snap(Rates rates, std::span<const Touch> touches, double scale) {
  std::vector<Vector3d> fixed{Vector3d::Zero()};
  std::vector<bool> is_fixed(rates.size(), false);
  for (const Touch& touch : touches) {
    const std::array both{std::pair(touch.a, touch.inverse_mass_a), std::pair(touch.b, touch.inverse_mass_b)};
    for (const auto& [place, inverse_mass] : both) {
      if (inverse_mass != 0 || is_fixed[place]) continue;
      is_fixed[place] = true;
      if (rates[place] != fixed.back()) fixed.push_back(rates[place]);
    }
  }
  std::vector<Vector3d> snapped(rates.begin(), rates.end());
  for (std::size_t i = 0; i < rates.size(); ++i) {
    if (is_fixed[i]) continue;
    for (const Vector3d& one : fixed) {
      for (int d = 0; d < 3; ++d) {
        if (std::abs(rates[i][d] - one[d]) <= 0x1p-44 * scale) snapped[i][d] = one[d];
      }
    }
  }
  if (holds(snapped, touches, 0)) std::copy(snapped.begin(), snapped.end(), rates.begin());
}

/// [Lawson74], chapter 23: the touches that push are found one by one, each time solving for those that do. Unknowns
/// are pushes over the root of the sum of the inverse masses, which makes the matrix symmetric with a diagonal of ones.
class ActiveSet {
 public:
  ActiveSet(Rates rates, Touches touches, double target, double scale)
      : rates_(rates), touches_(touches), target_(target), scale_(scale), active_(touches.size(), false) {
    const std::size_t n = touches.size();
    matrix_.resize(n * n);
    for (std::size_t i = 0; i < n; ++i) {
      matrix_[i * n + i] = 1;
      for (std::size_t j = 0; j < i; ++j) matrix_[i * n + j] = matrix_[j * n + i] = coupling(touches[i], touches[j]);
    }
  }

  /// Pushes and rates of the solution; false if there is none, or none was found.
  bool solve() {
    for (std::size_t i = 0; i < touches_.size(); ++i) active_[i] = touches_[i].push > 0;
    if (!improve()) return false;
    for (std::size_t step = 0; step < 3 * touches_.size(); ++step) {
      const std::size_t next = most_violated();
      if (next == touches_.size()) return true;
      active_[next] = true;
      if (!improve()) return false;
    }
    return false;
  }

 private:
  static constexpr std::size_t none = ~std::size_t{0};

  static double sum(const Touch& touch) { return touch.inverse_mass_a + touch.inverse_mass_b; }

  static double coupling(const Touch& x, const Touch& y) {
    double shared = 0;
    if (x.a == y.a) shared += x.inverse_mass_a;
    if (x.b == y.b) shared += x.inverse_mass_b;
    if (x.a == y.b) shared -= x.inverse_mass_a;
    if (x.b == y.a) shared -= x.inverse_mass_b;
    return shared * dot(x.normal, y.normal) / (std::sqrt(sum(x)) * std::sqrt(sum(y)));
  }

  double lack(std::size_t i) const { return aim_of(touches_[i], target_) - parting_rate(rates_, touches_[i]); }

  std::size_t most_violated() const {
    double most = 0x1p-46 * scale_;
    std::size_t result = touches_.size();
    for (std::size_t i = 0; i < touches_.size(); ++i) {
      if (active_[i] || !(lack(i) > most)) continue;
      most = lack(i);
      result = i;
    }
    return result;
  }

  /// Solves for the active touches, removes those that would pull, and repeats.
  bool improve() {
    for (std::size_t round = 0; round <= touches_.size() + 4; ++round) {
      std::vector<std::size_t> places;
      for (std::size_t i = 0; i < touches_.size(); ++i) {
        if (active_[i]) places.push_back(i);
      }
      if (places.empty()) return true;
      const std::size_t n = places.size();
      std::vector<double> matrix(n * n), lacks(n);
      for (std::size_t i = 0; i < n; ++i) {
        lacks[i] = lack(places[i]) / std::sqrt(sum(touches_[places[i]]));
        for (std::size_t j = 0; j < n; ++j) matrix[i * n + j] = matrix_[places[i] * touches_.size() + places[j]];
      }
      const std::vector<double> change = least_norm_solution(matrix, lacks);
      if (!std::all_of(change.begin(), change.end(), [](double x) { return std::isfinite(x); })) return false;
      // The step goes only as far as no push becomes a pull.
      double part = 1;
      std::size_t first = none;
      std::vector<double> amounts;
      for (std::size_t i = 0; i < n; ++i) {
        const Touch& t = touches_[places[i]];
        amounts.push_back(change[i] * std::sqrt(sum(t)));
        if (t.push + part * amounts.back() < 0) {
          part = t.push / -amounts.back();
          first = places[i];
        }
      }
      double largest_lack = 0;
      for (std::size_t i = 0; i < n; ++i) give_push(rates_, touches_[places[i]], part * amounts[i]);
      for (const std::size_t place : places) largest_lack = std::max(largest_lack, std::abs(lack(place)));
      if (first != none) {
        give_push(rates_, touches_[first], -touches_[first].push);
        active_[first] = false;
      } else if (largest_lack <= 0x1p-48 * scale_) {
        return true;
      } else if (round > 4 && largest_lack > rate_rounding * scale_) {
        return false;  // The active touches contradict each other.
      }
    }
    return true;
  }

  Rates rates_;
  Touches touches_;
  double target_;
  double scale_;
  std::vector<bool> active_;
  std::vector<double> matrix_;  // row by row
};

constexpr std::size_t most_active = 64;

/// For many touches; slow where heavy bodies lie on light ones.
void relax(Rates rates, Touches touches, double target, double scale) {
  const double n = static_cast<double>(touches.size());
  const double relaxation = 2 / (1 + std::sin(std::numbers::pi / (n + 1)));
  const std::size_t most = most_sweeps(touches.size());
  for (std::size_t i = 0; i < most; ++i) {
    if (sweep(rates, touches, relaxation, target) <= 0x1p-50 * scale) return;
  }
}

}  // namespace

bool nearly_least_constraint(Rates rates, Touches touches, double tolerance, std::size_t most_sweeps) {
  push_guesses(rates, touches);
  for (std::size_t i = 0; i < most_sweeps; ++i) {
    if (sweep(rates, touches, over_relaxation, 0) <= tolerance) break;
  }
  return holds(rates, touches, tolerance);
}

bool least_constraint(Rates rates, Touches touches) {
  if (touches.empty()) return true;
  const double scale = greatest(rates);
  push_guesses(rates, touches);
  const double target = 0x1p-48 * scale;
  // One touch, or none that pushes another, is exact at once.
  if (sweep(rates, touches, 1, target) > 0 && sweep(rates, touches, 1, target) > 0) {
    if (touches.size() > most_active) {
      relax(rates, touches, target, scale);
    } else {
      ActiveSet(rates, touches, target, scale).solve();
    }
  }
  for (int i = 0; i < 8; ++i) sweep(rates, touches, 1, target);
  snap(rates, touches, scale);
  return holds(rates, touches, rate_rounding * scale);
}

}  // namespace kds::collision
