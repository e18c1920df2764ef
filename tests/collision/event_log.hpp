// What the tests of the world share: scenes, a listener that writes everything down, and how two runs are compared.
#pragma once

#include "collision/world.hpp"
#include "kds/arithmetic/lattice.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <ostream>
#include <tuple>
#include <vector>

namespace kds::collision::tests {

using Eigen::Vector3d;

enum class Kind {
  contact,
  separation,
  overlap,
  wall,
  pair_began,
  pair_ended,
  rebound_suppressed,
  rests,
  wakes,
  timer,
  passes
};

inline const char* name(Kind kind) {
  constexpr std::array names{"contact",    "separation",         "overlap", "wall",  "pair_began",
                             "pair_ended", "rebound_suppressed", "rests",   "wakes", "timer",
                             "passes"};
  return names[static_cast<std::size_t>(kind)];
}

struct Event {
  Kind kind;
  BodyId a;
  BodyId b;  ///< of a wall event the wall
  Contact contact;

  double time() const { return contact.time; }

  friend bool operator==(const Event& x, const Event& y) {
    return x.kind == y.kind && x.a == y.a && x.b == y.b && x.contact.time == y.contact.time &&
           x.contact.point == y.contact.point && x.contact.normal == y.contact.normal &&
           x.contact.feature_a == y.contact.feature_a && x.contact.feature_b == y.contact.feature_b;
  }
  friend std::ostream& operator<<(std::ostream& out, const Event& e) {
    const auto precision = out.precision(17);
    out << name(e.kind) << ' ' << e.a << ' ' << e.b << " at " << e.time() << " point " << e.contact.point.transpose()
        << " normal " << e.contact.normal.transpose() << ' ' << e.contact.feature_a << ' ' << e.contact.feature_b;
    out.precision(precision);
    return out;
  }
};

/// Writes every event down, then calls `then`, if there is one.
template <int Degree>
struct EventLog final : WorldListener<Degree> {
  using W = World<Degree>;

  std::vector<Event> events;
  std::function<void(W&, const Event&)> then;

  void note(W& world, const Event& event) {
    events.push_back(event);
    if (then) then(world, event);
  }
  void contact(W& w, const PairEvent& e) override { note(w, {Kind::contact, e.a, e.b, e.contact}); }
  void separation(W& w, const PairEvent& e) override { note(w, {Kind::separation, e.a, e.b, e.contact}); }
  void overlap(W& w, const PairEvent& e) override { note(w, {Kind::overlap, e.a, e.b, e.contact}); }
  void wall(W& w, const WallEvent& e) override {
    note(w, {Kind::wall, e.body, static_cast<BodyId>(e.wall), e.contact});
  }
  void pair_began(W& w, BodyId a, BodyId b, double t) override { note(w, {Kind::pair_began, a, b, {.time = t}}); }
  void pair_ended(W& w, BodyId a, BodyId b, double t) override { note(w, {Kind::pair_ended, a, b, {.time = t}}); }
  void rebound_suppressed(W& w, const PairEvent& e) override {
    note(w, {Kind::rebound_suppressed, e.a, e.b, e.contact});
  }

  std::vector<Event> of(Kind kind) const {
    std::vector<Event> result;
    for (const Event& e : events) {
      if (e.kind == kind) result.push_back(e);
    }
    return result;
  }
  std::size_t count(Kind kind) const { return of(kind).size(); }
};

inline bool in_order_of_time(const std::vector<Event>& events) {
  const auto earlier = [](const Event& x, const Event& y) { return x.time() < y.time(); };
  return std::is_sorted(events.begin(), events.end(), earlier);
}

inline bool is_pair_event(const Event& e) { return e.kind == Kind::pair_began || e.kind == Kind::pair_ended; }

/// Sorted by time and bodies, to compare logs with what is found by other means. Broad phases are compared without it:
/// the order of what happens at one time does not depend on them.
inline std::vector<Event> sorted(std::vector<Event> events) {
  std::stable_sort(events.begin(), events.end(), [](const Event& x, const Event& y) {
    return std::tuple(x.time(), x.a, x.b, is_pair_event(x)) < std::tuple(y.time(), y.a, y.b, is_pair_event(y));
  });
  return events;
}

/// Beginnings and ends of pairs, without pairs that begin and end at one time: while the lists of the three axes go
/// through the events of one instant in turn, such pairs may or may not appear.
inline std::vector<Event> lasting_pairs(const std::vector<Event>& events) {
  std::vector<Event> result;
  std::copy_if(events.begin(), events.end(), std::back_inserter(result), is_pair_event);
  result = sorted(std::move(result));
  std::vector<Event> lasting;
  for (const Event& e : result) {
    const bool undone = !lasting.empty() && lasting.back().kind != e.kind && lasting.back().a == e.a &&
                        lasting.back().b == e.b && lasting.back().time() == e.time();
    if (undone) {
      lasting.pop_back();
    } else {
      lasting.push_back(e);
    }
  }
  return lasting;
}

inline const Vector3d zero = Vector3d::Zero();

/// `c0 + c1 t + c2 t^2`, the last only where the degree has it.
template <int Degree>
certificates::PointMotion<Degree> motion(const Vector3d& c0, const Vector3d& c1 = Vector3d::Zero(),
                                         const Vector3d& c2 = Vector3d::Zero(), double start = 0) {
  certificates::PointMotion<Degree> result{{c0, c1}};
  if constexpr (Degree >= 2) result.coefficients[2] = c2;
  result.start = start;
  return result;
}

template <int Degree>
BodyDescription<Degree> body(const Shape& shape, const certificates::PointMotion<Degree>& path, double mass = 1) {
  BodyDescription<Degree> result;
  result.shape = shape;
  result.motion = {path};
  result.mass = mass;
  return result;
}

template <int Degree>
BodyDescription<Degree> fixed_body(const Shape& shape, const certificates::PointMotion<Degree>& path) {
  BodyDescription<Degree> result = body<Degree>(shape, path);
  result.fixed = true;
  return result;
}

template <int Degree>
BodyDescription<Degree> ball(double radius, const Vector3d& c0, const Vector3d& c1 = Vector3d::Zero(),
                             const Vector3d& c2 = Vector3d::Zero()) {
  return body<Degree>(Sphere{radius}, motion<Degree>(c0, c1, c2));
}

template <int Degree>
BodyDescription<Degree> box(const Vector3d& half, const Vector3d& c0, const Vector3d& c1 = Vector3d::Zero(),
                            const Vector3d& c2 = Vector3d::Zero()) {
  return body<Degree>(Box{half}, motion<Degree>(c0, c1, c2));
}

template <int Degree>
struct Scene {
  std::vector<BodyDescription<Degree>> bodies;
  double end_time = 1;
};

/// How a world is driven.
struct Drive {
  double polls_per_second = 0;  ///< 0: one call up to the end
  bool audit = false;           ///< after every step
};

template <int Degree>
std::vector<Event> run(const Scene<Degree>& scene, const WorldOptions& options, const Drive& drive = {}) {
  EventLog<Degree> log;
  World<Degree> world(options, &log);
  for (const auto& description : scene.bodies) world.add_body(description);
  const double end = options.start_time + scene.end_time;
  if (drive.audit) {
    while (world.step(end)) world.audit();
    world.audit();
  } else if (drive.polls_per_second > 0) {
    for (double k = 1;; ++k) {
      const double t = options.start_time + k / drive.polls_per_second;
      if (!(t < end)) break;
      world.advance_to(t);
    }
  }
  world.advance_to(end);
  return log.events;
}

}  // namespace kds::collision::tests
