// What worlds of all types have, bound.
#pragma once

#include "collision/response/inertia.hpp"
#include "python/arrays.hpp"
#include "python/py_shape.hpp"
#include "python/py_world.hpp"

#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace kds_python {

using Ids = py::array_t<std::uint64_t, py::array::c_style>;  // or other numbers of 64 bits
using Masks = py::array_t<std::uint32_t, py::array::c_style>;

inline Ids to_array(const std::vector<BodyId>& ids) { return Ids(static_cast<py::ssize_t>(ids.size()), ids.data()); }

inline std::vector<BodyId> to_vector(const Ids& ids) { return {ids.data(), ids.data() + ids.size()}; }

inline std::vector<Motion> to_motions(const Doubles& rows) {
  std::vector<Motion> motions(static_cast<std::size_t>(rows.shape(0)));
  for (std::size_t i = 0; i < motions.size(); ++i) motions[i] = to_motion(rows.data() + i * motion_length);
  return motions;
}

inline constexpr std::uint8_t is_fixed = 1;
inline constexpr std::uint8_t is_sensor = 2;
inline constexpr std::uint8_t meets_itself = 4;

/// Adds a body a row of `motions`, each with as many of the pieces of `script`; all, or none: then those that were
/// added are removed again.
template <class Held>
Ids add_rows(Held& self, const std::vector<PyShape>& shapes, const std::optional<Doubles>& radii,
             const Doubles& motions, const Doubles& numbers, const Masks& masks,
             const py::array_t<std::uint8_t, py::array::c_style>& flags, const Ids& user_data,
             const std::optional<Eigen::Matrix3d>& tensor, const Doubles& script) {
  auto& world = self.to_change();
  const auto bodies = static_cast<std::size_t>(motions.shape(0));
  const std::vector<Motion> later = to_motions(script);
  const std::size_t each = later.size() / std::max<std::size_t>(bodies, 1);
  std::vector<BodyId> ids;
  ids.reserve(bodies);
  // It takes as long as there are bodies: so not for each few of many that come.
  if (bodies > 1 && 2 * bodies >= world.size()) world.reserve(world.size() + bodies);
  try {
    Description body;
    for (std::size_t i = 0; i < bodies; ++i) {
      if (radii) {
        body.shape = kds::collision::Sphere{radii->data()[i]};
      } else if (i == 0 || shapes.size() > 1) {
        body.shape = shapes[i].shape;
      }
      body.motion.assign(1, to_motion(motions.data() + i * motion_length));
      const auto first = later.begin() + static_cast<std::ptrdiff_t>(i * each);
      body.motion.insert(body.motion.end(), first, first + static_cast<std::ptrdiff_t>(each));
      const double* number = numbers.data() + 6 * i;
      body.mass = number[0];
      body.inertia = tensor ? kds::collision::Inertia(*tensor) : kds::collision::Inertia(number[1]);
      body.restitution = number[2];
      body.friction = number[3];
      body.tangential_restitution = number[4];
      body.rolling_friction = number[5];
      std::tie(body.category, body.collides_with, body.group) =
          std::tuple(masks.data()[3 * i], masks.data()[3 * i + 1], masks.data()[3 * i + 2]);
      body.user_data = user_data.data()[i];
      body.fixed = (flags.data()[i] & is_fixed) != 0;
      body.sensor = (flags.data()[i] & is_sensor) != 0;
      body.self_contacts = (flags.data()[i] & meets_itself) != 0;
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

/// The motion of each at now.
template <class Held>
Doubles motions_now(Held& self, const Ids& ids, bool free) {
  auto& world = self.world();
  Doubles rows({ids.size(), static_cast<py::ssize_t>(motion_length)});
  double* row = rows.mutable_data();
  for (py::ssize_t i = 0; i < ids.size(); ++i, row += motion_length) {
    put(free ? world.free_motion_now(ids.data()[i]) : world.motion_now(ids.data()[i]), row);
  }
  return rows;
}

/// The world of a Python object; null while it is being made.
template <class Held>
Held* made(PyObject* object) {
  return static_cast<Held*>(reinterpret_cast<py::detail::instance*>(object)->get_value_and_holder().value_ptr());
}

/// Lets Python's garbage collector find worlds that are held by functions which they call.
template <class Held>
void collect_garbage(PyHeapTypeObject* heap_type) {
  PyTypeObject& type = heap_type->ht_type;
  type.tp_flags |= Py_TPFLAGS_HAVE_GC;
  type.tp_traverse = [](PyObject* object, visitproc visit, void* arg) {
    Py_VISIT(Py_TYPE(object));
    const Held* const world = made<Held>(object);
    return world ? world->traverse(visit, arg) : 0;
  };
  type.tp_clear = [](PyObject* object) {
    if (Held* const world = made<Held>(object)) world->forget_functions();
    return 0;
  };
}

/// A class whose objects are worlds, with what all of them have.
template <class Held>
py::class_<Held> bind_held(py::module_& module, const char* name) {
  py::class_<Held> world(module, name, py::custom_type_setup(&collect_garbage<Held>));
  world.def("add", &add_rows<Held>);
  world.def("remove", [](Held& self, BodyId id) { self.to_change().remove_body(id); });
  world.def("update", [](Held& self, const Ids& ids, const Doubles& motions) {
    self.to_change().update_motions(to_vector(ids), to_motions(motions));
  });
  world.def("set_restitutions", [](Held& self, const Ids& ids, const Doubles& restitutions) {
    self.to_change().set_restitutions(to_vector(ids), restitutions.data());
  });
  world.def("motions_now", &motions_now<Held>);
  world.def("advance_to", &Held::advance_to);
  world.def("advance_for", &Held::advance_for);
  world.def("step", &Held::step);
  world.def("call_at", &Held::call_at);
  world.def("take_events", [](Held& self) { return to_array(self.take_events()); });
  world.def("now", [](Held& self) { return self.world().now(); });
  world.def("size", [](Held& self) { return self.world().size(); });
  world.def("contains", [](Held& self, BodyId id) { return self.world().contains(id); });
  world.def("audit", [](Held& self) { self.world().audit(); });
  world.def("save", [](Held& self) {
    std::ostringstream out;
    kds::write(out, self.world().save());
    return py::bytes(out.str());
  });
  world.def("load", [](Held& self, const py::bytes& bytes) {
    std::istringstream in{std::string(bytes)};
    self.to_change().restore(kds::read_snapshot(in));
  });
  world.def("write_replay", [](Held& self, const std::string& file, const std::string& title) {
    self.world().write_replay(file, title);
  });
  world.def("write_gltf", [](Held& self, const std::string& file, const std::string& title, double frames_per_second) {
    self.world().write_gltf(file, title, frames_per_second);
  });
  world.def("write_vtk", [](Held& self, const std::string& file, double frames_per_second) {
    self.world().write_vtk(file, frames_per_second);
  });
  return world;
}

}  // namespace kds_python
