#include "examples/jobs/conjunctions/sieve.hpp"

#include "examples/jobs/conjunctions/cells.hpp"
#include "examples/jobs/cpu_time.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace conjunctions {
namespace {

using Eigen::Vector3d;

/// Two orbits: their distance and its change.
class OrbitPair {
 public:
  OrbitPair(const Orbit& a, const Orbit& b) : a_(a), b_(b) {}

  double distance(double t) const { return (b_.state(t).position - a_.state(t).position).norm(); }
  bool approach(double t) const {
    const State a = a_.state(t), b = b_.state(t);
    return (b.position - a.position).dot(b.velocity - a.velocity) < 0;
  }

  /// The t between two of which one `holds` and the other does not, to rounding.
  template <class Holds>
  static double change(double from, double to, const Holds& holds) {
    const bool first = holds(from);
    for (double middle; (middle = from + (to - from) / 2) != from && middle != to;)
      (holds(middle) == first ? from : to) = middle;
    return from;
  }

  /// From t on, in steps until they are farther apart than d, but not beyond an end.
  double leave(double t, double step, double d, double end) const {
    const auto near = [&](double when) { return distance(when) < d; };
    while (t != end) {
      const double next = step > 0 ? std::min(t + step, end) : std::max(t + step, end);
      if (!near(next)) return change(t, next, near);
      t = next;
    }
    return end;
  }

 private:
  const Orbit& a_;
  const Orbit& b_;
};

}  // namespace

SieveCost sieve(std::span<const Elements> catalogue, const Screening& options, double step,
                const std::function<void(const Conjunction&)>& found) {
  SieveCost cost;
  jobs::CpuTime time;
  const double end = options.hours * 3600, d = options.distance, half = step / 2;
  std::vector<Orbit> orbits;
  double fastest = 0, sharpest = 0;  // at perigee
  for (const Elements& elements : catalogue) {
    orbits.emplace_back(elements);
    const double low = elements.semi_major_axis * (1 - elements.eccentricity);
    fastest = std::max(fastest, std::sqrt(mu * (1 + elements.eccentricity) / low));
    sharpest = std::max(sharpest, mu / (low * low));
  }
  // Within half a step of a sample a path is off its tangent by no more than this.
  const double bend = sharpest * half * half / 2;
  CellTable cells(orbits.size());
  std::vector<State> states(orbits.size());
  std::map<std::array<std::size_t, 2>, std::vector<Conjunction>> of_pair;

  const auto refine = [&](std::size_t a, std::size_t b, double t) {
    if (a > b) std::swap(a, b);
    const OrbitPair pair(orbits[a], orbits[b]);
    const double from = std::max(t - half, 0.0), to = std::min(t + half, end);
    double closest;
    if (pair.approach(from)) {
      // An approach that goes on belongs to the next sample, unless there is none.
      if (pair.approach(to) && to < end) return;
      closest = pair.approach(to) ? to : OrbitPair::change(from, to, [&](double when) { return pair.approach(when); });
    } else {
      if (from > 0) return;
      closest = 0;
    }
    const double distance = pair.distance(closest);
    if (!(distance < d)) return;
    auto& known = of_pair[{a, b}];
    for (Conjunction& before : known) {  // one stay with several approaches
      if (!(before.entry <= closest && closest <= before.exit)) continue;
      if (distance < before.distance) before.closest = closest, before.distance = distance;
      return;
    }
    Conjunction& conjunction = known.emplace_back();
    conjunction.a = a, conjunction.b = b;
    conjunction.entry = pair.leave(closest, -half, d, 0);
    conjunction.closest = closest;
    conjunction.distance = distance;
    conjunction.exit = pair.leave(closest, half, d, end);
    conjunction.near_at_start = conjunction.entry == 0;
    conjunction.near_at_end = conjunction.exit == end;
  };

  std::vector<std::array<std::uint32_t, 2>> candidates;
  for (int k = 0; k * step < end + half; ++k) {
    const double t = k * step;
    for (std::size_t i = 0; i < orbits.size(); ++i) states[i] = orbits[i].state(t);
    time.charge(cost.propagation);
    candidates.clear();
    cells.clear(2 * (d + 2 * fastest * half));
    for (std::uint32_t i = 0; i < orbits.size(); ++i) {
      cells.visit_and_add(i, states[i].position, [&](std::uint32_t j) {
        const Vector3d apart = states[j].position - states[i].position;
        const double most = d + 2 * bend;
        // The relative velocity brings them nearer by at most its length.
        const Vector3d speed = states[j].velocity - states[i].velocity;
        const double rate = speed.squaredNorm();
        const double when = rate > 0 ? std::clamp(-apart.dot(speed) / rate, -half, half) : 0;
        if ((apart + when * speed).squaredNorm() < most * most) candidates.push_back({i, j});
      });
    }
    cost.candidates += candidates.size();
    time.charge(cost.grid);
    for (const auto& [i, j] : candidates) refine(i, j, t);
    time.charge(cost.refinement);
  }
  for (const auto& [pair, conjunctions] : of_pair) {
    for (const Conjunction& conjunction : conjunctions) found(conjunction);
  }
  return cost;
}

}  // namespace conjunctions
