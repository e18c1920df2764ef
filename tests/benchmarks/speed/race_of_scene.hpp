// Our methods on a scene of the tool: meshes, boxes, whatever it can hold.
#pragma once

#include "io/scene.hpp"
#include "tests/benchmarks/speed/race.hpp"

#include <string>
#include <vector>

namespace speed {

/// One run; its hash is of the times of all events.
Run run_scene(const kds::io::Scene& scene, const std::string& method, double rate);

/// All methods, the default first, however slow. Throws std::runtime_error where one has other events.
std::vector<Result> race_methods(const kds::io::Scene& scene, double rate, bool quick);

/// The result of one method; throws std::runtime_error where there is none.
const Result& of(const std::vector<Result>& results, const std::string& method);

}  // namespace speed
