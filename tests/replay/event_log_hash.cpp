// Hashes the event logs of fixed scenes, and compares them with what they shall be.
//
// event_log_hash                  prints a line `NAME RECORDS HASH` for each scene
// event_log_hash GOLDEN           compares these lines with a file, says what differs, and exits 1 where something does
// event_log_hash --log NAME WAY   prints the events of one scene, numbers in hexadecimal, for diff
//
// Each scene is run in several ways, with every broad phase or queue, and all must give the line of the file. The file
// in the repository is made by the first form: event_log_hash > tests/replay/golden.txt
#include "kds/events/calendar_queue.hpp"
#include "kds/events/dary_queue.hpp"
#include "kds/events/pairing_queue.hpp"
#include "kds/simulator.hpp"
#include "structures/sorted_list.hpp"
#include "tests/replay/event_hash.hpp"
#include "tests/replay/scenes.hpp"
#include "tests/structures/random_values.hpp"
#include "tests/structures/rule_list.hpp"

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kds::replay {
namespace {

/// A scene, and what must give one and the same log of it.
struct Replay {
  struct Way {
    std::string name;
    std::function<void(EventHash&)> run;
  };
  std::string name;
  std::vector<Way> ways;
};

// --- sorted lists

struct Recorder {
  EventHash* hash;
  void swapped(std::uint32_t left, std::uint32_t right, double t) {
    hash->integer(left);
    hash->integer(right);
    hash->number(t);
    hash->end_record();
  }
  static std::uint32_t rank(std::uint32_t id) { return id % 3; }
};

/// Random motions, insertions, removals and jumps.
template <int Degree, class List>
void run_list(kds::tests::Kind kind, EventHash& hash) {
  kds::tests::Random random(17);
  kds::tests::Model<Degree> model;
  List list(Recorder{&hash});
  double now = kds::tests::beginning(kind);
  Simulator simulator(now, list);
  for (int step = 0; step < 150; ++step) {
    kds::tests::apply(kds::tests::random_change(random, kind, now, 30, model), list, now);
    now += kds::tests::random_delay(random, kind);
    simulator.advance_to(now);
  }
}

template <int Degree>
void add_lists(std::vector<Replay>& replays) {
  using Tuned = structures::SortedList<Degree, Recorder>;
  using OnCalendar = kds::tests::RuleList<Degree, Recorder, CalendarQueue<>>;
  using OnDary = kds::tests::RuleList<Degree, Recorder, DaryQueue<>>;
  using OnPairing = kds::tests::RuleList<Degree, Recorder, PairingQueue<>>;
  constexpr std::array kinds{"generic", "lattice", "mixed", "resting", "scales", "late"};
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const kds::tests::Kind kind = kds::tests::all_kinds[i];
    const std::string name = "list/" + std::to_string(Degree) + '/' + kinds[i];
    replays.push_back({name,
                       {{"tuned", [=](EventHash& hash) { run_list<Degree, Tuned>(kind, hash); }},
                        {"calendar", [=](EventHash& hash) { run_list<Degree, OnCalendar>(kind, hash); }},
                        {"dary", [=](EventHash& hash) { run_list<Degree, OnDary>(kind, hash); }},
                        {"pairing", [=](EventHash& hash) { run_list<Degree, OnPairing>(kind, hash); }}}});
  }
}

// --- worlds

/// A scene run with each broad phase. All events are hashed in the order in which they are reported.
template <int Degree, class MakeScene>
Replay with_each_broad_phase(std::string name, const WorldOptions& options, const MakeScene& scene) {
  Replay replay{std::move(name), {}};
  for (const auto& [method, method_name, what] : broad_phases) {
    WorldOptions chosen = options;
    chosen.broad_phase = method;
    chosen.rate = method == BroadPhaseKind::sap ? 30 : 0;
    replay.ways.push_back({std::string(method_name), [=](EventHash& hash) {
                             for (const Event& e : run<Degree>(scene(), chosen)) hash.event(e);
                           }});
  }
  return replay;
}

/// Names are words, so that lines are easily taken apart.
std::string word(std::string name) {
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

template <int Degree>
void add_worlds(std::vector<Replay>& replays) {
  constexpr std::array all_shapes{Shapes::spheres, Shapes::boxes, Shapes::turned_boxes, Shapes::tetrahedra,
                                  Shapes::cubes,   Shapes::rings, Shapes::mixture};
  for (const Shapes shapes : all_shapes) {
    for (const Numbers numbers : {Numbers::fine, Numbers::coarse}) {
      for (const Response response : {Response::none, Response::elastic}) {
        const bool elastic = response == Response::elastic;
        const std::string name = "world/" + std::to_string(Degree) + '/' + word(collision::tests::name(shapes)) + '/' +
                                 (numbers == Numbers::fine ? "fine/" : "coarse/") + (elastic ? "elastic" : "none");
        WorldOptions options;
        options.response = response;
        options.report_pairs = true;
        if (elastic) options.walls = Walls{Vector3d::Constant(-2), Vector3d::Constant(8)};
        const SceneOptions scene{.shapes = shapes, .numbers = numbers, .scripts = !elastic, .heterogeneous = elastic};
        replays.push_back(with_each_broad_phase<Degree>(name, options, [=] { return random_scene<Degree>(scene, 5); }));
      }
    }
  }
}

void add_bounces(std::vector<Replay>& replays) {
  WorldOptions options;
  options.response = Response::elastic;
  replays.push_back(with_each_broad_phase<2>("bounces", options, [] { return bouncing_scene(); }));
  replays.push_back(with_each_broad_phase<2>("rest", options, [] { return resting_scene(); }));
  replays.push_back(with_each_broad_phase<2>("capsules", options, [] { return capsule_scene(); }));
}

std::vector<Replay> all_replays() {
  std::vector<Replay> replays;
  add_lists<1>(replays);
  add_lists<2>(replays);
  add_worlds<1>(replays);
  add_worlds<2>(replays);
  add_bounces(replays);
  return replays;
}

std::string line_of(const Replay& replay, const Replay::Way& way) {
  EventHash hash(false);
  way.run(hash);
  char text[64];
  std::snprintf(text, sizeof text, " %" PRIu64 " %016" PRIx64, hash.records(), hash.value());
  return replay.name + text;
}

int compare(const char* file) {
  std::ifstream golden(file);
  if (!golden) throw std::runtime_error(std::string(file) + " cannot be read");
  std::string expected;
  int differences = 0;
  for (const Replay& replay : all_replays()) {
    if (!std::getline(golden, expected)) expected = "(nothing)";
    for (const Replay::Way& way : replay.ways) {
      const std::string found = line_of(replay, way);
      if (found == expected) continue;
      ++differences;
      std::printf("differs: %s, %s\n golden: %s\n", found.c_str(), way.name.c_str(), expected.c_str());
    }
  }
  for (; std::getline(golden, expected); ++differences) std::printf("not run: %s\n", expected.c_str());
  std::printf("%d differences from %s\n", differences, file);
  return differences == 0 ? 0 : 1;
}

int print_log(std::string_view name, std::string_view way_name) {
  for (const Replay& replay : all_replays()) {
    for (const Replay::Way& way : replay.ways) {
      if (replay.name != name || way.name != way_name) continue;
      EventHash hash(true);
      way.run(hash);
      return 0;
    }
  }
  throw std::runtime_error("there is no scene of this name, or no such way to run it");
}

void print_lines() {
  for (const Replay& replay : all_replays()) {
    const std::string line = line_of(replay, replay.ways.front());
    for (const Replay::Way& way : replay.ways) {
      if (line_of(replay, way) != line) throw std::runtime_error(replay.name + ": " + way.name + " disagrees");
    }
    std::printf("%s\n", line.c_str());
  }
}

}  // namespace
}  // namespace kds::replay

int main(int argc, char** argv) {
  try {
    if (argc == 2) return kds::replay::compare(argv[1]);
    if (argc == 4 && std::string_view(argv[1]) == "--log") return kds::replay::print_log(argv[2], argv[3]);
    if (argc != 1) throw std::runtime_error("usage: event_log_hash [GOLDEN | --log NAME WAY]");
    kds::replay::print_lines();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "event_log_hash: %s\n", error.what());
    return 1;
  }
}
