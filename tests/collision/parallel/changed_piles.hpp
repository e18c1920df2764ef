// Piles in domains that a listener changes, compared with one world whose listener does the same.
#pragma once

#include "tests/collision/parallel/compared_runs.hpp"
#include "tests/collision/random_scenes.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace kds::collision::tests {

/// What a listener does at the k-th event: a body comes, on what has met, goes, jumps, or is struck; a floor moves; or
/// properties of a body change.
template <int Degree>
void change_pile(World<Degree>& world, const Event& event, std::uint64_t seed, std::size_t k, std::size_t bodies) {
  using Vector = Eigen::Vector3d;
  Random random(seed * 100003 + k);
  BodyId id = random.one_in(4) ? random.below(bodies + 3) : event.a;
  if (!is_about_wall(event) && event.kind != Kind::wall && event.kind != Kind::timer && random.one_in(2) &&
      id == event.a)
    id = event.b;
  const double t = world.now();
  const int what = random.integer(0, 9);
  if (what == 9) {
    world.set_timer(t + random.between(0, 0.3));
    return;
  }
  if (!world.contains(id)) return;
  const Vector place = world.motion(id).position(std::max(t, world.motion(id).start));
  const double x = random.between(-1, 1), y = random.between(-1, 1), z = random.between(-1, 1);
  const Vector some(x, y, z), gravity(0, 0, -5);
  if (what == 0) {
    const Vector from = place + Vector(0, 0, 1) + (random.one_in(2) ? Vector(Vector::Zero()) : some);
    const double radius = 0.25 * random.integer(1, 2);
    auto added = ball<Degree>(radius, from, some, gravity);
    added.restitution = random.one_in(2) ? 0 : 0.5;
    added.motion = {motion<Degree>(from, some, gravity, t)};
    world.add_body(added);
    return;
  }
  if (world.attached_to(id)) return;
  const bool fixed = world.fixed(id);
  if (what <= 2 && (!fixed || random.one_in(4))) return world.remove_body(id);
  if (what == 3) return world.set_restitution(id, 0.5 * random.integer(0, 2));
  if (what == 4 && !fixed) return world.set_mass(id, random.between(0.5, 3));
  if (what == 5) return world.set_filter(id, 1, random.one_in(2) ? 2 : 3);
  if (what == 6 && event.b != event.a && world.contains(event.a) && event.kind == Kind::contact &&
      world.contains(event.b))
    return world.ignore_pair(event.a, event.b);
  if (fixed) {
    const Vector up(0, 0, 0.25 * random.integer(-2, 2));
    const auto first = motion<Degree>(place, up, Vector::Zero(), t),
               second = motion<Degree>(place + 0.125 * up, Vector::Zero(), Vector::Zero(), t + 0.125);
    const std::vector<certificates::PointMotion<Degree>> pieces{first, second};
    return world.update_motion(id, pieces);
  }
  world.update_motion(id, motion<Degree>(random.one_in(2) ? place : Vector(place + 4 * some), 3 * some, gravity, t));
}

/// As compare_runs(), of one process whose listener makes changes at some events, and which is saved on the way and
/// goes on from that. `change`: called with the world, the event, the seed, the number of the event, and how many
/// bodies there were. Returns how many changes it has asked for.
template <class Motion, class Change>
std::uint64_t compare_changed_by(const Staging<Motion>& scene, Manner manner, std::uint64_t seed, Seen& seen,
                                 const Change& change) {
  manner.processes = 1;
  std::ostringstream how;
  how << scene.what << ", " << manner.parallel.threads << " threads, " << manner.parallel.domains << " domains, halo "
      << manner.parallel.halo << ", longest window " << manner.parallel.longest_window << ", polls " << manner.polls;
  const std::string what = how.str();
  const std::uint64_t one_in = seed % 3 == 0 ? 4 : seed % 3 == 1 ? 15 : 60;
  const double until = 0.7 * scene.end_time;
  const auto changes_at = [=](std::size_t k, double t) { return t < until && Random(seed + 77 * k).one_in(one_in); };
  WholeLog<Motion> right;
  BasicWorld<Motion> one(scene.options, &right);
  scene.fill(one);
  const std::size_t bodies = one.size();
  right.then = [&](BasicWorld<Motion>& world) {
    const std::size_t k = right.events.size();
    if (changes_at(k, world.now())) change(world, right.events.back(), seed, k, bodies);
  };
  one.advance_to(scene.end_time);
  std::uint64_t asked = 0;
  DividedLog log;
  auto divided = std::make_unique<BasicParallelWorld<Motion>>(scene.options, manner.parallel, &log);
  scene.fill(divided->whole());
  log.then = [&](const Event& event) {
    const std::size_t k = log.events.size();
    if (!changes_at(k, event.contact.time)) return;
    ++asked;
    divided->change([=](BasicWorld<Motion>& world) { change(world, event, seed, k, bodies); });
  };
  Random random(seed);
  StateInParts state(1);
  std::size_t before = 0;
  bool saved = false;
  for (std::size_t poll = 1; poll <= manner.polls; ++poll) {
    const double t = scene.end_time * static_cast<double>(poll) / static_cast<double>(manner.polls);
    divided->advance_to(t);
    if (poll == manner.polls) break;
    if (t >= until) {
      before = log.events.size(), saved = true;
      state.save(*divided, 0, 1 + random.below(20));
    }
    if (random.one_in(2)) {
      const bool parts = random.one_in(2);
      StateInParts way(1);
      Snapshot whole;
      if (parts)
        way.save(*divided, 0, 1 + random.below(20));
      else
        whole = save(*divided);
      auto other = manner.parallel;
      other.domains = 2 + random.below(5), other.halo = random.between(0.5, 3);
      divided = std::make_unique<BasicParallelWorld<Motion>>(scene.options, other, &log);
      const auto blocks = way.blocks();
      if (parts)
        divided->load_parts(way.rest, share_of(blocks, 0, 1));
      else
        restore(whole, *divided);
    }
  }
  require_same(right.events, log.events, what);
  divided->whole().audit();
  seen.add(divided->counters(), log.events);
  if (!saved) return asked;
  const std::vector<Event> later(right.events.begin() + static_cast<std::ptrdiff_t>(before), right.events.end());
  const std::size_t others = 1 + seed % 3;
  const auto blocks = state.blocks();
  run_by(others, [&](Processes* processes, std::size_t rank) {
    DividedLog told;
    BasicParallelWorld<Motion> world(scene.options, manner.parallel, &told, processes);
    world.load_parts(state.rest, share_of(blocks, rank, others));
    world.advance_to(scene.end_time);
    if (rank == 0) require_same(later, told.events, what + ", gone on");
    world.whole().audit();
  });
  return asked;
}

/// Of some seeds; more by hand: each_seed().
template <class Maker, class Change>
std::uint64_t compare_seeds_changed_by(const char* variable, std::initializer_list<Seeds> seeds, Seen& seen,
                                       const Change& change) {
  std::uint64_t asked = 0;
  each_seed(variable, seeds, [&](std::uint64_t seed, std::size_t most_domains) {
    Maker maker(seed);
    const auto scene = maker.scene();
    asked += compare_changed_by(scene, maker.manner(most_domains), seed, seen, change);
  });
  return asked;
}

template <int Degree, class Maker>
std::uint64_t compare_seeds_changed(const char* variable, std::initializer_list<Seeds> seeds, Seen& seen) {
  return compare_seeds_changed_by<Maker>(variable, seeds, seen, change_pile<Degree>);
}

}  // namespace kds::collision::tests
