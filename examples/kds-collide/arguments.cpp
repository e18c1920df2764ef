#include "examples/kds-collide/arguments.hpp"

#include "collision/broad_phase/broad_phase_kind.hpp"
#include "collision/parallel/parallel_options.hpp"
#include "examples/kds-collide/file_names.hpp"
#include "io/vtk.hpp"
#include "kds/number_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

namespace kds_collide {

using namespace kds::io;
using kds::append_number;
using kds::number_text;

namespace {

/// A run that is asked for more results than this would take hours: each is some 6 ns.
constexpr double most_results = 1e12;

/// The whole of `text` as a decimal number. CLI11 has other rules: 010 is 8 to it, -1 the greatest number there is, and
/// an empty text, of a variable that was not set, say, is 0.
template <class Number>
Number to_number(const std::string& option, const std::string& text) {
  const auto refuse = [&](const std::string& why) { throw CLI::ValidationError(option, '"' + text + "\" is " + why); };
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  const bool is_read = error == std::errc() && stop == end;
  if constexpr (std::is_floating_point_v<Number>) {
    if (error == std::errc::result_out_of_range) refuse("out of range");
    if (!is_read || !std::isfinite(value)) refuse("not a finite number");
  } else if (!is_read || std::cmp_less(value, 0)) {
    refuse("not a whole number from 0 to " + std::to_string(std::numeric_limits<Number>::max()));
  }
  return value;
}

/// An option whose value is a number, perhaps in a std::optional.
template <class Number>
CLI::Option* add_number(CLI::App& app, const std::string& name, auto& value, const std::string& what) {
  const CLI::callback_t read = [name, &value](const CLI::results_t& texts) {
    value = to_number<Number>(name, texts.back());
    return true;
  };
  return app.add_option(name, read, what);
}

/// An empty name, of a variable that was not set, say, would be an output that is silently not written.
CLI::Validator not_empty() {
  return {[](std::string& text) -> std::string { return text.empty() ? "names no file" : ""; }, ""};
}

void check_parts(const Arguments& arguments) {
  if (!arguments.merge.empty() && arguments.events.empty()) {
    throw ArgumentError("--merge-events: needs --events, the file to write");
  }
  if (!arguments.events_apart) return;
  if (arguments.events.empty()) throw ArgumentError("--events-apart: needs --events");
  if (arguments.events == "-") throw ArgumentError("--events-apart: the events must be files");
}

bool pictures(const Arguments& arguments) {
  return !arguments.view.empty() || !arguments.gltf.empty() || !arguments.vtk.empty();
}

void check_checkpoints(const Arguments& arguments) {
  const double every = arguments.run.checkpoint_every;
  if (arguments.checkpoint.empty()) {
    if (every != 0) throw ArgumentError("--checkpoint-every: needs --checkpoint");
    if (arguments.resume) throw ArgumentError("--resume: needs --checkpoint");
    return;
  }
  if (!(every > 0 && std::isfinite(1 / every))) {
    throw ArgumentError("--checkpoint: needs --checkpoint-every, a time > 0 that is not too short");
  }
  if (pictures(arguments)) {
    throw ArgumentError("--checkpoint: there are no pictures of a run in parts");
  }
  for (const std::string& file : {arguments.checkpoint, arguments.events}) {
    if (file == "-") throw ArgumentError("--checkpoint: the checkpoint and the events must be files");
  }
}

}  // namespace

void describe(CLI::App& app, Arguments& arguments) {
  app.add_option("SCENE", arguments.scene, "Scene file (JSON)");
  app.add_option("--events", arguments.events, "Write events as CSV; - is standard output")
      ->type_name("FILE|-")
      ->check(not_empty());
  app.add_flag("--events-apart", arguments.events_apart,
               "Each process writes its events by itself, into FILE.0, FILE.1..., for --merge-events");
  auto* merge = app.add_option("--merge-events", arguments.merge,
                               "Run nothing: make --events of FILE.0, FILE.1..., which --events-apart has written")
                    ->type_name("FILE")
                    ->check(not_empty());
  app.add_option("--stats", arguments.stats, "Write what the run took as JSON; - is standard output")
      ->type_name("FILE|-")
      ->check(not_empty());
  app.add_option("--broad-phase", arguments.run.broad_phase, "How pairs are found; \"list\" names the ways")
      ->type_name("NAME");
  add_number<int>(app, "--kdop", arguments.run.kdop, "Bounding volumes of kinetic-sap: 6 (boxes), 14, 18 or 26 sides")
      ->type_name("K");
  add_number<double>(app, "--orientation-error", arguments.run.orientation_error,
                     "How far bodies that precess may be turned otherwise than they would be, in rad")
      ->type_name("RAD");
  add_number<double>(
      app, "--shortest-flight", arguments.run.shortest_flight,
      "For how long bodies that turn fly at least after a contact that presses them together, in seconds")
      ->type_name("T");
  add_number<double>(app, "--until", arguments.until, "End the run at T, in seconds, instead of the scene's end_time")
      ->type_name("T");
  add_number<double>(app, "--rate", arguments.run.rate,
                     "Ask for results so many times a second (sap needs it); 0 = not at all")
      ->type_name("HZ");
  add_number<std::size_t>(app, "--threads", arguments.run.threads,
                          "Threads that take in the bodies of large scenes; 0 = all")
      ->type_name("N");
  add_number<std::size_t>(app, "--domains", arguments.run.domains,
                          "Divide the scene among the threads into so many parts; 0 = as many as is best")
      ->type_name("N");
  app.add_flag("--pairs", arguments.run.pairs, "Write events of kinetic bounding volumes too");
  app.add_option("--view", arguments.view, "Write a replay that any browser shows")
      ->type_name("FILE.html")
      ->check(not_empty());
  app.add_option("--gltf", arguments.gltf, "Write an animation in the format glTF")
      ->type_name("FILE.gltf")
      ->check(not_empty());
  app.add_option("--vtk", arguments.vtk, "Write a series of surfaces in the formats of VTK, which ParaView reads")
      ->type_name("FILE.pvd")
      ->check(not_empty());
  add_number<double>(app, "--frame-rate", arguments.frame_rate, "So many times a second in glTF and VTK (default: 60)")
      ->type_name("HZ");
  app.add_option("--checkpoint", arguments.checkpoint, "Write the state of the run now and then, to go on from")
      ->type_name("FILE")
      ->check(not_empty());
  add_number<double>(app, "--checkpoint-every", arguments.run.checkpoint_every,
                     "Whenever so much simulated time has gone by, in seconds")
      ->type_name("S");
  app.add_flag("--resume", arguments.resume, "Go on from the checkpoint");
  const std::vector<CLI::Option*> of_a_run = app.get_options([](const CLI::Option* o) { return o->nonpositional(); });
  for (CLI::Option* option : of_a_run) {
    const std::string given = option->get_name();
    const bool of_both = given == "--help" || given == "--events" || given == "--threads" || given == "--until";
    if (option != merge && !of_both) option->excludes(merge);
  }
  app.add_flag("--quiet", arguments.quiet, "No progress and no summary on standard error");

  const std::string group = "Making a scene instead of running one";
  auto* kind =
      app.add_option("--generate", arguments.generator.kind,
                     "rings, models, spheres, boxes, spinners, spinning-rings, rods, plates, capsules, sheet or crates")
          ->type_name("KIND")
          ->group(group);
  const auto add = [&]<class Number>(const char* name, const char* type, auto& value, Number preset, const char* what) {
    add_number<Number>(app, name, value, what)
        ->type_name(type)
        ->default_str(number_text(preset))
        ->needs(kind)
        ->group(group);
  };
  GeneratorOptions& generator = arguments.generator;
  add("--bodies", "N", generator.bodies, generator.bodies, "How many");
  add("--density", "D", generator.density, default_density, "Volume of their bounding balls over that of the domain");
  add("--seed", "N", generator.seed, generator.seed, "One seed, one scene, on every machine");
  app.add_option("--output", arguments.output, "Scene file to write, meshes beside it (default: KIND.json)")
      ->type_name("FILE")
      ->check(not_empty())
      ->needs(kind)
      ->group(group);
  app.add_flag("--table", arguments.table, "Write the bodies as columns, into an HDF5 file beside the scene")
      ->needs(kind)
      ->group(group);
  for (CLI::Option* option : of_a_run) {
    if (option != app.get_help_ptr()) option->excludes(kind);
  }
  app.callback([&arguments, kind] { arguments.generate = kind->count() > 0; });
  app.set_version_flag("--version", "kds-collide " KDS_VERSION);
}

void check(const Arguments& arguments) {
  if (arguments.generate) {
    if (!arguments.scene.empty()) throw ArgumentError("SCENE: with --generate nothing is run; give --output");
    return;
  }
  if (arguments.scene.empty()) throw ArgumentError("SCENE: is missing");
  const RunOptions& run = arguments.run;
  if (run.rate < 0) throw ArgumentError("--rate: must be >= 0");
  if (run.rate > 0 && !std::isfinite(1 / run.rate)) {
    throw ArgumentError("--rate: must be 0 or have a finite period, 1 / rate");
  }
  const auto& known = kds::collision::broad_phases;
  if (std::none_of(known.begin(), known.end(), [&](const auto& b) { return b.name == run.broad_phase; })) {
    std::string names;
    for (const auto& b : known) names += (names.empty() ? "" : ", ") + std::string(b.name);
    throw ArgumentError("--broad-phase: there is no \"" + run.broad_phase + "\"; there are " + names);
  }
  if (!(run.orientation_error >= 0x1p-30 && run.orientation_error <= 0.125)) {
    throw ArgumentError("--orientation-error: must be from 2^-30 (9.3e-10) to 0.125");
  }
  if (!(run.shortest_flight > 0 && run.shortest_flight <= 1)) {
    throw ArgumentError("--shortest-flight: must be above 0, and at most 1");
  }
  if (run.kdop != 6 && run.kdop != 14 && run.kdop != 18 && run.kdop != 26) {
    throw ArgumentError("--kdop: must be 6, 14, 18 or 26");
  }
  if (run.kdop != 6 && run.broad_phase != "kinetic-sap") {
    throw ArgumentError("--kdop: more than 6 is for --broad-phase kinetic-sap alone");
  }
  if (run.broad_phase == "sap" && run.rate == 0) throw ArgumentError("--rate: must be > 0 for the broad phase \"sap\"");
  if (run.domains > kds::collision::most_domains) throw ArgumentError("--domains: at most 65535");
  if (!arguments.vtk.empty() && !is_series_name(arguments.vtk)) throw ArgumentError("--vtk: must end in .pvd");
  if (!(arguments.frame_rate > 0 && std::isfinite(arguments.frame_rate))) {
    throw ArgumentError("--frame-rate: must be finite and > 0");
  }
  if (run.domains != 1 && pictures(arguments))
    throw ArgumentError("--domains: there are no pictures of a scene that is divided");
  if (run.domains != 1 && run.pairs)
    throw ArgumentError("--domains: volumes are not told of in a scene that is divided");
  check_parts(arguments);
  check_checkpoints(arguments);
  check_files_differ(arguments);
}

void check(const Arguments& arguments, const Scene& scene) {
  if (arguments.until && *arguments.until < scene.begin_time) {
    throw ArgumentError("--until: is before the motion begins");
  }
  if (scene.end_time - scene.begin_time > most_results * arguments.run.checkpoint_every &&
      arguments.run.checkpoint_every > 0) {
    throw ArgumentError("--checkpoint-every: asks for more than 1e12 checkpoints");
  }
  if (arguments.run.rate * (scene.end_time - scene.begin_time) > most_results) {
    throw ArgumentError("--rate: asks for more than 1e12 results");
  }
  check_files_differ(arguments, &scene);
}

std::vector<SavedOption> saved_options(const Arguments& arguments) {
  const auto given = [](bool is_given) { return std::string(is_given ? "given" : "not given"); };
  const auto number = [](auto value) {
    std::string text;
    append_number(text, value);
    return text;
  };
  const RunOptions& run = arguments.run;
  std::vector<SavedOption> options{{"--events", given(!arguments.events.empty())},
                                   {"--events-apart", given(arguments.events_apart)},
                                   {"--orientation-error", number(run.orientation_error)},
                                   {"--shortest-flight", number(run.shortest_flight)},
                                   {"--pairs", given(run.pairs)}};
  if (!run.pairs) return options;
  // Of bounding volumes events depend on how pairs are found.
  options.push_back({"--broad-phase", run.broad_phase});
  options.push_back({"--kdop", number(run.kdop)});
  options.push_back({"--rate", number(run.rate)});
  return options;
}

void check_resume(const Arguments& arguments, const Scene& scene, const Checkpoint& checkpoint) {
  const std::vector<SavedOption> options = saved_options(arguments);
  for (std::size_t i = 0; i < std::min(options.size(), checkpoint.options.size()); ++i) {
    const auto& [name, value] = options[i];
    if (options[i] == checkpoint.options[i]) continue;
    throw ArgumentError(name + ": is " + value + ", and " + checkpoint.options[i].value + " in the checkpoint");
  }
  if (scene.end_time < checkpoint.time) {
    throw ArgumentError("--until: the run ends at " + number_text(scene.end_time) + ", and the checkpoint is of " +
                        number_text(checkpoint.time));
  }
}

}  // namespace kds_collide
