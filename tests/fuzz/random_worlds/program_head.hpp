// What printed programs begin with: the part that is the same for all.
#pragma once

namespace kds::fuzz {

inline constexpr const char* program_head = R"(
#include "collision/shapes/compound.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"

#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

using namespace kds::collision;
using Eigen::Vector3d;
using Motion = kds::certificates::PointMotion<Degree>;
using Log = std::vector<std::string>;

struct Player : WorldListener<Degree> {
  using W = World<Degree>;
  WorldOptions options;
  BroadPhaseKind load_into = BroadPhaseKind::all_pairs;
  double length = 1;  // unit of length
  int stops = 0, save_every = 0, steps = 0;
  bool saves_between_calls = false, runs_ahead = false, budgets = false, fixed_bodies_move = false, swapped = false;
  std::unique_ptr<W> world;
  std::map<int, BodyId> id;      // by number of the body
  std::map<BodyId, int> number;  // by id, the last one
  Log log;
  std::map<std::tuple<std::string, int, int>, int> counts;
  std::function<void(const std::string&, int, int, int, const Contact&)> react = [](auto&&...) {};

  static unsigned long long shown(BodyId body) { return body; }
  void note(const char* kind, BodyId a, BodyId b, int number_b, const Contact& c) {
    char line[400];
    std::snprintf(line, sizeof line,
                  "%-12s %llu %llu at %.17g (%a) point %.17g %.17g %.17g normal %.17g %.17g %.17g %s %s", kind,
                  shown(a), shown(b), c.time, c.time, c.point[0], c.point[1], c.point[2], c.normal[0], c.normal[1],
                  c.normal[2], to_string(c.feature_a).c_str(), to_string(c.feature_b).c_str());
    log.push_back(line);
    react(kind, number[a], number_b, counts[{kind, number[a], number_b}]++, c);
  }
  void pair(const char* kind, const PairEvent& e) { note(kind, e.a, e.b, number[e.b], e.contact); }
  void contact(W&, const PairEvent& e) override { pair("contact", e); }
  void separation(W&, const PairEvent& e) override { pair("separation", e); }
  void overlap(W&, const PairEvent& e) override { pair("overlap", e); }
  void rebound_suppressed(W&, const PairEvent& e) override { pair("rebound_suppressed", e); }
  void rests(W&, const PairEvent& e) override { pair("rests", e); }
  void wakes(W&, const PairEvent& e) override { pair("wakes", e); }
  void passes(W&, const PairEvent& e) override { pair("passes", e); }
  void at_wall(const char* kind, const WallEvent& e) { note(kind, e.body, e.wall, e.wall, e.contact); }
  void wall(W&, const WallEvent& e) override { at_wall("wall", e); }
  void rebound_suppressed_at_wall(W&, const WallEvent& e) override { at_wall("rebound_suppressed_at_wall", e); }
  void rests_at_wall(W&, const WallEvent& e) override { at_wall("rests_at_wall", e); }
  void wakes_at_wall(W&, const WallEvent& e) override { at_wall("wakes_at_wall", e); }
  void pair_began(W&, BodyId a, BodyId b, double t) override { note("pair_began", a, b, number[b], {.time = t}); }
  void pair_ended(W&, BodyId a, BodyId b, double t) override { note("pair_ended", a, b, number[b], {.time = t}); }
  bool hears_pieces() const override { return true; }
  void moved(W& w, BodyId a) override { note("moved", a, 0, number[0], {.time = w.now()}); }
  void piece(W& w, BodyId a) override { note("piece", a, 0, number[0], {.time = w.now()}); }
  void timer(W& w, TimerId timer) override {
    log.push_back("timer " + std::to_string(timer));
    react("timer", static_cast<int>(timer), number[0], counts[{"timer", static_cast<int>(timer), number[0]}]++,
          {.time = w.now()});
  }

  Motion path(double start, Vector3d place, Vector3d velocity, [[maybe_unused]] Vector3d half_acceleration) {
    Motion m;
    m.start = world->now() + start;
    m.coefficients[0] = length * place, m.coefficients[1] = length * velocity;
    if constexpr (Degree == 2) m.coefficients[2] = length * half_acceleration;
    return m;
  }
  bool there(int n) { return id.count(n) != 0; }
  bool moves(int n) {
    return there(n) && !world->attached_to(id[n]) && (fixed_bodies_move || !world->fixed(id[n]));
  }
  bool under_way(int n) { return there(n) && world->motion(id[n]).start <= world->now(); }
  void add(int n, const BodyDescription<Degree>& d) { number[id[n] = world->add_body(d)] = n; }
  void attach(int n, BodyDescription<Degree> d, int owner) {
    if (!there(owner) || world->attached_to(id[owner])) return;
    d.attached_to = id[owner], d.sensor = true, d.motion = {};
    add(n, d);
  }
  void remove(int n) {
    if (!there(n)) return;
    world->remove_body(id[n]);
    std::erase_if(id, [&](const auto& one) { return !world->contains(one.second); });
  }
  void move(int n, const Motion& to) { if (moves(n)) world->update_motion(id[n], to); }
  void turn_back(int n) {
    if (!moves(n) || !under_way(n)) return;
    Motion back = world->free_motion(id[n]).restarted(world->now());
    back.coefficients[1] = -back.coefficients[1];
    move(n, back);
  }
  void keep(int n) { if (moves(n) && under_way(n)) move(n, Motion(world->motion(id[n]))); }
  void follow(int n, int other) { if (under_way(other)) move(n, Motion(world->motion(id[other]))); }
  void away_and_back(int n, const Motion& away) {
    if (!moves(n) || !under_way(n)) return;
    const Motion kept = world->motion(id[n]);
    move(n, away), move(n, kept);
  }
  void push_off(int n, const Vector3d& velocity) {
    if (!moves(n)) return;
    Motion m = world->free_motion(id[n]).restarted(world->now());
    m.coefficients[1] = length * velocity;
    move(n, m);
  }
  void filter(int n, std::uint32_t category, std::uint32_t with) {
    if (there(n)) world->set_filter(id[n], category, with);
  }
  void group(int n, std::uint32_t group) { if (there(n)) world->set_group(id[n], group); }
  void ignore(int n, int other, bool ignored) {
    if (n != other && there(n) && there(other)) world->ignore_pair(id[n], id[other], ignored);
  }
  void weigh(int n, double mass) { if (there(n) && !world->fixed(id[n])) world->set_mass(id[n], mass); }
  void append(int n, const Motion& piece) {
    if (!moves(n)) return;
    try {
      world->append_motion(id[n], {&piece, 1});
    } catch (const std::invalid_argument&) {
    }
  }
  void ring(double seconds) { world->set_timer(world->now() + seconds); }
  void fail() { throw std::runtime_error("a callback throws"); }
  void save_and_load() {
    const auto saved = kds::save(*world);
    if (runs_ahead) {
      const auto kept = std::tuple(id, number, log, counts);
      const double limit = world->now() + 0.5;
      try {
        for (int i = 0; i < 6 && world->step(limit); ++i) continue;
      } catch (const std::exception&) {
      }
      std::tie(id, number, log, counts) = kept;
      return kds::restore(saved, *world);
    }
    WorldOptions other = options;
    if (!swapped) other.broad_phase = load_into;
    swapped = !swapped;
    if (other.broad_phase != BroadPhaseKind::kinetic_sap) other.kdop = 6;
    if (other.broad_phase == BroadPhaseKind::sap && other.rate == 0) other.rate = 8;
    auto loaded = std::make_unique<W>(other, this);
    kds::restore(saved, *loaded);
    world = std::move(loaded);
  }
  void step_up_to(double limit) {
    while (budgets ? !world->advance_for(0, limit) : world->step(limit)) {
      if (save_every != 0 && ++steps % save_every == 0) save_and_load();
    }
  }
  void advance(double seconds) {
    const double from = world->now();
    try {
      for (int part = 1; part <= stops; ++part) step_up_to(from + seconds * part / (stops + 1));
      step_up_to(from + seconds);
    } catch (const std::exception& error) {
      log.push_back(error.what());
    }
    log.push_back("  now " + std::to_string(world->now()));
    for (const auto& [n, body] : id) {
      char line[200];
      const Vector3d x = world->motion(body).position(world->now()), v = world->motion(body).velocity(world->now());
      std::snprintf(line, sizeof line, "  body %d (id %llu) at %a %a %a velocity %a %a %a", n, shown(body), x[0], x[1],
                    x[2], v[0], v[1], v[2]);
      log.push_back(line);
    }
  }
  void between() { if (saves_between_calls) save_and_load(); }
  void begin() { world = std::make_unique<W>(options, this); }
};
)";

}  // namespace kds::fuzz
