// Balls that fall on a level of many boxes and bounce through it: the boxes as one fixed compound, and as fixed bodies.
#include "collision/shapes/compound.hpp"
#include "collision/world.hpp"
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/speed/report.hpp"
#include "tests/benchmarks/thread_time.hpp"
#include "tests/support/random_numbers.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace speed {
namespace {

using Eigen::Vector3d;
using kds::benchmarks::open_csv;
using kds::benchmarks::tell;
using kds::collision::BodyDescription;
using kds::collision::Box;
using kds::collision::CompoundPart;
using kds::collision::World;

constexpr double pitch = 2;
constexpr std::size_t balls = 1000;

/// Towers of several heights, side by side on a square, from the origin on.
std::vector<CompoundPart> towers(std::size_t side) {
  kds::tests::Random random(5);
  std::vector<CompoundPart> parts;
  for (std::size_t i = 0; i < side * side; ++i) {
    const double height = random.between(0.5, 4);
    const Vector3d place(pitch * static_cast<double>(i % side), pitch * static_cast<double>(i / side), height);
    parts.push_back({Box{{0.45 * pitch, 0.45 * pitch, height}}, place});
  }
  return parts;
}

/// What moves through the level: balls that do not meet each other.
BodyDescription<2> falling_ball(kds::tests::Random& random, double extent) {
  BodyDescription<2> ball{.shape = kds::collision::Sphere{0.3}};
  const double x = random.between(0, extent), y = random.between(0, extent), z = random.between(9, 20);
  const double u = random.between(-3, 3), v = random.between(-3, 3);
  ball.motion = {World<2>::Motion{{Vector3d(x, y, z), Vector3d(u, v, 0), Vector3d(0, 0, -0.5 * 9.81)}}};
  ball.restitution = 0.75;
  ball.category = 2;
  ball.collides_with = 1;
  return ball;
}

struct Measured {
  double set_up = kds::never, run = kds::never;  ///< s
  kds::collision::WorldCounters counters;
};

/// Three seconds; the least times of some rounds.
Measured measure(std::size_t side, bool as_one, int rounds) {
  const double extent = pitch * static_cast<double>(side - 1);
  Measured best;
  for (int round = 0; round < rounds; ++round) {
    kds::collision::WorldOptions options{.response = kds::collision::Response::elastic};
    options.walls = kds::collision::Walls{{-pitch, -pitch, -2}, {extent + pitch, extent + pitch, 30}, 0.75};
    World<2> world(options);
    const double begin = kds::benchmarks::thread_seconds();
    if (as_one) {
      BodyDescription<2> level{.shape = kds::collision::compound(towers(side)), .fixed = true};
      level.motion = {World<2>::Motion{}};
      world.add_body(level);
    } else {
      for (const CompoundPart& part : towers(side)) {
        BodyDescription<2> tower{.shape = part.shape, .fixed = true};
        tower.motion = {World<2>::Motion{{part.position, Vector3d::Zero(), Vector3d::Zero()}}};
        world.add_body(tower);
      }
    }
    kds::tests::Random random(3);
    for (std::size_t i = 0; i < balls; ++i) world.add_body(falling_ball(random, extent));
    world.advance_to(0);
    const double ready = kds::benchmarks::thread_seconds();
    world.advance_to(3);
    best.set_up = std::min(best.set_up, ready - begin);
    best.run = std::min(best.run, kds::benchmarks::thread_seconds() - ready);
    best.counters = world.counters();
    if (best.run > 5) break;  // long enough for one round
  }
  return best;
}

}  // namespace

std::vector<Target> measure_compounds(const Settings& settings) {
  auto file = open_csv(settings.folder, "speed-compounds.csv");
  tell(file, "parts,as,contacts,us_a_contact,ms_set_up\n");
  std::vector<std::size_t> sides{3, 30};
  if (!settings.quick) sides.push_back(300);
  std::vector<Target> targets;
  double first = 0;
  for (const std::size_t side : sides) {
    for (const bool as_one : {true, false}) {
      const Measured measured = measure(side, as_one, settings.quick ? 1 : 3);
      const double contacts = static_cast<double>(measured.counters.contacts + measured.counters.wall_contacts);
      const double a_contact = 1e6 * measured.run / contacts;
      tell(file, "%zu,%s,%.0f,%.2f,%.2f\n", side * side, as_one ? "one compound" : "fixed bodies", contacts, a_contact,
           1e3 * measured.set_up);
      if (as_one && first == 0) first = a_contact;
      if (!as_one || side != sides.back()) continue;
      targets.push_back({"auto: CPU a contact with a compound of " + std::to_string(side * side) +
                             " parts over that with one of " + std::to_string(sides.front() * sides.front()),
                         a_contact / first, '<', 10, "x"});
    }
  }
  return targets;
}

}  // namespace speed
