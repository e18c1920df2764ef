// Equal balls in equilibrium, the setting of molecular dynamics: what a contact costs.
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/speed/methods.hpp"
#include "tests/benchmarks/speed/race.hpp"
#include "tests/benchmarks/speed/report.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace speed {
namespace {

using kds::benchmarks::open_csv;
using kds::benchmarks::tell;

/// Contacts a ball has in a second: the collision rate of hard spheres of radius 1 and variance 1 of each velocity
/// component, with the pair correlation of Carnahan and Starling at contact.
double contact_rate(double packing) {
  const double density = packing / (4.0 / 3.0 * M_PI);
  const double contact = (1 - packing / 2) / std::pow(1 - packing, 3);
  return 16 * std::sqrt(M_PI) * density * contact;
}

/// The gas after some contacts a ball. Motions are taken over as they are, so nothing is rounded.
BallScene equilibrium(std::size_t n, double packing) {
  SceneOptions options;
  options.bodies = n;
  options.packing = packing;
  options.size_spread = 1;
  options.maxwell = true;
  BallScene scene = make_scene(options);
  constexpr double contacts_a_ball = 4;
  Drive drive;
  drive.duration = contacts_a_ball / contact_rate(packing);
  kds::collision::World<1> world(world_options(scene, methods().front(), drive));
  add_balls(world, scene);
  world.advance_to(drive.duration);
  for (kds::collision::BodyId i = 0; i < n; ++i) {
    const auto& motion = world.motion(i);
    BallScene::Ball& ball = scene.balls[i];
    ball.position = motion.coefficients[0];
    ball.velocity = motion.coefficients[1];
    ball.start = motion.start;
  }
  scene.start_time = drive.duration;
  return scene;
}

}  // namespace

std::vector<Target> measure_gas(const Settings& settings) {
  auto file = open_csv(settings.folder, "speed-gas.csv");
  tell(file,
       "packing,balls,method,us_a_contact,contacts,swaps_a_contact,tests_a_contact,certificates_a_contact,"
       "box_updates_a_contact,pairs_a_contact,walls_a_contact,setup_cpu,run_cpu,cut\n");
  std::vector<Target> targets;
  for (const double packing : {0.25, 0.01}) {
    for (const std::size_t n : {std::size_t{1000}, std::size_t{10'000}, std::size_t{100'000}}) {
      if (n > 1000 && settings.quick) continue;
      const BallScene scene = equilibrium(n, packing);
      // Ten a ball, or four: what set-up has prepared, tests and boxes, is a small part of them.
      const double contacts = std::min(5 * static_cast<double>(n), 200'000.0);
      Drive drive;
      drive.duration = contacts / (0.5 * static_cast<double>(n) * contact_rate(packing));
      drive.rate = std::max(60.0, 1 / drive.duration);
      std::vector<Entrant> entrants;
      for (const Method& m : methods()) {
        if (n > m.most_bodies) continue;
        entrants.push_back({m.name, [&scene, drive, &m] { return to_run(run_method(scene, m, drive)); }});
      }
      RaceOptions race_options = settings.quick ? single_round : RaceOptions{};
      if (!settings.quick) race_options.rounds = 25;  // a time is wanted, not a ratio: it needs a quiet moment
      race_options.patience = 5;
      race_options.cap = 10;
      const auto results = race(entrants, race_options);
      check_agreement(results, "gas of " + std::to_string(n) + " balls");
      for (const Result& r : results) {
        const double made = std::max(1.0, static_cast<double>(r.best.contacts));
        const auto& c = r.best.counters;
        const auto& before = r.best.after_setup;
        const auto each = [&](std::uint64_t end, std::uint64_t begin) {
          return static_cast<double>(end - begin) / made;
        };
        tell(file, "%g,%zu,%s,%.3f,%.0f,%.1f,%.2f,%.1f,%.2f,%.2f,%.2f,%.4f,%.4f,%d\n", packing, n, r.name.c_str(),
             r.cut ? INFINITY : 1e6 * r.best_run / made, made, each(c.broad_phase.swaps, before.broad_phase.swaps),
             each(c.pair_tests, before.pair_tests), each(c.broad_phase.certificates, before.broad_phase.certificates),
             each(c.broad_phase.box_updates, before.broad_phase.box_updates), each(c.pairs_begun, before.pairs_begun),
             each(c.wall_contacts, before.wall_contacts), r.best.setup, r.best_run, r.cut);
      }
      if (packing == 0.25 && n == 1000) {
        const Result& ours = results.front();
        const double us = ours.cut ? INFINITY : 1e6 * ours.best_run / static_cast<double>(ours.best.contacts);
        targets.push_back({"auto: gas of 1000 balls at packing 0.25: CPU a contact", us, '<', 2, "us"});
      }
    }
  }
  return targets;
}

}  // namespace speed
