// kds._kds.World.
#include "collision/broad_phase/broad_phase_kind.hpp"
#include "python/bind_held.hpp"
#include "python/bindings.hpp"

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <vector>

namespace kds_python {
namespace {

using namespace kds::collision;

std::array<double, 3> coordinates(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

std::optional<PlacedShape> placed_shape(const std::optional<PyShape>& shape, const Eigen::Vector4d& q) {
  if (!shape) return std::nullopt;
  return place(shape->shape, Eigen::Quaterniond(q[0], q[1], q[2], q[3]));
}

std::unique_ptr<PyWorld> new_world(int degree, bool turning, std::size_t domains, bool gather, bool record,
                                   const std::string& response, const std::string& broad_phase,
                                   const std::optional<std::array<Eigen::Vector3d, 2>>& walls, double wall_restitution,
                                   double start_time, double window, double rate, int kdop, bool report_pairs,
                                   bool report_pieces, std::size_t threads, std::uint32_t zeno_contacts,
                                   double zeno_interval, double shortest_flight, double orientation_error,
                                   std::uint64_t most_edits, bool profile) {
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
  options.profile = profile;
  return hold_world({degree, turning, domains, record}, options, gather);
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

ContactMode mode_named(const std::string& name) {
  if (name == "resolved") return ContactMode::resolved;
  if (name == "transparent") return ContactMode::transparent;
  throw std::invalid_argument("mode: must be 'resolved' or 'transparent', not '" + name + "'");
}

/// (n, 2)
Ids contact_pairs(PyWorld& self) {
  const std::vector<BodyPair> pairs = self.world().contact_pairs();
  Ids rows({static_cast<py::ssize_t>(pairs.size()), py::ssize_t{2}});
  std::uint64_t* row = rows.mutable_data();
  for (const BodyPair& pair : pairs) *row++ = pair.a, *row++ = pair.b;
  return rows;
}

void bind_queries(py::class_<PyWorld>& world) {
  using Filter = AnyWorld::Filter;
  world.def("bodies", [](PyWorld& self) { return to_array(self.world().bodies()); });
  world.def("in_box", [](PyWorld& self, const Eigen::Vector3d& min, const Eigen::Vector3d& max) {
    return to_array(self.world().in_box(min, max));
  });
  world.def("in_moving_box", [](PyWorld& self, const Doubles& motion, const Eigen::Vector3d& extent, double until) {
    return to_array(self.world().in_moving_box(to_motion(motion.data()), extent, until));
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
  world.def("next_contacts",
            [](PyWorld& self, const PyShape& shape, const Doubles& motion, double until, const Filter& filter) {
              const Motion moved = to_motion(motion.data());
              return to_array(self.ask(
                  [&](AnyWorld& w) { return to_rows(w, w.next_contacts(shape.shape, moved, until, filter)); }));
            });
  world.def("next_contact_of", [](PyWorld& self, BodyId body, double until, const Filter& filter,
                                  const std::string& name) {
    const ContactMode mode = mode_named(name);
    return to_array(self.ask([&](AnyWorld& w) { return to_rows(w, w.next_contact_of(body, until, filter, mode)); }));
  });
  world.def("next_contacts_of", [](PyWorld& self, BodyId body, double until, const Filter& filter,
                                   const std::string& name) {
    const ContactMode mode = mode_named(name);
    return to_array(self.ask([&](AnyWorld& w) { return to_rows(w, w.next_contacts_of(body, until, filter, mode)); }));
  });
  world.def("next_contact_between", [](PyWorld& self, BodyId a, BodyId b, double until, const std::string& name) {
    const AnyWorld& w = self.world();
    const auto contact = w.next_contact_between(a, b, until, mode_named(name));
    if (!contact) return to_array(std::vector<EventRow>{});
    return to_array(std::vector{to_row(0, a, b, *contact, w.user_data(a), w.user_data(b))});
  });
  world.def("closest_approach", [](PyWorld& self, BodyId a, BodyId b, double until) {
    const Approach approach = self.world().closest_approach(a, b, until);
    return std::array{approach.time, approach.distance};
  });
  world.def("pairs_nearer_than", [](PyWorld& self, double distance, double until, const Filter& filter) {
    std::vector<NearPairRow> rows;
    for (const NearPair& near : self.ask([&](AnyWorld& w) { return w.pairs_nearer_than(distance, until, filter); })) {
      rows.push_back({near.pair.a, near.pair.b, near.approach.time, near.approach.distance});
    }
    return to_array(rows);
  });
  world.def("contact_pairs", &contact_pairs);
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
  PYBIND11_NUMPY_DTYPE(NearPairRow, a, b, time, distance);
  module.attr("event_dtype") = py::dtype::of<EventRow>();
  std::vector<std::string_view> kinds(kds::io::event_kind_names.begin(), kds::io::event_kind_names.end());
  kinds.insert(kinds.end(), {"piece", "timer", "wrap"});
  module.attr("event_kinds") = kinds;

  py::class_<PyWorld> world = bind_held<PyWorld>(module, "World");
  world.def(py::init(&new_world), py::kw_only(), py::arg("degree"), py::arg("turning"), py::arg("domains"),
            py::arg("gather"), py::arg("record"), py::arg("response"), py::arg("broad_phase"), py::arg("walls"),
            py::arg("wall_restitution"), py::arg("start_time"), py::arg("window"), py::arg("rate"), py::arg("kdop"),
            py::arg("report_pairs"), py::arg("report_pieces"), py::arg("threads"), py::arg("zeno_contacts"),
            py::arg("zeno_interval"), py::arg("shortest_flight"), py::arg("orientation_error"), py::arg("most_edits"),
            py::arg("profile"));
  world.def("append", [](PyWorld& self, BodyId id, const Doubles& pieces) {
    self.to_change().append_motion(id, to_motions(pieces));
  });
  world.def("update_vertices", [](PyWorld& self, BodyId id, const std::vector<double>& times,
                                  const std::vector<Eigen::Vector3d>& positions) {
    self.to_change().update_vertices(id, to_keyframes(times, positions));
  });
  world.def("set_masses", [](PyWorld& self, const Ids& ids, const Doubles& masses) {
    self.to_change().set_masses(to_vector(ids), masses.data());
  });
  world.def("set_filters", &set_filters);
  world.def("set_user_data", [](PyWorld& self, const Ids& ids, const Ids& user_data) {
    self.to_change().set_user_data(to_vector(ids), user_data.data());
  });
  world.def("set_timer", [](PyWorld& self, double t) { return self.to_change().set_timer(t); });
  world.def("cancel_timer", [](PyWorld& self, TimerId timer) { return self.to_change().cancel_timer(timer); });
  world.def("next_time", [](PyWorld& self) { return self.to_change().next_time(); });
  world.def("shape", [](PyWorld& self, BodyId id) { return PyShape{self.world().shape(id)}; });
  world.def("vertices", [](PyWorld& self, BodyId id) { return self.world().vertices(id); });
  world.def("free_turning", [](PyWorld& self, BodyId id) {
    const FreeTurning turning = self.world().free_turning(id);
    const Eigen::Quaterniond& q = turning.orientation;
    return py::make_tuple(Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()), turning.angular_velocity,
                          turning.angular_momentum);
  });
  world.def("mass", [](PyWorld& self, BodyId id) { return self.world().mass(id); });
  world.def("fixed", [](PyWorld& self, BodyId id) { return self.world().fixed(id); });
  world.def("attached_to", [](PyWorld& self, BodyId id) { return self.world().attached_to(id); });
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
  world.def("profile", [](PyWorld& self) { return seconds_by_work(self.world().profile()); });
  bind_queries(world);
}

}  // namespace kds_python
