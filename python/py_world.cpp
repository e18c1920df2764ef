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

template <class World, class Row>
HeldWorld<World, Row>::HeldWorld(const std::function<std::unique_ptr<World>(Listener)>& make, bool gather,
                                 Functions functions)
    : gather_(gather), allowed_(functions), world_(make([this](const Row& event) { told(event); })) {}

template <class World, class Row>
World& HeldWorld<World, Row>::world() {
  if (running_ && runner_ != std::this_thread::get_id()) {
    throw std::runtime_error("World: it is running in another thread");
  }
  return *world_;
}

template <class World, class Row>
World& HeldWorld<World, Row>::to_change() {
  World& changed = world();
  if (asked_ > 0) throw std::runtime_error("World: it cannot be changed while a filter is at work");
  return changed;
}

template <class World, class Row>
void HeldWorld<World, Row>::told(const Row& event) {
  if (gather_) events_.push_back(event);
  const py::object& function = functions_[static_cast<std::size_t>(kind_of(event))];
  if (function) function(py::array_t<Row>(1, &event));
}

template <class World, class Row>
template <class Work>
auto HeldWorld<World, Row>::run(const Work& work) {
  World& world = to_change();
  if (running_) return work(world);  // from within a function that it calls: the world refuses
  struct Running {
    explicit Running(HeldWorld& of) : of(of) {
      of.running_ = true;
      of.runner_ = std::this_thread::get_id();
    }
    ~Running() { of.running_ = false; }
    HeldWorld& of;
  } running(*this);  // ends when the GIL is held again
  if (std::any_of(functions_.begin(), functions_.end(), [](const auto& f) { return bool(f); })) return work(world);
  const py::gil_scoped_release release;
  return work(world);
}

template <class World, class Row>
void HeldWorld<World, Row>::advance_to(double t) {
  const double now = world().now();
  if (!std::isfinite(t) || t < now) {
    std::ostringstream text;
    text << "advance_to: the time must be finite and not before now, which is " << now << ", and is " << t;
    throw std::invalid_argument(text.str());
  }
  // The world would name the function that is called here.
  if (running_) throw std::runtime_error("World::advance_to: must not be called from within a callback");
  run([t](World& world) {
    while (!world.advance_for(patience, t)) {
      const py::gil_scoped_acquire acquire;
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
  });
}

template <class World, class Row>
bool HeldWorld<World, Row>::advance_for(double budget, double t) {
  if (allowed_ == Functions::refused) {
    throw std::runtime_error("World::advance_for: a world in domains goes by advance_to()");
  }
  return run([budget, t](World& world) { return world.advance_for(budget, t); });
}

template <class World, class Row>
bool HeldWorld<World, Row>::step(double limit) {
  return run([limit](World& world) { return world.step(limit); });
}

template <class World, class Row>
void HeldWorld<World, Row>::call_at(std::size_t kind, py::object function) {
  world();
  if (allowed_ == Functions::refused && !function.is_none()) {
    throw std::invalid_argument("on: a world in domains calls no functions; take_events() has the events");
  }
  if (kind >= event_kinds) throw std::invalid_argument("on: there is no kind of event " + std::to_string(kind));
  functions_[kind] = function.is_none() ? py::object() : std::move(function);
}

template <class World, class Row>
std::vector<Row> HeldWorld<World, Row>::take_events() {
  world();
  return std::exchange(events_, {});
}

template <class World, class Row>
int HeldWorld<World, Row>::traverse(visitproc visit, void* arg) const {
  for (const py::object& function : functions_) Py_VISIT(function.ptr());
  return 0;
}

template <class World, class Row>
void HeldWorld<World, Row>::forget_functions() {
  for (py::object& function : functions_) const py::object gone = std::move(function);
}

template class HeldWorld<AnyWorld, EventRow>;
template class HeldWorld<AnyPeriodicWorld, PeriodicRow>;

std::unique_ptr<PyWorld> hold_world(const WorldType& type, const kds::collision::WorldOptions& options, bool gather) {
  return std::make_unique<PyWorld>(
      [&](AnyWorld::Listener listener) { return make_world(type, options, std::move(listener)); }, gather,
      type.divided() ? Functions::refused : Functions::allowed);
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
