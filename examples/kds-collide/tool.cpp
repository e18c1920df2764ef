#include "examples/kds-collide/tool.hpp"

#include "examples/kds-collide/arguments.hpp"
#include "examples/kds-collide/progress_bar.hpp"
#include "examples/kds-collide/tasks.hpp"
#include "io/checkpoint.hpp"
#include "io/event_csv.hpp"
#include "io/event_parts.hpp"
#include "io/gltf.hpp"
#include "io/one_line.hpp"
#include "io/output_file.hpp"
#include "io/replay.hpp"
#include "io/run_lock.hpp"
#include "io/scene_reader.hpp"
#include "io/stats_json.hpp"
#include "io/vtk.hpp"
#include "kds/number_text.hpp"

#include <unistd.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <functional>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace kds_collide {
namespace {

using namespace kds::io;
using kds::rounded_text;

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

/// A scene that is to be run, and where what is seen goes. In process 0, or where there is one alone, files are opened;
/// the others write none but their parts of the events.
class Simulation {
 public:
  Simulation(Arguments arguments, kds::collision::Team& team)
      : arguments_(std::move(arguments)), team_(team), scene_(read()) {}

  /// What else can go wrong outside the run goes wrong here: what it goes on from is read, outputs are opened, three.js
  /// is read. Nothing that is there is changed. `random`: a number, the same in all processes.
  void open(std::uint64_t random) {
    complete(scene_, arguments_.scene, team_);
    const bool writes = team_.rank() == 0;
    const bool quiet = arguments_.quiet || !writes;
    if (!quiet) {
      for (const std::string& warning : scene_.warnings) std::fprintf(stderr, "%s\n", one_line(warning).c_str());
    }
    check(arguments_, scene_);
    if (arguments_.resume) resume();
    if (!arguments_.checkpoint.empty()) prepare_checkpoints(random);
    if (arguments_.events_apart) {
      open_parts(random);
    } else if (writes && !arguments_.events.empty()) {
      if (arguments_.checkpoint.empty()) {
        events_.emplace(arguments_.events, scene_);
      } else {
        events_.emplace(arguments_.events, scene_, checkpoint_.events);
      }
      sinks_.add(*events_);
    }
    if (writes && !arguments_.stats.empty()) stats_.emplace(arguments_.stats);
    if (writes && !arguments_.view.empty()) {
      replay_page("", default_three_folder());
      view_.emplace(arguments_.view);
    }
    if (writes && !arguments_.gltf.empty()) gltf_.emplace(arguments_.gltf);
    if (writes && !arguments_.vtk.empty()) vtk_.emplace(arguments_.vtk);
    if (view_ || gltf_ || vtk_) sinks_.add(recorder_.emplace(scene_));
    if (!quiet && isatty(STDERR_FILENO) != 0) {
      sinks_.add(progress_.emplace(scene_.begin_time, scene_.end_time, !parts_));
      arguments_.run.steady_progress = true;
    }
  }
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// After open(), if it has gone well in all processes.
  void open_checkpoints() {
    if (arguments_.checkpoint.empty()) return;
    const std::optional<std::uint64_t> turn = arguments_.resume ? std::optional(checkpoint_.turn) : std::nullopt;
    checkpoints_.emplace(arguments_.checkpoint, team_, turn);
  }

  /// What to do when the run ends early.
  std::string way_on() const {
    if (arguments_.checkpoint.empty()) return "there is no checkpoint to go on from: --checkpoint makes some";
    if (!saved_) return "there is no checkpoint yet to go on from";
    return "--resume goes on from " + arguments_.checkpoint + ", at " + rounded_text(*saved_) + " s";
  }

  /// `tell_way_on`: is given it at once, and whenever it has changed.
  void run(std::function<void()> tell_way_on) {
    tell_way_on_ = std::move(tell_way_on);
    tell_way_on_();
    result_ = kds::io::run(scene_, arguments_.run, sinks_);
    progress_.reset();
  }

  /// All outputs are whole.
  void close() {
    const std::string title = std::filesystem::path(arguments_.scene).filename().string();
    if (view_) view_->write(replay_page(recorder_->to_json(title), default_three_folder()));
    if (gltf_) gltf_->write(to_gltf(scene_, recorder_->record(), title, arguments_.frame_rate));
    if (vtk_) vtk_->write(scene_, recorder_->record(), arguments_.frame_rate);
    if (stats_) stats_->write(to_json(result_, arguments_.run, read_seconds_));
    each_output([](auto& output) { output.close(); });
  }

  void commit() {
    each_output([](auto& output) { output.commit(); });
    if (arguments_.resume) checkpoints_->finish(checkpoint_.bodies.size());
    if (!arguments_.quiet && team_.rank() == 0) print_summary(result_);
  }

 private:
  template <class What>
  void each_output(const What& what) {
    if (events_) what(*events_);
    if (parts_) what(*parts_);
    if (view_) what(*view_);
    if (gltf_) what(*gltf_);
    if (vtk_) what(*vtk_);
    if (stats_) what(*stats_);
  }

  Scene read() {
    const std::clock_t start = std::clock();
    Scene scene = team_.count() > 1 ? read_share(arguments_.scene, arguments_.until, team_.rank(), team_.count())
                                    : read_scene(arguments_.scene, arguments_.until);
    read_seconds_ = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    return scene;
  }

  void resume() {
    checkpoint_ = read_checkpoint(arguments_.checkpoint);
    require_same_scene(scene_, arguments_.scene, checkpoint_);
    check_resume(arguments_, scene_, checkpoint_);
    arguments_.run.resume = &checkpoint_.world;
    saved_ = checkpoint_.time;
    if (checkpoint_.bodies.empty()) return;
    bodies_.emplace(arguments_.checkpoint, checkpoint_, team_.rank(), team_.count()).check();
    arguments_.run.resume_bodies = [this](std::vector<char>& block) { return bodies_->read(block); };
  }

  void prepare_checkpoints(std::uint64_t random) {
    if (!arguments_.resume) checkpoint_.run = random;
    arguments_.run.checkpoint_bodies = [this](const std::vector<char>& block) { checkpoints_->write_bodies(block); };
    arguments_.run.checkpoint = [this](const kds::Snapshot& world, double time) {
      try {
        checkpoints_->commit({.run = checkpoint_.run,
                              .scene = checksums_of(scene_),
                              .options = saved_options(arguments_),
                              .time = time,
                              .events = events_ ? std::optional(events_->flush()) : std::nullopt,
                              .parts = parts_ ? parts_->places() : std::vector<FilePlace>(),
                              .world = world});
      } catch (...) {
        if (!saved_) discard_events();
        throw;
      }
      saved_ = time;
      tell_way_on_();
    };
  }

  /// There is no checkpoint with which a later run could go on with them.
  void discard_events() {
    if (events_) events_->discard();
    if (parts_) parts_->discard();
  }

  void open_parts(std::uint64_t random) {
    const PartOf of{.scene = fingerprint(scene_),
                    .bodies = scene_.size(),
                    .run = arguments_.resume ? checkpoint_.run : random,
                    .section = random};
    if (arguments_.checkpoint.empty()) {
      parts_.emplace(arguments_.events, of, team_);
    } else {
      parts_.emplace(arguments_.events, of, team_, checkpoint_.parts);
    }
    arguments_.run.steps = &parts_->own();
    if (team_.rank() == 0) sinks_.add(parts_->own());
  }

  Arguments arguments_;
  kds::collision::Team& team_;
  Checkpoint checkpoint_;  ///< from which the run goes on, if it does; else its run alone counts
  std::optional<CheckpointReader> bodies_;
  std::optional<CheckpointWriter> checkpoints_;
  std::optional<double> saved_;  ///< s of simulated time: of the last checkpoint that there is
  std::function<void()> tell_way_on_;
  double read_seconds_ = 0;
  Scene scene_;
  EventSinks sinks_;
  std::optional<EventCsv> events_;
  std::optional<EventsApart> parts_;
  std::optional<OutputFile> stats_, view_, gltf_;
  std::optional<VtkSeries> vtk_;
  std::optional<ReplayRecorder> recorder_;
  std::optional<ProgressBar> progress_;
  RunResult result_;
};

/// Why the tool ends, if it is not done.
struct Failure {
  int code = done;
  std::string line;
};

/// What comes of it.
template <class Call>
Failure attempt(const std::string& name, const Arguments& arguments, const Call& call) {
  try {
    call();
    return {};
  } catch (const ArgumentError& error) {
    return {bad_input, name + ": " + error.what()};
  } catch (const SceneError& error) {
    return {bad_input, error.what()};
  } catch (const OutputError& error) {
    return {error.on_opening ? bad_input : run_failed, error.what()};
  } catch (const std::exception& error) {
    return {run_failed, (arguments.scene.empty() ? name : arguments.scene) + ": run: " + error.what()};
  }
}

/// What --help or --version ask for, to standard output.
void write_answer(const CLI::App& app, const CLI::Success& asked) {
  std::ostringstream text;
  app.exit(asked, text, text);
  OutputFile output("-");
  output.write(text.view());
  output.commit();
}

/// At the end of the line, which begins with the place of what is wrong, however many processes there are.
std::string in_process(std::size_t rank) { return " (process " + std::to_string(rank) + ")"; }

/// That of the first process that has failed.
Failure first_of(kds::collision::Team& team, Failure failure) {
  std::array<double, 1> from_the_end{failure.code == done ? 0 : static_cast<double>(team.count() - team.rank())};
  team.combine({}, from_the_end);
  if (from_the_end[0] == 0) return failure;
  const std::size_t first = team.count() - static_cast<std::size_t>(from_the_end[0]);
  std::array<std::uint64_t, 1> code{team.rank() == first ? static_cast<std::uint64_t>(failure.code) : 0};
  team.combine(code, {});
  failure.code = static_cast<int>(code[0]);
  // Process 0 tells of it.
  kds::collision::Letters letters;
  if (team.rank() == first && first > 0) letters.to(0)(failure.line);
  team.exchange(std::move(letters), [&](std::size_t process, auto& reader) {
    reader(failure.line);
    failure.line += in_process(process);
  });
  return failure;
}

int end_with(const Failure& failure, bool says) {
  if (failure.code != done && says) std::fprintf(stderr, "%s\n", one_line(failure.line).c_str());
  return failure.code;
}

}  // namespace

int run_tool(int argc, char** argv, const char* name, const Together* together) {
  kds::collision::Team team(together ? &together->processes : nullptr);
  const bool is_first = team.rank() == 0;
  remove_temporaries_at_signals();
  Arguments arguments;
  if (together) {
    arguments.run.processes = &together->processes;
    arguments.run.domains = 0;
  }
  CLI::App app("Finds when and where moving bodies collide, exactly. Scene in, events out.", name);
  describe(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    if (!is_first) return done;
    return end_with(attempt(name, arguments, [&] { write_answer(app, asked); }), true);
  } catch (const CLI::ParseError& error) {
    return end_with({bad_input, std::string(name) + ": arguments: " + error.what()}, is_first);
  }
  if (arguments.run.broad_phase == "list" || arguments.generate || !arguments.merge.empty()) {
    if (!is_first) return done;
    return end_with(attempt(name, arguments,
                            [&] {
                              if (arguments.run.broad_phase == "list") return list_broad_phases();
                              check(arguments);
                              arguments.generate ? generate(arguments) : merge(arguments);
                            }),
                    true);
  }

  const std::uint64_t random = team.of_first(std::uint64_t{std::random_device()()} << 32 | std::random_device()());
  std::optional<RunLock> lock;  // outlives what writes
  std::optional<Simulation> simulation;
  Failure failure;
  const auto begin = [&](const auto& call) {
    if (failure.code == done) failure = first_of(team, attempt(name, arguments, call));
  };
  begin([&] {
    check(arguments);
    simulation.emplace(arguments, team);
  });
  begin([&] {
    if (!arguments.checkpoint.empty()) lock.emplace(arguments.checkpoint, team.rank());
  });
  begin([&] {
    if (lock) lock->share();
  });
  begin([&] { simulation->open(random); });
  begin([&] { simulation->open_checkpoints(); });
  // In all processes, as nothing is left to be written.
  const auto unlock = [&] {
    simulation.reset();
    team.of_first(true);
    if (lock) lock->remove();
  };
  if (failure.code != done) {
    unlock();
    return end_with(failure, is_first);
  }
  // Of a run that is told to end, or whose processes are, since one of them is lost.
  std::string way_on;
  const auto at_signals = [&] {
    if (!together && arguments.checkpoint.empty()) return;
    way_on = "; " + simulation->way_on();
    say_at_signals(one_line(std::string(name) + ": ended by a signal" + way_on),
                   together ? together->may_say : nullptr);
  };
  failure = attempt(name, arguments, [&] {
    simulation->run(at_signals);
    say_at_signals("");
    simulation->close();
    // All outputs, of all processes, are whole before one appears: none comes here before the others do.
    team.of_first(true);
    simulation->commit();
    unlock();
  });
  if (failure.code == run_failed) failure.line += way_on;
  if (failure.code != done && team.count() == 1) unlock();
  if (failure.code != done && team.count() > 1) {
    together->may_say();  // The others, which are told to end, need not say it again.
    failure.line += in_process(team.rank());
    simulation.reset();  // removes temporary files
    // What fails in all processes is said once: process 0 ends the others while they wait.
    constexpr std::chrono::seconds longest_until_all_have_failed(2);
    if (!is_first) std::this_thread::sleep_for(longest_until_all_have_failed);
    end_with(failure, true);
    together->end_all(failure.code);
  }
  return end_with(failure, true);
}

}  // namespace kds_collide
