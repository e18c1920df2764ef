// Our methods and other libraries' on the same balls: set-up and run, and whether they find the same contacts.
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/speed/methods.hpp"
#include "tests/benchmarks/speed/peers/peers.hpp"
#include "tests/benchmarks/speed/race.hpp"
#include "tests/benchmarks/speed/report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <tuple>

namespace speed {
namespace {

using kds::benchmarks::open_csv;
using kds::benchmarks::tell;

struct Setting {
  std::size_t bodies;
  double packing;
  double rate;      ///< Hz
  double duration;  ///< s
};

/// Contacts sorted by bodies, then time, as two methods may round times that are nearly equal either way.
std::vector<Meeting> in_order(std::vector<Meeting> meetings) {
  std::sort(meetings.begin(), meetings.end(), [](const Meeting& x, const Meeting& y) {
    return std::tuple(x.a, x.b, x.time) < std::tuple(y.a, y.b, y.time);
  });
  return meetings;
}

/// Counts what is in one list and not in the other, and compares the times of what is in both.
void compare(Run& run, const std::vector<Meeting>& expected, std::vector<Meeting> found) {
  found = in_order(std::move(found));
  run.contacts = found.size();
  if (found.size() != expected.size()) {
    run.wrong = std::max(found.size(), expected.size()) - std::min(found.size(), expected.size());
    return;
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i].a != expected[i].a || found[i].b != expected[i].b) {
      ++run.wrong;
    } else {
      run.worst_time = std::max(run.worst_time, std::abs(found[i].time - expected[i].time));
    }
  }
}

std::vector<Entrant> entrants(const BallScene& scene, const Drive& drive, const std::vector<Meeting>& expected) {
  std::vector<Entrant> list;
  for (const Method& m : methods()) {
    if (scene.balls.size() > m.most_bodies) continue;
    list.push_back({m.name, [&scene, drive, &m] { return to_run(run_method(scene, m, drive)); }});
  }
  for (const Peer& peer : peers()) {
    if (scene.balls.size() > peer.most_bodies) continue;
    list.push_back({peer.name, [&scene, drive, peer, &expected] {
                      std::vector<Meeting> meetings;
                      const PeerOutcome outcome = peer.run(scene, drive, &meetings);
                      Run run;
                      run.setup = outcome.setup;
                      run.run = outcome.run;
                      run.tests = outcome.tests;
                      compare(run, expected, std::move(meetings));
                      return run;
                    }});
  }
  return list;
}

/// How many times as long a library takes as the default, set-up counted or not; its best configuration.
Target against(const std::vector<Result>& results, const std::string& prefix, bool with_setup, const Setting& setting,
               double wanted) {
  double best = std::numeric_limits<double>::infinity();
  bool all_cut = true;
  for (const Result& r : results) {
    if (r.name.rfind(prefix, 0) != 0) continue;
    best = std::min(best, ratio(r, results.front(), with_setup ? &Round::total : &Round::run).median);
    all_cut = all_cut && r.cut;
  }
  char what[200];
  std::snprintf(what, sizeof what, "auto against %s%s: %zu balls %g %% %g Hz %g s%s", prefix.c_str(),
                all_cut ? " (ended: more than this)" : "", setting.bodies, 100 * setting.packing, setting.rate,
                setting.duration, with_setup ? " with set-up" : " run alone");
  return {what, best, '>', wanted, "x"};
}

double wanted_of(const Setting& setting) {
  if (setting.rate == 1000) return 150;
  return setting.bodies >= 100'000 ? 30 : 20;
}

}  // namespace

std::vector<Target> measure_peers(const Settings& settings) {
  for (const char* missing : missing_peers()) std::printf("built without %s: left out\n", missing);
  // Ten seconds as well, since set-up is most of the first.
  std::vector<Setting> list{{1000, 0.01, 60, 1}, {1000, 0.01, 60, 10}, {1000, 0.01, 1000, 1}, {1000, 0.01, 1000, 10}};
  if (!settings.quick) {
    list.insert(list.end(), {{1000, 0.1, 60, 1}, {1000, 0.1, 1000, 1}, {10'000, 0.01, 60, 1}, {100'000, 0.01, 60, 1}});
  }
  auto file = open_csv(settings.folder, "speed-peers.csv");
  tell(file, "bodies,packing,rate,sim_seconds,method,setup_cpu,run_cpu,contacts,wrong,worst_time,tests,cut\n");
  std::vector<Target> targets;
  for (const Setting& setting : list) {
    SceneOptions options;
    options.bodies = setting.bodies;
    options.packing = setting.packing;
    const BallScene scene = make_scene(options);
    const Drive drive{setting.rate, setting.duration};
    std::vector<Meeting> expected;
    run_method(scene, methods().front(), drive, &expected);
    expected = in_order(std::move(expected));

    RaceOptions race_options = settings.quick ? single_round : RaceOptions{};
    race_options.hopeless = 1e9;  // a ratio is wanted, however great
    race_options.cap = settings.quick ? 5 : 12;
    race_options.patience = 5;
    const auto results = race(entrants(scene, drive, expected), race_options);
    for (const Result& r : results) {
      tell(file, "%zu,%g,%g,%g,%s,%.6f,%.6f,%llu,%llu,%.1e,%llu,%d\n", setting.bodies, setting.packing, setting.rate,
           setting.duration, r.name.c_str(), r.best.setup, r.best_run, static_cast<unsigned long long>(r.best.contacts),
           static_cast<unsigned long long>(r.best.wrong), r.best.worst_time,
           static_cast<unsigned long long>(r.best.tests), r.cut);
      constexpr double same_time = 1e-9;  // s; peers round in every frame, and contacts multiply what was rounded
      if (!r.cut && (r.best.wrong > 0 || r.best.worst_time > same_time)) {
        throw std::runtime_error(r.name + " found other contacts than " + results.front().name);
      }
    }
    for (const char* prefix : {"btAxisSweep3", "bt32BitAxisSweep3", "btDbvtBroadphase", "fcl"}) {
      const bool there =
          std::any_of(results.begin(), results.end(), [&](const Result& r) { return r.name.rfind(prefix, 0) == 0; });
      const bool wanted = setting.packing == 0.01 && setting.bodies != 10'000;
      if (!there || !wanted) continue;
      for (const bool with_setup : {true, false}) {
        targets.push_back(against(results, prefix, with_setup, setting, wanted_of(setting)));
      }
    }
  }
  return targets;
}

}  // namespace speed
