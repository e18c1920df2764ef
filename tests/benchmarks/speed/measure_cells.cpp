#include "tests/benchmarks/speed/report.hpp"
namespace speed { std::vector<Target> measure_cells(const Settings&) { return {}; } }
