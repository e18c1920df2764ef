// kds-collide: a scene in, events out.
#include "collision/broad_phase/broad_phase_kind.hpp"
#include "examples/kds-collide/event_csv.hpp"
#include "examples/kds-collide/generator.hpp"
#include "examples/kds-collide/output_file.hpp"
#include "examples/kds-collide/progress_bar.hpp"
#include "examples/kds-collide/replay.hpp"
#include "examples/kds-collide/run.hpp"
#include "examples/kds-collide/scene_reader.hpp"
#include "examples/kds-collide/stats_json.hpp"

#include <CLI/CLI.hpp>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace kds_collide;

constexpr int done = 0;
constexpr int run_failed = 1;
constexpr int bad_input = 2;

struct Arguments {
  std::string scene;
  std::string events;
  std::string stats;
  std::string view;
  std::optional<double> until;
  RunOptions run;
  bool quiet = false;
  bool generate = false;
  GeneratorOptions generator;
  std::string output;
};

/// What is wrong with the arguments, as "WHERE: what is wrong".
struct ArgumentError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

int complain(const std::string& line, int code) {
  std::string text = line;
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::fprintf(stderr, "%s\n", text.c_str());
  return code;
}

void describe(CLI::App& app, Arguments& arguments) {
  app.add_option("SCENE", arguments.scene, "Scene file (JSON)");
  app.add_option("--events", arguments.events, "Write events as CSV; - is standard output")->type_name("FILE|-");
  app.add_option("--stats", arguments.stats, "Write what the run took as JSON; - is standard output")
      ->type_name("FILE|-");
  app.add_option("--broad-phase", arguments.run.broad_phase, "How pairs are found; \"list\" names the ways")
      ->type_name("NAME");
  app.add_option("--kdop", arguments.run.kdop, "Bounding volumes of kinetic-sap: 6 (boxes), 14, 18 or 26 sides")
      ->type_name("K");
  app.add_option("--until", arguments.until, "End the run at T, in seconds, instead of the scene's end_time")
      ->type_name("T");
  app.add_option("--rate", arguments.run.rate, "Ask for results so many times a second (sap needs it); 0 = not at all")
      ->type_name("HZ");
  app.add_option("--threads", arguments.run.threads, "Threads that take in the bodies of large scenes; 0 = all")
      ->type_name("N");
  app.add_flag("--pairs", arguments.run.pairs, "Write events of kinetic bounding volumes too");
  app.add_option("--view", arguments.view, "Write a replay that any browser shows")->type_name("FILE.html");
  app.add_flag("--quiet", arguments.quiet, "No progress and no summary on standard error");

  const std::string group = "Making a scene instead of running one";
  auto* kind = app.add_option("--generate", arguments.generator.kind, "rings, models, spheres or boxes")
                   ->type_name("KIND")
                   ->group(group);
  const auto add = [&](const char* name, auto& value, const char* what) {
    return app.add_option(name, value, what)->needs(kind)->group(group);
  };
  add("--bodies", arguments.generator.bodies, "How many")->check(CLI::NonNegativeNumber)->capture_default_str();
  add("--density", arguments.generator.density, "Volume of their bounding balls over that of the domain")
      ->capture_default_str();
  add("--seed", arguments.generator.seed, "One seed, one scene, on every machine")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  add("--output", arguments.output, "Scene file to write, meshes beside it (default: KIND.json)")->type_name("FILE");
  app.callback([&arguments, kind] { arguments.generate = kind->count() > 0; });
  app.set_version_flag("--version", "kds-collide " KDS_VERSION);
}

/// Two outputs in one file, or an output in place of the scene, would destroy what is wanted.
void check_files_differ(const Arguments& arguments) {
  const std::vector<std::pair<const char*, std::string>> files{{"SCENE", arguments.scene},
                                                               {"--events", arguments.events},
                                                               {"--stats", arguments.stats},
                                                               {"--view", arguments.view}};
  for (std::size_t i = 0; i < files.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (files[i].second.empty() || files[j].second.empty()) continue;
      std::error_code ignored;
      const bool same = files[i].second == files[j].second ||
                        (std::filesystem::is_regular_file(files[i].second, ignored) &&
                         std::filesystem::equivalent(files[i].second, files[j].second, ignored));
      if (same) throw ArgumentError(std::string(files[i].first) + ": is the same file as " + files[j].first);
    }
  }
}

void check(const Arguments& arguments) {
  if (arguments.generate) {
    if (!arguments.scene.empty()) throw ArgumentError("SCENE: with --generate nothing is run; give --output");
    return;
  }
  if (arguments.scene.empty()) throw ArgumentError("SCENE: is missing");
  const RunOptions& run = arguments.run;
  if (!std::isfinite(run.rate) || run.rate < 0) throw ArgumentError("--rate: must be finite and >= 0");
  if (arguments.until && !std::isfinite(*arguments.until)) throw ArgumentError("--until: must be finite");
  const auto& known = kds::collision::broad_phases;
  if (std::none_of(known.begin(), known.end(), [&](const auto& b) { return b.name == run.broad_phase; })) {
    std::string names;
    for (const auto& b : known) names += (names.empty() ? "" : ", ") + std::string(b.name);
    throw ArgumentError("--broad-phase: there is no \"" + run.broad_phase + "\"; there are " + names);
  }
  if (run.kdop != 6 && run.kdop != 14 && run.kdop != 18 && run.kdop != 26) {
    throw ArgumentError("--kdop: must be 6, 14, 18 or 26");
  }
  if (run.kdop != 6 && run.broad_phase != "kinetic-sap") {
    throw ArgumentError("--kdop: more than 6 is for --broad-phase kinetic-sap alone");
  }
  if (run.broad_phase == "sap" && run.rate == 0) throw ArgumentError("--rate: must be > 0 for the broad phase \"sap\"");
  check_files_differ(arguments);
}

int list_broad_phases() {
  for (const auto& b : kds::collision::broad_phases) {
    std::printf("%-12.*s %.*s\n", static_cast<int>(b.name.size()), b.name.data(), static_cast<int>(b.what.size()),
                b.what.data());
  }
  return done;
}

int generate(const Arguments& arguments) {
  GeneratedScene scene;
  try {
    scene = generate_scene(arguments.generator);
  } catch (const std::invalid_argument& error) {
    throw ArgumentError(error.what());
  }
  const std::filesystem::path file = arguments.output.empty() ? arguments.generator.kind + ".json" : arguments.output;
  const auto write = [](const std::filesystem::path& path, const std::string& text) {
    OutputFile out(path.string());
    out.write(text);
    out.commit();
  };
  // Meshes first: the scene is there only when all it names is.
  for (const auto& mesh : scene.meshes) write(file.parent_path() / mesh.name, mesh.text);
  write(file, scene.json);
  if (!arguments.quiet) {
    std::fprintf(stderr, "%s: %zu %s, density %g, seed %llu\n", file.c_str(), arguments.generator.bodies,
                 arguments.generator.kind.c_str(), arguments.generator.density,
                 static_cast<unsigned long long>(arguments.generator.seed));
  }
  return done;
}

void print_summary(const RunResult& result) {
  std::fprintf(stderr,
               "%s: %llu bodies, %g s simulated: %llu contacts, %llu swaps, %llu pair tests\n"
               "CPU: %.4g s set-up, %.4g s run",
               result.broad_phase.c_str(), static_cast<unsigned long long>(result.bodies), result.sim_seconds,
               static_cast<unsigned long long>(result.contacts), static_cast<unsigned long long>(result.swaps),
               static_cast<unsigned long long>(result.pair_tests), result.setup_cpu_seconds, result.run_cpu_seconds);
  if (result.sim_seconds > 0) {
    std::fprintf(stderr, " (%.4g s per simulated second)", result.run_cpu_seconds / result.sim_seconds);
  }
  if (result.held > 0) {
    std::fprintf(stderr, "\nheld together %llu times where bounces piled up without end",
                 static_cast<unsigned long long>(result.held));
  }
  std::fputc('\n', stderr);
}

Scene load(const Arguments& arguments) {
  Scene scene = read_scene(arguments.scene);
  if (arguments.until) {
    if (*arguments.until < scene.begin_time) throw ArgumentError("--until: is before the motion begins");
    scene.end_time = *arguments.until;
  }
  return scene;
}

int simulate(Arguments arguments) {
  const std::clock_t read_start = std::clock();
  const Scene scene = load(arguments);
  const double read_seconds = static_cast<double>(std::clock() - read_start) / CLOCKS_PER_SEC;

  // All that can go wrong outside the run goes wrong before it: outputs are opened, three.js is read.
  EventSinks sinks;
  std::optional<EventCsv> events;
  std::optional<OutputFile> stats;
  std::optional<OutputFile> view;
  std::optional<ReplayRecorder> recorder;
  std::optional<ProgressBar> progress;
  if (!arguments.events.empty()) sinks.add(events.emplace(arguments.events, scene));
  if (!arguments.stats.empty()) stats.emplace(arguments.stats);
  if (!arguments.view.empty()) {
    replay_page("", default_three_folder());
    view.emplace(arguments.view);
    sinks.add(recorder.emplace(scene));
  }
  if (!arguments.quiet && isatty(STDERR_FILENO) != 0) {
    sinks.add(progress.emplace(scene.begin_time, scene.end_time));
    arguments.run.steady_progress = true;
  }

  const RunResult result = run(scene, arguments.run, sinks);
  progress.reset();
  if (events) events->commit();
  if (view) {
    view->write(replay_page(recorder->to_json(std::filesystem::path(arguments.scene).filename().string()),
                            default_three_folder()));
    view->commit();
  }
  if (stats) {
    stats->write(to_json(result, arguments.run, read_seconds));
    stats->commit();
  }
  if (!arguments.quiet) print_summary(result);
  return done;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Finds when and where moving bodies collide, exactly. Scene in, events out.", "kds-collide");
  describe(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    return complain(std::string("kds-collide: arguments: ") + error.what(), bad_input);
  }
  try {
    if (arguments.run.broad_phase == "list") return list_broad_phases();
    check(arguments);
    return arguments.generate ? generate(arguments) : simulate(arguments);
  } catch (const ArgumentError& error) {
    return complain(std::string("kds-collide: ") + error.what(), bad_input);
  } catch (const SceneError& error) {
    return complain(error.what(), bad_input);
  } catch (const OutputError& error) {
    return complain(error.what(), error.on_opening ? bad_input : run_failed);
  } catch (const std::exception& error) {
    return complain((arguments.scene.empty() ? "kds-collide" : arguments.scene) + ": run: " + error.what(), run_failed);
  }
}
