#include "python/py_world.hpp"

#include <pybind11/numpy.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace kds_python {

namespace py = pybind11;

namespace {

/// s of the wall clock: how long a run goes on before it looks whether Ctrl-C was pressed. Longer makes that slower to
/// answer, shorter costs more: some microseconds each time.
constexpr double patience = 0.1;

}  // namespace

PyWorld::PyWorld(int degree, bool turning, const kds::collision::WorldOptions& options, bool gather)
    : gather_(gather), world_(make_world(degree, turning, options, [this](const EventRow& event) { told(event); })) {}

AnyWorld& PyWorld::world() {
  if (running_ && runner_ != std::this_thread::get_id()) {
    throw std::runtime_error("World: it is running in another thread");
  }
  return *world_;
}

AnyWorld& PyWorld::to_change() {
  AnyWorld& changed = world();
  if (asked_ > 0) throw std::runtime_error("World: it cannot be changed while a filter is at work");
  return changed;
}

void PyWorld::told(const EventRow& event) {
  if (gather_) events_.push_back(event);
  const py::object& function = functions_[static_cast<std::size_t>(event.kind)];
  if (function) function(py::array_t<EventRow>(1, &event));
}

template <class Work>
auto PyWorld::run(const Work& work) {
  AnyWorld& world = to_change();
  if (running_) return work(world);  // from within a function that it calls: the world refuses
  struct Running {
    explicit Running(PyWorld& of) : of(of) {
      of.running_ = true;
      of.runner_ = std::this_thread::get_id();
    }
    ~Running() { of.running_ = false; }
    PyWorld& of;
  } running(*this);  // ends when the GIL is held again
  if (std::any_of(functions_.begin(), functions_.end(), [](const auto& f) { return bool(f); })) return work(world);
  const py::gil_scoped_release release;
  return work(world);
}

void PyWorld::advance_to(double t) {
  const double now = world().now();
  if (!std::isfinite(t) || t < now) {
    std::ostringstream text;
    text << "advance_to: the time must be finite and not before now, which is " << now << ", and is " << t;
    throw std::invalid_argument(text.str());
  }
  run([t](AnyWorld& world) {
    while (!world.advance_for(patience, t)) {
      const py::gil_scoped_acquire acquire;
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
  });
}

bool PyWorld::step(double limit) {
  return run([limit](AnyWorld& world) { return world.step(limit); });
}

void PyWorld::call_at(std::size_t kind, py::object function) {
  world();
  if (kind >= event_kinds) throw std::invalid_argument("on: there is no kind of event " + std::to_string(kind));
  functions_[kind] = function.is_none() ? py::object() : std::move(function);
}

std::vector<EventRow> PyWorld::take_events() {
  world();
  return std::exchange(events_, {});
}

int PyWorld::traverse(visitproc visit, void* arg) const {
  for (const py::object& function : functions_) Py_VISIT(function.ptr());
  return 0;
}

void PyWorld::forget_functions() {
  for (py::object& function : functions_) const py::object gone = std::move(function);
}

kds::collision::BroadPhaseKind broad_phase_named(const std::string& name) {
  std::string names;
  for (const auto& named : kds::collision::broad_phases) {
    if (named.name == name) return named.kind;
    names += (names.empty() ? "'" : ", '") + std::string(named.name) + "'";
  }
  throw std::invalid_argument("broad_phase: must be one of " + names + ", not '" + name + "'");
}

}  // namespace kds_python
