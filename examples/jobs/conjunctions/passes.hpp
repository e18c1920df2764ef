// The pairs that are near each other, and how near they come.
#pragma once

#include "certificates/ball_separation.hpp"
#include "collision/queries/approach.hpp"
#include "examples/jobs/conjunctions/conjunction.hpp"
#include "examples/jobs/conjunctions/trajectory.hpp"
#include "kds/roots/failure_time.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <utility>

namespace conjunctions {

/// Two objects that are farther apart than a distance: a certificate, whose failure time is an entry and whose recovery
/// time is an exit.
inline kds::certificates::BallSeparation<5> farther_apart(const Path& a, const Path& b, double distance) {
  return {a, b, distance / 2, distance / 2};
}

/// From entry to exit, over any number of pieces.
class Passes {
 public:
  Passes(double distance, const std::function<void(const Conjunction&)>& found) : distance_(distance), found_(found) {}

  bool has(std::size_t a, std::size_t b) const { return near_.contains({a, b}); }

  void begin(std::size_t a, std::size_t b, double t, bool at_start) {
    Conjunction& conjunction = near_[{a, b}];
    conjunction.a = a, conjunction.b = b;
    conjunction.entry = t;
    conjunction.distance = kds::never;
    conjunction.near_at_start = at_start;
  }

  /// The paths of a pair that is near at `from` are these until `until`: how near does it come meanwhile? Not beyond
  /// its exit: there it may be on its way to another conjunction. Returns the exit, or `never`.
  double look(std::size_t a, std::size_t b, const Path& path_a, const Path& path_b, double from, double until) {
    Conjunction& conjunction = near_.at({a, b});
    const double exit = kds::recovery_time(farther_apart(path_a, path_b, distance_), from, until);
    const auto approach = kds::collision::closest_approach(path_a, path_b, from, std::min(exit, until));
    if (approach.distance < conjunction.distance) {
      const double t = conjunction.closest = approach.time;
      conjunction.distance = approach.distance;
      conjunction.speed = (path_b.velocity(t) - path_a.velocity(t)).norm();
      conjunction.height = path_a.position(t).norm() - earth_radius;
    }
    return exit;
  }

  void end(std::size_t a, std::size_t b, double t, bool at_end = false) {
    const auto pass = near_.find({a, b});
    pass->second.exit = t;
    pass->second.near_at_end = at_end;
    found_(pass->second);
    near_.erase(pass);
  }

  /// Calls visit(a, b) for each pair that is near.
  template <class Visit>
  void visit(Visit&& visit) const {
    for (const auto& [pair, conjunction] : near_) visit(pair.first, pair.second);
  }

  void end_all(double t) {
    while (!near_.empty()) end(near_.begin()->first.first, near_.begin()->first.second, t, true);
  }

 private:
  double distance_;
  const std::function<void(const Conjunction&)>& found_;
  std::map<std::pair<std::size_t, std::size_t>, Conjunction> near_;
};

}  // namespace conjunctions
