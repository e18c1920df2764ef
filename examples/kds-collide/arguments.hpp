// What the tool is asked to do: its command line.
#pragma once

#include "examples/kds-collide/generator.hpp"
#include "io/checkpoint.hpp"
#include "io/run.hpp"
#include "io/scene.hpp"

#include <CLI/CLI.hpp>

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds_collide {

struct Arguments {
  std::string scene;
  std::string events;
  std::string stats;
  std::string view;
  std::string gltf;
  std::string vtk;
  double frame_rate = 60;       ///< of pictures, 1/s
  std::optional<double> until;  ///< s
  kds::io::RunOptions run;
  bool events_apart = false;  ///< each process writes its own, into a part of `events`
  std::string merge;          ///< the name of parts: they are merged into `events`, and nothing is run
  std::string checkpoint;
  bool resume = false;
  bool quiet = false;
  bool generate = false;
  GeneratorOptions generator;
  std::string output;
  bool table = false;  ///< the bodies go into a file of columns beside the scene
};

/// What is wrong with the arguments, as "WHERE: what is wrong".
struct ArgumentError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Tells `app` the options; its parse() fills in `arguments`.
void describe(CLI::App& app, Arguments& arguments);

/// Throws ArgumentError for arguments that make no sense, or contradict each other.
void check(const Arguments& arguments);

/// Throws ArgumentError for those that make none with this scene.
void check(const Arguments& arguments, const kds::io::Scene& scene);

/// Those of which a run that goes on must have the same.
std::vector<kds::io::SavedOption> saved_options(const Arguments& arguments);

/// Throws ArgumentError for those with which a run cannot go on from this checkpoint.
void check_resume(const Arguments& arguments, const kds::io::Scene& scene, const kds::io::Checkpoint& checkpoint);

}  // namespace kds_collide
