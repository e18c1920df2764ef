// kds._kds.World.
#include "collision/broad_phase/broad_phase_kind.hpp"
#include "collision/response/inertia.hpp"
#include "python/bindings.hpp"
#include "python/py_shape.hpp"
#include "python/py_world.hpp"

#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <vector>

namespace kds_python {
namespace {

namespace py = pybind11;
using namespace kds::collision;

// Arrays come from the Python files of the package, which have checked their shapes.
using Doubles = py::array_t<double, py::array::c_style>;
using Ids = py::array_t<std::uint64_t, py::array::c_style>;  // or other numbers of 64 bits
using Masks = py::array_t<std::uint32_t, py::array::c_style>;

Ids to_array(const std::vector<BodyId>& ids) { return Ids(static_cast<py::ssize_t>(ids.size()), ids.data()); }

std::vector<BodyId> to_vector(const Ids& ids) { return {ids.data(), ids.data() + ids.size()}; }

py::array_t<EventRow> to_array(const std::vector<EventRow>& rows) {
  return py::array_t<EventRow>(static_cast<py::ssize_t>(rows.size()), rows.data());
}

std::array<double, 3> coordinates(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

std::optional<PlacedShape> placed_shape(const std::optional<PyShape>& shape, const Eigen::Vector4d& q) {
  if (!shape) return std::nullopt;
  return place(shape->shape, Eigen::Quaterniond(q[0], q[1], q[2], q[3]));
}

std::unique_ptr<PyWorld> new_world(int degree, bool turning, bool gather, const std::string& response,
                                   const std::string& broad_phase,
                                   const std::optional<std::array<Eigen::Vector3d, 2>>& walls, double wall_restitution,
                                   double start_time, double window, double rate, int kdop, bool report_pairs,
                                   bool report_pieces, std::size_t threads, std::uint32_t zeno_contacts,
                                   double zeno_interval, double shortest_flight, double orientation_error,
                                   std::uint64_t most_edits) {
  WorldOptions options;
  if (response == "none") {
    options.response = Response::none;
  } else if (response == "elastic") {
    options.response = Response::elastic;
  } else if (response == "callback") {
    options.response = Response::callback;
  } else {
    throw std::invalid_argument("response: must be 'none', 'elastic' or 'callback', not '" + response + "'");
  }
  options.broad_phase = broad_phase_named(broad_phase);
  if (walls) options.walls = Walls{(*walls)[0], (*walls)[1], wall_restitution};
  options.start_time = start_time;
  options.window = window;
  options.rate = rate;
  options.kdop = kdop;
  options.report_pairs = report_pairs;
  options.report_pieces = report_pieces;
  options.threads = threads;
  options.zeno = {zeno_contacts, zeno_interval};
  options.shortest_flight = shortest_flight;
  options.orientation_error = orientation_error;
  options.most_edits = most_edits;
  return std::make_unique<PyWorld>(degree, turning, options, gather);
}

std::vector<Motion> to_motions(const Doubles& rows) {
  std::vector<Motion> motions(static_cast<std::size_t>(rows.shape(0)));
  for (std::size_t i = 0; i < motions.size(); ++i) motions[i] = to_motion(rows.data() + i * motion_length);
  return motions;
}

constexpr std::uint8_t is_fixed = 1;
constexpr std::uint8_t is_sensor = 2;

/// Adds a body a row; all, or none: then those that were added are removed again.
Ids add(PyWorld& self, const std::vector<PyShape>& shapes, const std::optional<Doubles>& radii, const Doubles& motions,
        const Doubles& numbers, const Masks& masks, const py::array_t<std::uint8_t, py::array::c_style>& flags,
        const Ids& user_data, const std::optional<Eigen::Matrix3d>& tensor, const Doubles& script) {
  AnyWorld& world = self.to_change();
  const auto bodies = static_cast<std::size_t>(motions.shape(0));
  const std::vector<Motion> later = to_motions(script);
  std::vector<BodyId> ids;
  ids.reserve(bodies);
  if (bodies > 1) world.reserve(world.size() + bodies);
  try {
    Description body;
    for (std::size_t i = 0; i < bodies; ++i) {
      if (radii) {
        body.shape = Sphere{radii->data()[i]};
      } else if (i == 0 || shapes.size() > 1) {
        body.shape = shapes[i].shape;
      }
      body.motion.assign(1, to_motion(motions.data() + i * motion_length));
      body.motion.insert(body.motion.end(), later.begin(), later.end());
      const double* number = numbers.data() + 6 * i;
      body.mass = number[0];
      body.inertia = tensor ? Inertia(*tensor) : Inertia(number[1]);
      body.restitution = number[2];
      body.friction = number[3];
      body.tangential_restitution = number[4];
      body.rolling_friction = number[5];
      std::tie(body.category, body.collides_with, body.group) =
          std::tuple(masks.data()[3 * i], masks.data()[3 * i + 1], masks.data()[3 * i + 2]);
      body.user_data = user_data.data()[i];
      body.fixed = (flags.data()[i] & is_fixed) != 0;
      body.sensor = (flags.data()[i] & is_sensor) != 0;
      ids.push_back(world.add_body(body));
    }
  } catch (const std::exception& error) {
    const std::string where = bodies > 1 ? "bodies[" + std::to_string(ids.size()) + "]: " : "";
    for (auto id = ids.rbegin(); id != ids.rend(); ++id) world.remove_body(*id);
    if (dynamic_cast<const std::invalid_argument*>(&error)) throw std::invalid_argument(where + error.what());
    throw;
  }
  return to_array(ids);
}

/// A sensor that moves with a body.
BodyId attach(PyWorld& self, const PyShape& shape, BodyId owner, const Masks& masks, std::uint64_t user_data) {
  Description body;
  body.shape = shape.shape;
  body.attached_to = owner;
  body.sensor = true;
  std::tie(body.category, body.collides_with, body.group) =
      std::tuple(masks.data()[0], masks.data()[1], masks.data()[2]);
  body.user_data = user_data;
  return self.to_change().add_body(body);
}

/// Position, velocity, acceleration, time, orientation and angular velocity of each at now.
Doubles motions_now(PyWorld& self, const Ids& ids, bool free) {
  AnyWorld& world = self.world();
  Doubles rows({ids.size(), static_cast<py::ssize_t>(motion_length)});
  double* row = rows.mutable_data();
  for (py::ssize_t i = 0; i < ids.size(); ++i, row += motion_length) {
    put(free ? world.free_motion_now(ids.data()[i]) : world.motion_now(ids.data()[i]), row);
  }
  return rows;
}

/// Categories, masks and groups.
Masks masks_of(PyWorld& self, const Ids& ids) {
  const AnyWorld& world = self.world();
  Masks both({ids.size(), py::ssize_t{3}});
  std::uint32_t* row = both.mutable_data();
  for (py::ssize_t i = 0; i < ids.size(); ++i, row += 3) {
    const BodyMasks masks = world.masks(ids.data()[i]);
    std::copy(masks.begin(), masks.end(), row);
  }
  return both;
}

void set_filters(PyWorld& self, const Ids& ids, const Masks& both) {
  std::vector<BodyMasks> masks(static_cast<std::size_t>(ids.size()));
  for (std::size_t i = 0; i < masks.size(); ++i)
    masks[i] = {both.data()[3 * i], both.data()[3 * i + 1], both.data()[3 * i + 2]};
  self.to_change().set_filters(to_vector(ids), masks.data());
}

/// Hits as events of the kind 0: a is the body, b the same.
std::vector<EventRow> to_rows(const AnyWorld& world, const std::vector<Hit>& hits) {
  std::vector<EventRow> rows;
  for (const Hit& hit : hits) {
    const std::uint64_t user_data = world.user_data(hit.body);
    rows.push_back(to_row(0, hit.body, hit.body, hit.contact, user_data, user_data));
  }
  return rows;
}

std::vector<EventRow> to_rows(const AnyWorld& world, const std::optional<Hit>& hit) {
  return hit ? to_rows(world, std::vector<Hit>{*hit}) : std::vector<EventRow>{};
}

py::dict counters(PyWorld& self) {
  const WorldCounters c = self.world().counters();
  py::dict d;
  d["contacts"] = c.contacts;
  d["separations"] = c.separations;
  d["overlaps"] = c.overlaps;
  d["wall_contacts"] = c.wall_contacts;
  d["motion_updates"] = c.motion_updates;
  d["rebounds_suppressed"] = c.rebounds_suppressed;
  d["pairs_begun"] = c.pairs_begun;
  d["pair_tests"] = c.pair_tests;
  d["swaps"] = c.broad_phase.swaps;
  d["certificates"] = c.broad_phase.certificates;
  d["rotation_pieces"] = c.rotation_pieces;
  d["orientation_resets"] = c.orientation_resets;
  return d;
}

/// The world of a Python object; null while it is being made.
PyWorld* made(PyObject* object) {
  return static_cast<PyWorld*>(reinterpret_cast<py::detail::instance*>(object)->get_value_and_holder().value_ptr());
}

/// Lets Python's garbage collector find worlds that are held by functions which they call.
void collect_garbage(PyHeapTypeObject* heap_type) {
  PyTypeObject& type = heap_type->ht_type;
  type.tp_flags |= Py_TPFLAGS_HAVE_GC;
  type.tp_traverse = [](PyObject* object, visitproc visit, void* arg) {
    Py_VISIT(Py_TYPE(object));
    const PyWorld* const world = made(object);
    return world ? world->traverse(visit, arg) : 0;
  };
  type.tp_clear = [](PyObject* object) {
    if (PyWorld* const world = made(object)) world->forget_functions();
    return 0;
  };
}

void bind_queries(py::class_<PyWorld>& world) {
  using Filter = AnyWorld::Filter;
  world.def("in_box", [](PyWorld& self, const Eigen::Vector3d& min, const Eigen::Vector3d& max) {
    return to_array(self.world().in_box(min, max));
  });
  world.def("cast", [](PyWorld& self, const std::optional<PyShape>& shape, const Eigen::Vector4d& q,
                       const Eigen::Vector3d& from, const Eigen::Vector3d& to, bool all, const Filter& filter) {
    const std::optional<PlacedShape> placed = placed_shape(shape, q);
    return to_array(self.ask([&](AnyWorld& w) { return to_rows(w, w.cast(placed, from, to, all, filter)); }));
  });
  world.def("overlapping", [](PyWorld& self, const PyShape& shape, const Eigen::Vector4d& q, const Eigen::Vector3d& at,
                              const Filter& filter) {
    const PlacedShape placed = place(shape.shape, Eigen::Quaterniond(q[0], q[1], q[2], q[3]));
    return to_array(self.ask([&](AnyWorld& w) { return w.overlapping(placed, at, filter); }));
  });
  world.def("nearest", [](PyWorld& self, const std::optional<PyShape>& shape, const Eigen::Vector4d& q,
                          const Eigen::Vector3d& to, std::size_t count, const Filter& filter) {
    const std::optional<PlacedShape> placed = placed_shape(shape, q);
    std::vector<NearRow> rows;
    for (const NearBody& near : self.ask([&](AnyWorld& w) { return w.nearest(placed, to, count, filter); })) {
      rows.push_back({near.body, near.distance, coordinates(near.point), coordinates(near.from_point)});
    }
    return py::array_t<NearRow>(static_cast<py::ssize_t>(rows.size()), rows.data());
  });
  world.def("distance_between", [](PyWorld& self, BodyId a, BodyId b) {
    const ShapeDistance found = self.world().distance_between(a, b);
    return py::make_tuple(found.distance, found.of_a, found.of_b);
  });
  world.def("next_contact",
            [](PyWorld& self, const PyShape& shape, const Doubles& motion, double until, const Filter& filter) {
              const Motion moved = to_motion(motion.data());
              return to_array(
                  self.ask([&](AnyWorld& w) { return to_rows(w, w.next_contact(shape.shape, moved, until, filter)); }));
            });
  world.def("next_contact_of", [](PyWorld& self, BodyId body, double until, const Filter& filter) {
    return to_array(self.ask([&](AnyWorld& w) { return to_rows(w, w.next_contact_of(body, until, filter)); }));
  });
  world.def("next_contact_between", [](PyWorld& self, BodyId a, BodyId b, double until) {
    const AnyWorld& w = self.world();
    const auto contact = w.next_contact_between(a, b, until);
    if (!contact) return to_array(std::vector<EventRow>{});
    return to_array(std::vector{to_row(0, a, b, *contact, w.user_data(a), w.user_data(b))});
  });
  world.def("closest_approach", [](PyWorld& self, BodyId a, BodyId b, double until) {
    const Approach approach = self.world().closest_approach(a, b, until);
    return std::array{approach.time, approach.distance};
  });
  world.def("partners", [](PyWorld& self, BodyId id) { return to_array(self.world().partners(id)); });
  world.def("touching", [](PyWorld& self, BodyId a, BodyId b) { return self.world().touching(a, b); });
  world.def("resting", [](PyWorld& self, BodyId a, BodyId b) { return self.world().resting(a, b); });
  world.def("resting_at_wall", [](PyWorld& self, BodyId a, int wall) { return self.world().resting_at_wall(a, wall); });
}

}  // namespace

void bind_world(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(FeatureRow, kind, first, second);
  PYBIND11_NUMPY_DTYPE(EventRow, time, kind, a, b, point, normal, feature_a, feature_b, user_data_a, user_data_b);
  PYBIND11_NUMPY_DTYPE(NearRow, body, distance, point, from_point);
  module.attr("event_dtype") = py::dtype::of<EventRow>();
  std::vector<std::string_view> kinds(kds::io::event_kind_names.begin(), kds::io::event_kind_names.end());
  kinds.insert(kinds.end(), {"piece", "timer"});
  module.attr("event_kinds") = kinds;

  py::class_<PyWorld> world(module, "World", py::custom_type_setup(&collect_garbage));
  world.def(py::init(&new_world), py::kw_only(), py::arg("degree"), py::arg("turning"), py::arg("gather"),
            py::arg("response"), py::arg("broad_phase"), py::arg("walls"), py::arg("wall_restitution"),
            py::arg("start_time"), py::arg("window"), py::arg("rate"), py::arg("kdop"), py::arg("report_pairs"),
            py::arg("report_pieces"), py::arg("threads"), py::arg("zeno_contacts"), py::arg("zeno_interval"),
            py::arg("shortest_flight"), py::arg("orientation_error"), py::arg("most_edits"));
  world.def("add", &add);
  world.def("remove", [](PyWorld& self, BodyId id) { self.to_change().remove_body(id); });
  world.def("update", [](PyWorld& self, const Ids& ids, const Doubles& motions) {
    self.to_change().update_motions(to_vector(ids), to_motions(motions));
  });
  world.def("update_script", [](PyWorld& self, BodyId id, const Doubles& pieces) {
    self.to_change().update_motion(id, to_motions(pieces));
  });
  world.def("append", [](PyWorld& self, BodyId id, const Doubles& pieces) {
    self.to_change().append_motion(id, to_motions(pieces));
  });
  world.def("set_masses", [](PyWorld& self, const Ids& ids, const Doubles& masses) {
    self.to_change().set_masses(to_vector(ids), masses.data());
  });
  world.def("set_restitutions", [](PyWorld& self, const Ids& ids, const Doubles& restitutions) {
    self.to_change().set_restitutions(to_vector(ids), restitutions.data());
  });
  world.def("set_filters", &set_filters);
  world.def("set_user_data", [](PyWorld& self, const Ids& ids, const Ids& user_data) {
    self.to_change().set_user_data(to_vector(ids), user_data.data());
  });
  world.def("set_timer", [](PyWorld& self, double t) { return self.to_change().set_timer(t); });
  world.def("cancel_timer", [](PyWorld& self, TimerId timer) { return self.to_change().cancel_timer(timer); });
  world.def("motions_now", &motions_now);
  world.def("advance_to", &PyWorld::advance_to);
  world.def("step", &PyWorld::step);
  world.def("next_time", [](PyWorld& self) { return self.to_change().next_time(); });
  world.def("call_at", &PyWorld::call_at);
  world.def("take_events", [](PyWorld& self) { return to_array(self.take_events()); });
  world.def("now", [](PyWorld& self) { return self.world().now(); });
  world.def("size", [](PyWorld& self) { return self.world().size(); });
  world.def("contains", [](PyWorld& self, BodyId id) { return self.world().contains(id); });
  world.def("shape", [](PyWorld& self, BodyId id) { return PyShape{self.world().shape(id)}; });
  world.def("mass", [](PyWorld& self, BodyId id) { return self.world().mass(id); });
  world.def("fixed", [](PyWorld& self, BodyId id) { return self.world().fixed(id); });
  world.def("sensor", [](PyWorld& self, BodyId id) { return self.world().sensor(id); });
  world.def("restitution", [](PyWorld& self, BodyId id) { return self.world().restitution(id); });
  world.def("masks", &masks_of);
  world.def("attach", &attach);
  world.def("ignore_pair",
            [](PyWorld& self, BodyId a, BodyId b, bool ignored) { self.to_change().ignore_pair(a, b, ignored); });
  world.def("ignores_pair", [](PyWorld& self, BodyId a, BodyId b) { return self.world().ignores_pair(a, b); });
  world.def("user_data", [](PyWorld& self, BodyId id) { return self.world().user_data(id); });
  world.def("broad_phase", [](PyWorld& self) { return std::string(self.world().broad_phase()); });
  world.def("counters", &counters);
  world.def("audit", [](PyWorld& self) { self.world().audit(); });
  world.def("save", [](PyWorld& self) {
    std::ostringstream out;
    kds::write(out, self.world().save());
    return py::bytes(out.str());
  });
  world.def("load", [](PyWorld& self, const py::bytes& bytes) {
    std::istringstream in{std::string(bytes)};
    self.to_change().restore(kds::read_snapshot(in));
  });
  bind_queries(world);
}

}  // namespace kds_python
