// Ends of segments that grow, by a simulation in rational numbers; and scenes of them, random and degenerate.
#pragma once

#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "structures/growing_segments.hpp"
#include "tests/structures/random_values.hpp"
#include "tests/support/exact_rational.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace kds::tests::growing {

using oracle::Rational;
using structures::GrowingEnd;
using structures::GrowingSegmentsRule;

inline GrowingEnd end_at(double x, double y, double vx, double vy, double start = 0) {
  return {{{Polynomial<1>{{x, vx}}, Polynomial<1>{{y, vy}}}, start}};
}
inline GrowingEnd line_at(double x, double y, double vx, double vy) {
  GrowingEnd line = end_at(x, y, vx, vy);
  line.whole = true;
  return line;
}

/// What has been done to a set of ends, and when each stops by the definition.
class Definition {
 public:
  using Vector = std::array<Rational, 2>;

  void insert(Id id, const GrowingEnd& end, double now) {
    known_.push_back({id, end, now, std::nullopt, std::nullopt});
  }
  void remove(Id id, double now) { at(id).removed = now; }

  /// Takes all ends from their beginnings to a time.
  void follow(double now) {
    std::vector<Meeting> meetings;
    for (std::size_t i = 0; i < known_.size(); ++i) {
      known_[i].stop.reset();
      for (std::size_t j = 0; j < known_.size(); ++j) {
        const Known &a = known_[i], &b = known_[j];
        if (i == j || a.end.whole) continue;
        std::optional<Meeting> found = meeting(a.end, b.end);
        if (!found || found->time <= oracle::rational(std::max({a.inserted, b.inserted, a.end.path.start}))) continue;
        if (found->time > oracle::rational(std::min({now, a.removed.value_or(now), b.removed.value_or(now)}))) continue;
        if (found->passed && (*found->passed > found->time || *found->passed < oracle::rational(b.end.path.start)))
          continue;
        found->end = i;
        found->other = j;
        meetings.push_back(*found);
      }
    }
    std::stable_sort(meetings.begin(), meetings.end(),
                     [](const Meeting& a, const Meeting& b) { return a.time < b.time; });
    for (const Meeting& meeting : meetings) {
      const std::optional<Rational>& other_stop = known_[meeting.other].stop;
      if (known_[meeting.end].stop) continue;
      if (meeting.passed && other_stop && *other_stop < *meeting.passed) continue;
      known_[meeting.end].stop = meeting.time;
    }
  }

  /// When an end that is there has stopped, by the time that follow() was called for.
  const std::optional<Rational>& exact_stop(Id id) { return at(id).stop; }
  /// The least double from then on.
  std::optional<double> stop(Id id) {
    const std::optional<Rational>& time = exact_stop(id);
    if (!time) return std::nullopt;
    double rounded = oracle::approximate(*time);
    while (oracle::rational(rounded) < *time) rounded = std::nextafter(rounded, never);
    while (oracle::rational(std::nextafter(rounded, -never)) >= *time) rounded = std::nextafter(rounded, -never);
    return rounded;
  }

  static Vector velocity(const GrowingEnd& end) {
    return {oracle::rational(end.path.coordinate[0].c[1]), oracle::rational(end.path.coordinate[1].c[1])};
  }
  /// Where it would be at time 0.
  static Vector origin(const GrowingEnd& end) {
    const Rational start = oracle::rational(end.path.start);
    const Vector v = velocity(end);
    return {oracle::rational(end.path.coordinate[0].c[0]) - v[0] * start,
            oracle::rational(end.path.coordinate[1].c[0]) - v[1] * start};
  }

 private:
  struct Known {
    Id id;
    GrowingEnd end;
    double inserted;
    std::optional<double> removed;
    std::optional<Rational> stop;
  };
  /// At `time` an end comes to where the line of another is, which has come there at `passed`, or is there always.
  struct Meeting {
    Rational time;
    std::optional<Rational> passed;
    std::size_t end, other;
  };

  Known& at(Id id) {
    return *std::find_if(known_.begin(), known_.end(), [&](const Known& k) { return k.id == id && !k.removed; });
  }
  static Rational cross(const Vector& a, const Vector& b) { return a[0] * b[1] - a[1] * b[0]; }

  static std::optional<Meeting> meeting(const GrowingEnd& a, const GrowingEnd& b) {
    const Vector v = velocity(a), w = velocity(b), p = origin(a), q = origin(b), apart{q[0] - p[0], q[1] - p[1]};
    const Rational area = cross(v, w);
    if (area.sign() != 0) {
      const Rational time = cross(apart, w) / area, passed = cross(apart, v) / area;
      return Meeting{time, b.whole ? std::nullopt : std::optional(passed), 0, 0};
    }
    if (b.whole || (v[0].sign() == 0 && v[1].sign() == 0) || cross(apart, v).sign() != 0) return std::nullopt;
    const std::size_t d = v[0].sign() != 0 ? 0 : 1;
    const Rational start = oracle::rational(b.path.start);
    if (v[d].sign() * w[d].sign() < 0) {
      const Rational time = apart[d] / (v[d] - w[d]);
      return Meeting{time, time, 0, 0};
    }
    return Meeting{(q[d] + w[d] * start - p[d]) / v[d], start, 0, 0};
  }

  std::vector<Known> known_;
};

enum class Scene { generic, lattice, crossroads, coarse_clock };

inline double beginning(Scene scene) { return scene == Scene::coarse_clock ? 0x1p43 : 0; }

inline double span(Scene scene) { return scene == Scene::coarse_clock ? 0x1p-9 : 3; }

inline GrowingEnd random_end(Random& random, Scene scene, double now) {
  GrowingEnd end;
  end.path.start = random.one_in(4) ? now + span(scene) * random.integer(0, 8) / 8 : now;
  for (Polynomial<1>& x : end.path.coordinate) {
    switch (scene) {
      case Scene::generic:
        x.c[0] = random.between(-10, 10);
        x.c[1] = random.between(-1, 1);
        break;
      case Scene::lattice:
        x.c[0] = random.integer(-6, 6);
        x.c[1] = random.integer(-2, 2);
        break;
      case Scene::crossroads:
        x.c[0] = random.integer(-4, 4);
        x.c[1] = 0;
        break;
      case Scene::coarse_clock:  // a few doubles are all the times at which anything happens
        x.c[0] = random.integer(-512, 512) * 0x1p-18;
        x.c[1] = random.integer(-64, 64) * 0x1p-6;
        break;
    }
  }
  if (scene == Scene::crossroads) end.path.coordinate[random.below(2)].c[1] = random.one_in(2) ? 1 : -1;
  end.whole = random.one_in(12);
  return end;
}

struct Structure {
  MovingSet<GrowingEnd> ends{};
  Kinetic<GrowingSegmentsRule> segments;
  Simulator<Kinetic<GrowingSegmentsRule>> simulator;
  Definition definition{};

  explicit Structure(double begin) : segments(ends, begin), simulator(begin, segments) {}

  void insert(Id id, const GrowingEnd& end) {
    ends.insert(id, end, simulator.now());
    definition.insert(id, end, simulator.now());
  }
  void remove(Id id) {
    ends.remove(id, simulator.now());
    definition.remove(id, simulator.now());
  }
  /// Runs, and gives the number of ends that have not stopped when they should, or have though they should not.
  int run_to(double t) {
    while (simulator.step(t)) simulator.audit();
    simulator.advance_to(t);
    definition.follow(t);
    int wrong = 0;
    for (const Id id : ends.ids()) {
      wrong += segments.rule().stop_time(id) != definition.stop(id).value_or(never);
      wrong += (segments.rule().stopped_by(id) == nobody) != (segments.rule().stop_time(id) == never);
    }
    return wrong;
  }
};

}  // namespace kds::tests::growing
