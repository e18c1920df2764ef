// The event logs of sorted lists and of worlds whose bodies keep their orientation, each with every queue or broad
// phase, and of worlds in domains: see replay.hpp. The file in the repository is made by: event_log_hash >
// tests/replay/golden.txt
#include "kds/events/calendar_queue.hpp"
#include "kds/events/dary_queue.hpp"
#include "kds/events/pairing_queue.hpp"
#include "kds/simulator.hpp"
#include "structures/sorted_list.hpp"
#include "tests/replay/divided.hpp"
#include "tests/replay/replay.hpp"
#include "tests/replay/scenes.hpp"
#include "tests/structures/random_values.hpp"
#include "tests/structures/rule_list.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace kds::replay {
namespace {

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

/// A scene run with each broad phase, and in so many divisions. All events are hashed in the order in which they are
/// reported.
template <int Degree, class MakeScene>
Replay in_all_ways(std::string name, const WorldOptions& options, const MakeScene& scene, std::uint64_t divisions = 2,
                   bool surely_divided = false) {
  Replay replay{std::move(name), {}};
  for (const auto& [method, method_name, what] : broad_phases) {
    WorldOptions chosen = options;
    chosen.broad_phase = method;
    chosen.rate = method == BroadPhaseKind::sap ? 30 : 0;
    replay.ways.push_back({std::string(method_name), [=](EventHash& hash) {
                             for (const Event& e : run<Degree>(scene(), chosen)) hash.event(e);
                           }});
  }
  const auto fill = [=](World<Degree>& world) {
    for (const auto& body : scene().bodies) world.add_body(body);
  };
  add_divisions<certificates::PointMotion<Degree>>(replay, divisions,
                                                   {.options = options,
                                                    .end_time = scene().end_time,
                                                    .fill = fill,
                                                    .run = [=] { return run<Degree>(scene(), options); },
                                                    .untold =
                                                        [](const Event& event) {
                                                          return is_pair_event(event) || event.kind == Kind::rests ||
                                                                 event.kind == Kind::wakes;
                                                        },
                                                    .surely_divided = surely_divided});
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
        replays.push_back(in_all_ways<Degree>(name, options, [=] { return random_scene<Degree>(scene, 5); }));
      }
    }
  }
}

template <int Degree>
void add_divided(std::vector<Replay>& replays) {
  for (const Shapes shapes : {Shapes::spheres, Shapes::boxes, Shapes::mixture}) {
    for (const Numbers numbers : {Numbers::fine, Numbers::coarse}) {
      WorldOptions options;
      options.response = Response::elastic;
      options.walls = Walls{Vector3d::Constant(-2), Vector3d::Constant(12)};
      SceneOptions scene{.shapes = shapes, .numbers = numbers, .heterogeneous = true};
      scene.bodies = 80, scene.side = 10, scene.end_time = Degree == 1 ? 2 : 1;
      constexpr std::uint64_t divisions = 6;
      const std::string name = "domains/" + std::to_string(Degree) + '/' + word(collision::tests::name(shapes)) +
                               (numbers == Numbers::fine ? "/fine" : "/coarse");
      const auto make = [=] { return random_scene<Degree>(scene, 8); };
      replays.push_back(in_all_ways<Degree>(name, options, make, divisions, true));
    }
  }
}

void add_bounces(std::vector<Replay>& replays) {
  WorldOptions options;
  options.response = Response::elastic;
  replays.push_back(in_all_ways<2>("bounces", options, [] { return bouncing_scene(); }));
  replays.push_back(in_all_ways<2>("rest", options, [] { return resting_scene(); }));
  replays.push_back(in_all_ways<2>("capsules", options, [] { return capsule_scene(); }));
}

void add_bending(std::vector<Replay>& replays) {
  WorldOptions options;
  replays.push_back(in_all_ways<1>("bending/none", options, [] { return bending_scene<1>(false); }));
  options.response = Response::elastic;
  replays.push_back(in_all_ways<2>("bending/elastic", options, [] { return bending_scene<2>(true); }));
}

std::vector<Replay> all_replays() {
  std::vector<Replay> replays;
  add_lists<1>(replays);
  add_lists<2>(replays);
  add_worlds<1>(replays);
  add_worlds<2>(replays);
  add_bounces(replays);
  add_bending(replays);
  add_divided<1>(replays);
  add_divided<2>(replays);
  return replays;
}

}  // namespace
}  // namespace kds::replay

int main(int argc, char** argv) { return kds::replay::main_of(argc, argv, kds::replay::all_replays); }
