// Scenes of the tool's generator, ready to run.
#pragma once

#include "examples/kds-collide/generator.hpp"
#include "io/scene_reader.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace kds::benchmarks {

/// Generates and reads back, by way of a folder of this process that is removed again.
inline kds::io::Scene generated_scene(const kds_collide::GeneratorOptions& options) {
  const kds_collide::GeneratedScene generated = kds_collide::generate_scene(options);
  const auto folder = std::filesystem::temp_directory_path() / ("kds-bench-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  for (const auto& mesh : generated.meshes) std::ofstream(folder / mesh.name) << mesh.text;
  kds::io::Scene scene = kds::io::parse_scene(generated.json, folder / "scene.json");
  std::filesystem::remove_all(folder);
  return scene;
}

}  // namespace kds::benchmarks
