// Screening by windows of time.
#include "examples/jobs/conjunctions/cells.hpp"
#include "examples/jobs/conjunctions/passes.hpp"
#include "examples/jobs/conjunctions/screening.hpp"
#include "examples/jobs/conjunctions/trajectory.hpp"
#include "examples/jobs/cpu_time.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace conjunctions {
namespace {

using Eigen::Vector3d;

/// Windows in a tick. More make more work for each object, fewer more pairs that have to be tested. For the 30 000
/// objects of docs/conjunctions.md 2 to 5 take about the same time.
constexpr int windows_a_tick = 4;

/// Added to distances that are compared in doubles, km: coordinates up to 10^5 km and a few operations with them err by
/// less than 10^-9. A larger number would let some more pairs be tested.
constexpr double slack = 1e-6;

/// Where an object is in a window: not farther than `radius` from a place, and nearer than `bend` to where it would be
/// if it went straight on from there, in the middle of the window.
struct Stretch {
  Vector3d place, velocity;
  double radius, bend;
};

Stretch stretch(const Path& path, double middle, double half) {
  const double elapsed = middle - path.start;
  auto c = path.coefficients;  // and then about the middle
  for (std::size_t i = 5; i-- > 0;) {
    for (std::size_t k = i; k < 5; ++k) c[k] += elapsed * c[k + 1];
  }
  double bend = 0;
  for (std::size_t i = 5; i >= 2; --i) bend = (bend + c[i].norm()) * half;
  bend *= half;
  return {c[0], c[1], c[1].norm() * half + bend, bend};
}

/// Whether two objects may come nearer than a distance within a window.
bool may_come_near(const Stretch& a, const Stretch& b, double half, double distance) {
  const Vector3d apart = b.place - a.place;
  const double farthest = a.radius + b.radius + distance + slack;
  const double square = apart.squaredNorm();
  if (square > farthest * farthest) return false;
  const Vector3d velocity = b.velocity - a.velocity;
  const double rate = velocity.squaredNorm();
  const double when = rate > 0 ? std::clamp(-apart.dot(velocity) / rate, -half, half) : 0;
  const double most = a.bend + b.bend + distance + slack;
  return (apart + when * velocity).squaredNorm() <= most * most;
}

/// All that happens to a pair from one time to another.
void follow(std::size_t a, std::size_t b, const Path& path_a, const Path& path_b, double from, double to,
            double distance, Passes& passes) {
  const auto apart = farther_apart(path_a, path_b, distance);
  for (double t = from;;) {
    if (!passes.has(a, b)) {
      t = kds::failure_time(apart, t, to);
      if (t == kds::never) return;
      passes.begin(a, b, t, t == 0);
    }
    t = passes.look(a, b, path_a, path_b, t, to);
    if (t == kds::never) return;
    passes.end(a, b, t);
  }
}

}  // namespace

ScreeningCost screen_by_windows(std::span<const Elements> catalogue, const Screening& options,
                                const std::function<void(const Conjunction&)>& found) {
  check(options);
  ScreeningCost cost;
  jobs::CpuTime time;
  const double end = options.hours * 3600;
  Passes passes(options.distance, found);
  std::vector<Trajectory> trajectories(catalogue.begin(), catalogue.end());
  std::vector<Path> paths(catalogue.size());
  std::vector<Stretch> stretches(catalogue.size());
  std::vector<std::array<std::uint32_t, 2>> candidates;
  CellTable cells(catalogue.size());
  constexpr double window = tick / windows_a_tick;
  for (int w = 0; w * window < end; ++w) {
    if (w % windows_a_tick == 0) {
      for (std::size_t i = 0; i < paths.size(); ++i) {
        if (!trajectories[i].ends_at(w / windows_a_tick)) continue;
        paths[i] = trajectories[i].next();
        ++cost.pieces;
      }
    }
    time.charge(cost.interpolation);
    const double from = w * window, to = std::min((w + 1) * window, end), half = (to - from) / 2;
    double longest = 0;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      stretches[i] = stretch(paths[i], from + half, half);
      longest = std::max(longest, stretches[i].radius);
    }
    candidates.clear();
    cells.clear(2 * (2 * longest + options.distance + slack));
    for (std::uint32_t i = 0; i < paths.size(); ++i) {
      cells.visit_and_add(i, stretches[i].place, [&](std::uint32_t j) {
        if (may_come_near(stretches[i], stretches[j], half, options.distance)) candidates.push_back({j, i});
      });
    }
    cost.candidates += candidates.size();
    time.charge(cost.broad_phase);
    for (const auto& [a, b] : candidates) follow(a, b, paths[a], paths[b], from, to, options.distance, passes);
    time.charge(cost.pairs);
  }
  passes.end_all(end);
  return cost;
}

}  // namespace conjunctions
