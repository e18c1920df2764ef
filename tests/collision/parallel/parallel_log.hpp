// The events of a ParallelWorld, and of the World with which it is compared.
#pragma once

#include "collision/parallel/parallel_world.hpp"
#include "tests/collision/event_log.hpp"

#include <cstddef>
#include <functional>
#include <vector>

namespace kds::collision::tests {

/// In the logs of these tests the place of a body on which another one rests, if that is a wall.
inline constexpr BodyId first_wall = ~BodyId{0} - 5;
inline Event about_wall(Kind kind, const WallEvent& e) {
  return {kind, e.body, first_wall + static_cast<BodyId>(e.wall), e.contact};
}
inline bool is_about_wall(const Event& e) { return e.kind != Kind::wall && e.b >= first_wall; }

/// Writes down what EventLog writes down, then calls `then`, if there is one.
struct ParallelLog : ParallelListener {
  std::vector<Event> events;
  std::function<void(const Event&)> then;

  void note(const Event& event) {
    events.push_back(event);
    if (then) then(event);
  }
  void contact(const PairEvent& e) override { note({Kind::contact, e.a, e.b, e.contact}); }
  void separation(const PairEvent& e) override { note({Kind::separation, e.a, e.b, e.contact}); }
  void overlap(const PairEvent& e) override { note({Kind::overlap, e.a, e.b, e.contact}); }
  void wall(const WallEvent& e) override { note({Kind::wall, e.body, static_cast<BodyId>(e.wall), e.contact}); }
  void rebound_suppressed(const PairEvent& e) override { note({Kind::rebound_suppressed, e.a, e.b, e.contact}); }
  void timer(TimerId timer, double time) override { note({Kind::timer, timer, 0, {.time = time}}); }
};

/// The same of a World, and all that a heap tells.
template <class Motion>
struct WholeLog final : BasicWorldListener<Motion> {
  using W = BasicWorld<Motion>;

  std::vector<Event> events;
  std::function<void(W&)> then;

  void note(W& world, const Event& event) {
    events.push_back(event);
    if (then) then(world);
  }
  void contact(W& w, const PairEvent& e) override { note(w, {Kind::contact, e.a, e.b, e.contact}); }
  void separation(W& w, const PairEvent& e) override { note(w, {Kind::separation, e.a, e.b, e.contact}); }
  void overlap(W& w, const PairEvent& e) override { note(w, {Kind::overlap, e.a, e.b, e.contact}); }
  void wall(W& w, const WallEvent& e) override {
    note(w, {Kind::wall, e.body, static_cast<BodyId>(e.wall), e.contact});
  }
  void rebound_suppressed(W& w, const PairEvent& e) override {
    note(w, {Kind::rebound_suppressed, e.a, e.b, e.contact});
  }
  void rebound_suppressed_at_wall(W& w, const WallEvent& e) override {
    note(w, about_wall(Kind::rebound_suppressed, e));
  }
  void rests(W& w, const PairEvent& e) override { note(w, {Kind::rests, e.a, e.b, e.contact}); }
  void wakes(W& w, const PairEvent& e) override { note(w, {Kind::wakes, e.a, e.b, e.contact}); }
  void rests_at_wall(W& w, const WallEvent& e) override { note(w, about_wall(Kind::rests, e)); }
  void wakes_at_wall(W& w, const WallEvent& e) override { note(w, about_wall(Kind::wakes, e)); }
  void passes(W& w, const PairEvent& e) override { note(w, {Kind::passes, e.a, e.b, e.contact}); }
  void timer(W& w, TimerId timer) override { note(w, {Kind::timer, timer, 0, {.time = w.now()}}); }
};

/// The first event in which two logs differ, or the length of both.
inline std::size_t first_difference(const std::vector<Event>& a, const std::vector<Event>& b) {
  const std::size_t both = std::min(a.size(), b.size());
  for (std::size_t i = 0; i < both; ++i) {
    if (!(a[i] == b[i])) return i;
  }
  return both;
}

}  // namespace kds::collision::tests
