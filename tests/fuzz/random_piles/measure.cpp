#include "tests/fuzz/random_piles/measure.hpp"

#include "collision/world.hpp"
#include "kds/audit.hpp"
#include "tests/fuzz/random_piles/depth.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <deque>
#include <exception>
#include <limits>

namespace kds::piles {
namespace {

using collision::BodyId;
using collision::PairEvent;
using collision::WallEvent;
using collision::World;
using Eigen::Vector3d;

/// With so many bodies or fewer, all pairs are measured at each event.
constexpr std::size_t few = 8;
/// s of simulated time between measurements of all bodies.
constexpr double sample = 0.05;
/// Samples between audits.
constexpr int audits_every = 16;
/// A gain of energy lasts if it does for so many times sqrt(size / acceleration): two spans of clusters.
constexpr double lasting_gain = 0x1p-3;
/// Bodies that begin deeper in each other than this part of the smaller radius are not measured. Those that touch
/// exactly may begin in overlap by a rounding.
constexpr double begins_apart = 1e-12;

double seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Measures a world as it runs.
class Meter : public collision::WorldListener<2> {
 public:
  Meter(const Scene& scene, Result& result) : scene_(scene), result_(result) {
    for (const Description& body : scene.bodies) {
      solids_.emplace_back(collision::place(body.shape, body.orientation));
      places_.push_back(body.motion.front().position(0));
      if (!body.fixed) free_.push_back(solids_.size() - 1);
    }
    touched_.assign(solids_.size(), 0);
    left_.assign(solids_.size(), 0);
    const std::size_t n = solids_.size();
    skipped_.assign(n * n, 0);
    for (std::size_t a = 0; a < n; ++a) {
      for (std::size_t b = 0; b < n; ++b) {
        skipped_[a * n + b] = a == b || (scene.bodies[a].fixed && scene.bodies[b].fixed) ||
                              depth(solids_[a], places_[a], solids_[b], places_[b]) > begins_apart * smaller(a, b);
      }
    }
    make_scales();
  }

  void look_at_touched(World<2>& world) {
    if (solids_.size() <= few) return look_at_all(world);
    take_places(world);
    for (const std::size_t i : list_) {
      look_at(i, 0, world.now());
      touched_[i] = 0;
    }
    if (!list_.empty()) look_at_sums(world);
    list_.clear();
  }

  void look_at_all(World<2>& world) {
    take_places(world);
    for (const std::size_t i : free_) look_at(i, i, world.now());
    for (const std::size_t i : list_) touched_[i] = 0;
    list_.clear();
    look_at_sums(world);
  }

  double kinetic(World<2>& world) const {
    double sum = 0;
    for (const std::size_t i : free_) {
      sum += 0.5 * scene_.bodies[i].mass * world.motion(BodyId(i)).velocity(world.now()).squaredNorm();
    }
    return sum / scale_;
  }

  void find(const char* what, double now, double amount, const std::string& text) {
    for (Finding& finding : result_.findings) {
      if (finding.what != what) continue;
      finding.worst = std::max(finding.worst, amount);
      return;
    }
    result_.findings.push_back({what, now, amount, text});
  }

  void contact(World<2>&, const PairEvent& e) override { touch(e.a), touch(e.b); }
  void held(World<2>&, const PairEvent& e) override { touch(e.a), touch(e.b); }
  void wall(World<2>&, const WallEvent& e) override { touch(e.body); }
  void moved(World<2>&, BodyId id) override { touch(id); }

 private:
  double smaller(std::size_t a, std::size_t b) const {
    return std::min(solids_[a].shape.bounding_radius, solids_[b].shape.bounding_radius);
  }

  void touch(BodyId id) {
    const auto i = static_cast<std::size_t>(std::uint64_t{id});
    if (scene_.bodies[i].fixed || touched_[i]) return;
    touched_[i] = 1;
    list_.push_back(i);
  }

  void take_places(World<2>& world) {
    for (std::size_t i = 0; i < places_.size(); ++i) places_[i] = world.motion(BodyId(i)).position(world.now());
  }

  /// One body, with all fixed ones and the free ones that come after `after` (all of them if it is 0).
  void look_at(std::size_t i, std::size_t after, double now) {
    const std::size_t n = solids_.size();
    for (std::size_t k = 0; k < n; ++k) {
      if (skipped_[i * n + k] || (k < after && !scene_.bodies[k].fixed)) continue;
      const double deep = depth(solids_[i], places_[i], solids_[k], places_[k]) / smaller(i, k);
      result_.overlap = std::max(result_.overlap, deep);
      if (deep > deepest_overlap) {
        find("overlap", now, deep, "bodies " + std::to_string(i) + " and " + std::to_string(k));
      }
    }
    const double radius = solids_[i].shape.bounding_radius;
    const Vector3d& place = places_[i];
    double out = 0;
    if (scene_.walls) {
      out = std::max((scene_.walls->min - place).maxCoeff() + radius, (place - scene_.walls->max).maxCoeff() + radius);
    } else if (scene_.region) {
      left_[i] = left_[i] || place[1] > scene_.region->max[1];
      if (!left_[i]) out = std::max((scene_.region->min - place).maxCoeff(), (place - scene_.region->max).maxCoeff());
    }
    if (out > deepest_overlap * radius) find("outside", now, out / radius, "body " + std::to_string(i));
  }

  double energy(World<2>& world) const {
    double sum = 0;
    for (const std::size_t i : free_) {
      const double speed2 = world.motion(BodyId(i)).velocity(world.now()).squaredNorm();
      sum += scene_.bodies[i].mass * (0.5 * speed2 - scene_.gravity.dot(places_[i]));
    }
    return sum;
  }

  Vector3d momentum(World<2>& world) const {
    Vector3d sum = Vector3d::Zero();
    for (const std::size_t i : free_) sum += scene_.bodies[i].mass * world.motion(BodyId(i)).velocity(world.now());
    return sum;
  }

  void look_at_sums(World<2>& world) {
    if (!scene_.driven()) {
      const double gain = gained_for_good(world.now(), energy(world)) / scale_;
      result_.energy = std::max(result_.energy, gain);
      if (gain > greatest_gain) find("energy", world.now(), gain, "");
    }
    if (scene_.isolated()) {
      const double change = (momentum(world) - momentum_).norm() / momenta_;
      if (change > greatest_change_of_momentum) find("momentum", world.now(), change, "");
    }
  }

  /// By how much the least energy of the last few spans is more than the least before. Within a span of a cluster
  /// energy comes and goes, since a parabola is not an arc (docs/resting.md).
  double gained_for_good(double now, double energy) {
    while (!recent_.empty() && recent_.back().energy >= energy) recent_.pop_back();
    recent_.push_back({now, energy});
    for (; recent_.front().time < now - lasting_; recent_.pop_front()) {
      least_energy_ = std::min(least_energy_, recent_.front().energy);
    }
    return recent_.front().energy - least_energy_;
  }

  /// The energy at the start, over that at the lowest place of a free body, less its radius.
  void make_scales() {
    const double g = scene_.gravity.norm();
    double low = std::numeric_limits<double>::infinity();
    for (const std::size_t i : free_) {
      if (g > 0) low = std::min(low, -scene_.gravity.dot(places_[i]) - g * solids_[i].shape.bounding_radius);
    }
    for (const std::size_t i : free_) {
      const double mass = scene_.bodies[i].mass;
      const Vector3d& velocity = scene_.bodies[i].motion.front().coefficients[1];
      scale_ += mass * 0.5 * velocity.squaredNorm();
      if (g > 0) scale_ += mass * (-scene_.gravity.dot(places_[i]) - low);
      momentum_ += mass * velocity;
      momenta_ += mass * velocity.norm();
    }
    double size = 0;
    for (const std::size_t i : free_) size = std::max(size, solids_[i].shape.bounding_radius);
    if (g > 0) lasting_ = lasting_gain * std::sqrt(size / g);
    if (!(scale_ > 0)) scale_ = 1;
    if (!(momenta_ > 0)) momenta_ = 1;
  }

  const Scene& scene_;
  Result& result_;
  std::vector<Solid> solids_;
  std::vector<Vector3d> places_;
  std::vector<std::size_t> free_;
  std::vector<char> skipped_;  ///< pairs that are not measured
  std::vector<char> touched_;
  std::vector<char> left_;  ///< have been above the region: a light body among heavy ones may be tossed over its sides
  std::vector<std::size_t> list_;
  double scale_ = 0;
  struct Sample {
    double time, energy;
  };
  std::deque<Sample> recent_;  ///< of the last few spans; no later one has less energy
  double lasting_ = 0;         ///< s
  double least_energy_ = std::numeric_limits<double>::infinity();
  Vector3d momentum_ = Vector3d::Zero();
  double momenta_ = 0;
};

}  // namespace

bool found(const Budget& budget, const Result& result) {
  return std::any_of(result.findings.begin(), result.findings.end(), [&](const Finding& finding) {
    return finding.what == budget.sought && finding.worst >= budget.least;
  });
}

Result measure(const Scene& scene, const Budget& budget) {
  Result result;
  Meter meter(scene, result);
  const double begin = seconds();
  const auto used = [&] { return seconds() - begin; };
  World<2> world({.response = collision::Response::elastic, .walls = scene.walls}, &meter);
  try {
    for (const Description& body : scene.bodies) world.add_body(body);
    bool stalls = false;
    for (int i = 1; !stalls && (i - 1) * sample < scene.seconds; ++i) {
      const double until = std::min(i * sample, scene.seconds);
      while (!stalls && world.step(until)) {
        ++result.events;
        meter.look_at_touched(world);
        stalls = result.events > budget.steps || ((result.events & 255) == 0 && used() > budget.seconds);
        if (!budget.sought.empty() && found(budget, result)) return result;
      }
      meter.look_at_all(world);
      if (i % audits_every != 0) continue;
      try {
        world.audit();
      } catch (const AuditFailure& failure) {
        meter.find("audit", world.now(), 1, failure.what());
      }
    }
    if (stalls) {
      meter.find("stall", world.now(), static_cast<double>(result.events),
                 std::to_string(result.events) + " steps, " + std::to_string(used()) + " s of CPU");
    }
  } catch (const std::exception& failure) {
    meter.find("throws", world.now(), 1, failure.what());
  }
  result.seconds = used();
  result.reached = world.now();
  result.kinetic = meter.kinetic(world);
  return result;
}

}  // namespace kds::piles
