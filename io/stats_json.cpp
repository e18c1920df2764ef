#include "io/stats_json.hpp"

#include <nlohmann/json.hpp>

namespace kds::io {

std::string to_json(const RunResult& result, const RunOptions& options, double read_cpu_seconds) {
  nlohmann::ordered_json json;
  json["broad_phase"] = result.broad_phase;
  json["rate"] = options.rate;
  json["cpu_seconds"] = result.setup_cpu_seconds + result.run_cpu_seconds;
  json["setup_cpu_seconds"] = result.setup_cpu_seconds;
  json["run_cpu_seconds"] = result.run_cpu_seconds;
  json["read_cpu_seconds"] = read_cpu_seconds;
  json["sim_seconds"] = result.sim_seconds;
  json["bodies"] = result.bodies;
  json["swaps"] = result.swaps;
  json["certificates"] = result.certificates;
  json["box_updates"] = result.box_updates;
  json["pairs_begun"] = result.pairs_begun;
  json["pair_tests"] = result.pair_tests;
  json["contacts"] = result.contacts;
  json["separations"] = result.separations;
  json["overlaps"] = result.overlaps;
  json["wall_contacts"] = result.wall_contacts;
  json["motion_updates"] = result.motion_updates;
  json["rotation_pieces"] = result.rotation_pieces;
  json["orientation_resets"] = result.orientation_resets;
  json["held"] = result.held;
  if (options.domains != 1 || options.processes) {
    json["domains"] = result.domains;
    json["windows"] = result.windows;
    json["windows_failed"] = result.windows_failed;
    json["bodies_owned"] = result.bodies_owned;
    json["bodies_known"] = result.bodies_known;
  }
  if (options.processes) {
    json["processes"] = result.processes;
    json["exchanges"] = result.exchanges;
    json["messages"] = result.messages;
    json["bytes_exchanged"] = result.bytes_exchanged;
  }
  json["peak_memory_bytes"] = result.peak_memory_bytes;
  return json.dump(2) + '\n';
}

}  // namespace kds::io
