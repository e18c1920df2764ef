// What a run took, as JSON.
#pragma once

#include "io/run.hpp"

#include <string>

namespace kds::io {

/// `read_cpu_seconds`: what reading the scene took, which is not part of `cpu_seconds`.
std::string to_json(const RunResult& result, const RunOptions& options, double read_cpu_seconds);

}  // namespace kds::io
