#include "collision/least_constraint.hpp"

#include <algorithm>
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

/// Sweeps for a set of touches; at most this many touches are looked at in all. They bound the work where a solution is
/// slow to come (tall stacks, heavy above light) or does not exist.
constexpr std::size_t most_updates = 1'000'000;
std::size_t most_sweeps(std::size_t touches) {
  return std::min(4096 + 64 * touches, 64 + most_updates / touches);
}

double largest(std::span<const Vector3d> rates) {
  double result = 0;
  for (const Vector3d& rate : rates) result = std::max(result, rate.cwiseAbs().maxCoeff());
  return result;
}

bool along_axis(const Vector3d& normal) { return normal.cwiseAbs().sum() == 1 && normal.cwiseAbs().maxCoeff() == 1; }

void push(Rates rates, Touch& touch, double amount) {
  touch.push += amount;
  // Not `-=` and a product of its own for fixed bodies: zero times anything leaves them as they are.
  if (touch.share_a != 0) rates[touch.a] -= (amount * touch.share_a) * touch.normal;
  if (touch.share_b != 0) rates[touch.b] += (amount * touch.share_b) * touch.normal;
}

/// Gives each touch in turn what it lacks, or takes what it has too much. Returns the largest change.
double sweep(Rates rates, Touches touches, double relaxation, double target) {
  double change = 0;
  for (Touch& touch : touches) {
    const double aim = along_axis(touch.normal) ? 0 : target;
    const double amount = std::max(relaxation * (aim - parting_rate(rates, touch)), -touch.push);
    if (amount == 0) continue;
    push(rates, touch, amount);
    change = std::max(change, std::abs(amount));
  }
  return change;
}

bool holds(std::span<const Vector3d> rates, std::span<const Touch> touches, double tolerance) {
  return std::all_of(touches.begin(), touches.end(),
                     [&](const Touch& touch) { return parting_rate(rates, touch) >= -tolerance; });
}

/// Rates that differ from those of a fixed body, or from rest, by rounding alone are made equal to them, if all touches
/// allow it.
void snap(Rates rates, std::span<const Touch> touches, double scale) {
  std::vector<Vector3d> fixed{Vector3d::Zero()};
  std::vector<bool> is_fixed(rates.size(), false);
  for (const Touch& touch : touches) {
    for (const auto& [place, share] : {std::pair(touch.a, touch.share_a), std::pair(touch.b, touch.share_b)}) {
      if (share != 0 || is_fixed[place]) continue;
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

}  // namespace

double parting_rate(std::span<const Vector3d> rates, const Touch& touch) {
  const Vector3d apart = rates[touch.b] - rates[touch.a];
  return touch.normal[0] * apart[0] + touch.normal[1] * apart[1] + touch.normal[2] * apart[2];
}

bool least_constraint(Rates rates, Touches touches) {
  if (touches.empty()) return true;
  const double scale = largest(rates);
  for (Touch& touch : touches) {  // the guesses
    const double guess = touch.push;
    touch.push = 0;
    if (guess > 0) push(rates, touch, guess);
  }
  const double n = static_cast<double>(touches.size());
  const double relaxation = touches.size() < 3 ? 1 : 2 / (1 + std::sin(std::numbers::pi / (n + 1)));
  const std::size_t most = most_sweeps(touches.size());
  const double target = 0x1p-48 * scale;
  const double enough = 0x1p-50 * scale;
  for (std::size_t i = 0; i < most; ++i) {
    if (sweep(rates, touches, relaxation, target) <= enough) break;
  }
  for (int i = 0; i < 8; ++i) sweep(rates, touches, 1, target);
  snap(rates, touches, scale);
  return holds(rates, touches, rate_rounding * scale);
}

}  // namespace kds::collision
