#include "examples/kds-collide/tasks.hpp"

#include "collision/broad_phase/broad_phase_kind.hpp"
#include "io/event_parts.hpp"
#include "io/output_file.hpp"
#include "io/scene_reader.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <list>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>

namespace kds_collide {

using namespace kds::io;

void list_broad_phases() {
  OutputFile out("-");
  for (const auto& b : kds::collision::broad_phases) {
    std::string line(b.name);
    line.resize(std::max<std::size_t>(line.size(), 12), ' ');
    out.write(line + ' ' + std::string(b.what) + '\n');
  }
  out.commit();
}

void generate(const Arguments& arguments) {
  const std::filesystem::path file = arguments.output.empty() ? arguments.generator.kind + ".json" : arguments.output;
  GeneratorOptions options = arguments.generator;
  if (arguments.table) options.table = std::filesystem::path(file).replace_extension(".h5").filename().string();
  if (arguments.table && options.table == file.filename())
    throw ArgumentError("--output: is the name of the table too");
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
    std::fprintf(stderr, "%s: %zu %s", file.c_str(), options.bodies, options.kind.c_str());
    if (has_density(options.kind)) std::fprintf(stderr, ", density %g", options.density.value_or(default_density));
    std::fprintf(stderr, ", seed %llu\n", static_cast<unsigned long long>(options.seed));
  }
}

void merge(const Arguments& arguments) {
  const Scene scene = read_scene(arguments.scene, arguments.until);
  check(arguments, scene);
  EventParts parts(arguments.merge, fingerprint(scene), scene.bodies.size());
  OutputFile output(arguments.events);
  // Each has a step in memory: more than can run at once would take memory for nothing.
  const std::size_t most = std::max(1u, std::thread::hardware_concurrency());
  const std::size_t threads = arguments.run.threads > 0 ? std::min(arguments.run.threads, most) : most;
  merge_as_csv(parts, scene, threads, [&](std::string_view lines) { output.write(lines); });
  output.commit();
}

}  // namespace kds_collide
