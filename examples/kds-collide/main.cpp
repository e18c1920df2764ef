// kds-collide: a scene in, events out.
#include "collision/broad_phase/broad_phase_kind.hpp"
#include "examples/kds-collide/arguments.hpp"
#include "examples/kds-collide/progress_bar.hpp"
#include "io/event_csv.hpp"
#include "io/gltf.hpp"
#include "io/one_line.hpp"
#include "io/output_file.hpp"
#include "io/replay.hpp"
#include "io/scene_reader.hpp"
#include "io/stats_json.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <list>
#include <optional>
#include <string>

namespace {

using namespace kds_collide;
using namespace kds::io;

constexpr int done = 0;
constexpr int run_failed = 1;
constexpr int bad_input = 2;

int complain(const std::string& line, int code) {
  std::fprintf(stderr, "%s\n", one_line(line).c_str());
  return code;
}

int list_broad_phases() {
  OutputFile out("-");
  for (const auto& b : kds::collision::broad_phases) {
    std::string line(b.name);
    line.resize(std::max<std::size_t>(line.size(), 12), ' ');
    out.write(line + ' ' + std::string(b.what) + '\n');
  }
  out.commit();
  return done;
}

int generate(const Arguments& arguments) {
  const std::filesystem::path file = arguments.output.empty() ? arguments.generator.kind + ".json" : arguments.output;
  GeneratorOptions options = arguments.generator;
  if (arguments.table) options.table = std::filesystem::path(file).replace_extension(".h5").filename().string();
  if (arguments.table && options.table == file.filename()) throw ArgumentError("--output: is the name of the table too");
  GeneratedScene scene;
  try {
    scene = generate_scene(options);
  } catch (const std::invalid_argument& error) {
    throw ArgumentError(error.what());
  }
  std::list<OutputFile> outputs;
  const auto write = [&outputs](const std::filesystem::path& path, const std::string& text) {
    OutputFile& output = outputs.emplace_back(path.string());
    output.write(text);
    output.close();
  };
  for (const auto& mesh : scene.meshes) {
    if (file.filename() == mesh.name) throw ArgumentError("--output: is the name of the mesh " + mesh.name + " too");
  }
  // Meshes and the table first: the scene is there only when all it names is.
  for (const auto& mesh : scene.meshes) write(file.parent_path() / mesh.name, mesh.text);
  if (arguments.table) write(file.parent_path() / options.table, scene.table);
  write(file, scene.json);
  for (OutputFile& output : outputs) output.commit();
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
    std::fprintf(stderr, "\n%llu contacts came to last: bodies lie or slide on each other",
                 static_cast<unsigned long long>(result.held));
  }
  std::fputc('\n', stderr);
}

int simulate(Arguments arguments) {
  const std::clock_t read_start = std::clock();
  const Scene scene = read_scene(arguments.scene, arguments.until);
  const double read_seconds = static_cast<double>(std::clock() - read_start) / CLOCKS_PER_SEC;

  if (!arguments.quiet) {
    for (const std::string& warning : scene.warnings) std::fprintf(stderr, "%s\n", one_line(warning).c_str());
  }
  check(arguments, scene);
  // All that can go wrong outside the run goes wrong before it: outputs are opened, three.js is read.
  EventSinks sinks;
  std::optional<EventCsv> events;
  std::optional<OutputFile> stats;
  std::optional<OutputFile> view;
  std::optional<OutputFile> gltf;
  std::optional<ReplayRecorder> recorder;
  std::optional<ProgressBar> progress;
  if (!arguments.events.empty()) sinks.add(events.emplace(arguments.events, scene));
  if (!arguments.stats.empty()) stats.emplace(arguments.stats);
  if (!arguments.view.empty()) {
    replay_page("", default_three_folder());
    view.emplace(arguments.view);
  }
  if (!arguments.gltf.empty()) gltf.emplace(arguments.gltf);
  if (view || gltf) sinks.add(recorder.emplace(scene));
  if (!arguments.quiet && isatty(STDERR_FILENO) != 0) {
    sinks.add(progress.emplace(scene.begin_time, scene.end_time));
    arguments.run.steady_progress = true;
  }

  const RunResult result = run(scene, arguments.run, sinks);
  progress.reset();
  const std::string title = std::filesystem::path(arguments.scene).filename().string();
  if (view) view->write(replay_page(recorder->to_json(title), default_three_folder()));
  if (gltf) gltf->write(to_gltf(scene, recorder->record(), title));
  if (stats) stats->write(to_json(result, arguments.run, read_seconds));
  const auto each_output = [&](auto&& what) {
    if (events) what(*events);
    if (view) what(*view);
    if (gltf) what(*gltf);
    if (stats) what(*stats);
  };
  each_output([](auto& output) { output.close(); });  // All are whole before one appears.
  each_output([](auto& output) { output.commit(); });
  if (!arguments.quiet) print_summary(result);
  return done;
}

}  // namespace

int main(int argc, char** argv) {
  remove_temporaries_at_signals();
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
