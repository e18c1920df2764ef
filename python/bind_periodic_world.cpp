// kds._kds.PeriodicWorld.
#include "collision/periodic/periodic_options.hpp"
#include "python/bind_held.hpp"
#include "python/bindings.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <utility>

namespace kds_python {
namespace {

using namespace kds::collision;

Boundary boundary_named(const std::string& name) {
  if (name == "periodic") return Boundary::periodic;
  if (name == "walls") return Boundary::walls;
  if (name == "open") return Boundary::open;
  throw std::invalid_argument("boundaries: must be 'periodic', 'walls' or 'open', not '" + name + "'");
}

std::unique_ptr<PyPeriodicWorld> new_periodic_world(int degree, bool gather, bool record, const Eigen::Vector3d& min,
                                                    const Eigen::Vector3d& max,
                                                    const std::array<std::string, 3>& boundaries, double shear_rate,
                                                    double wall_restitution,
                                                    const std::array<double, 6>& wall_temperatures, std::uint64_t seed,
                                                    double elastic_within, const std::string& broad_phase,
                                                    double start_time, double window, std::size_t threads) {
  PeriodicOptions options;
  options.min = min;
  options.max = max;
  std::transform(boundaries.begin(), boundaries.end(), options.boundaries.begin(), boundary_named);
  options.shear_rate = shear_rate;
  options.wall_restitution = wall_restitution;
  options.wall_temperatures = wall_temperatures;
  options.seed = seed;
  options.elastic_within = elastic_within;
  options.world.broad_phase = broad_phase_named(broad_phase);
  options.world.start_time = start_time;
  options.world.window = window;
  options.world.threads = threads;
  return std::make_unique<PyPeriodicWorld>(
      [&](AnyPeriodicWorld::Listener listener) {
        return make_periodic_world(degree, record, options, std::move(listener));
      },
      gather);
}

py::array_t<std::int64_t> crossings(PyPeriodicWorld& self, const Ids& ids) {
  py::array_t<std::int64_t> rows({ids.size(), py::ssize_t{3}});
  std::int64_t* row = rows.mutable_data();
  for (py::ssize_t i = 0; i < ids.size(); ++i, row += 3) {
    const Offset offset = self.world().crossings(ids.data()[i]);
    std::copy(offset.begin(), offset.end(), row);
  }
  return rows;
}

Doubles ways_wrapped(PyPeriodicWorld& self, const Ids& ids) {
  Doubles rows({ids.size(), py::ssize_t{3}});
  double* row = rows.mutable_data();
  for (py::ssize_t i = 0; i < ids.size(); ++i, row += 3) {
    Eigen::Vector3d::Map(row) = self.world().way_wrapped(ids.data()[i]);
  }
  return rows;
}

py::dict periodic_counters(PyPeriodicWorld& self) {
  const PeriodicCounters c = self.world().counters();
  py::dict d;
  d["contacts"] = c.contacts;
  d["wraps"] = c.wraps;
  d["images_made"] = c.images_made;
  d["images_ended"] = c.images_ended;
  return d;
}

}  // namespace

void bind_periodic_world(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(PeriodicRow, event, offset, impulse);
  py::class_<PyPeriodicWorld> world = bind_held<PyPeriodicWorld>(module, "PeriodicWorld");
  world.def(py::init(&new_periodic_world), py::kw_only(), py::arg("degree"), py::arg("gather"), py::arg("record"),
            py::arg("min"), py::arg("max"), py::arg("boundaries"), py::arg("shear_rate"), py::arg("wall_restitution"),
            py::arg("wall_temperatures"), py::arg("seed"), py::arg("elastic_within"), py::arg("broad_phase"),
            py::arg("start_time"), py::arg("window"), py::arg("threads"));
  world.def("bodies", [](PyPeriodicWorld& self) { return to_array(self.world().bodies()); });
  world.def("crossings", &crossings);
  world.def("ways_wrapped", &ways_wrapped);
  world.def("counters", &periodic_counters);
}

}  // namespace kds_python
