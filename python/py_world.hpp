// A world as Python holds it: events that are gathered, functions that are called, and one thread at a time.
#pragma once

#include "python/any_periodic_world.hpp"
#include "python/any_world.hpp"

#include <pybind11/pybind11.h>

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace kds_python {

/// Whether functions may be called while a world runs.
enum class Functions { allowed, refused };

/// A World, which reports each event as a Row. All members want the GIL. It is released while the world runs, if no
/// function is to be called: other threads go on, and what they ask of this world meanwhile is refused with
/// std::runtime_error.
template <class World, class EventAsRow>
class HeldWorld {
 public:
  using Row = EventAsRow;
  using Listener = std::function<void(const Row&)>;

  HeldWorld(const std::function<std::unique_ptr<World>(Listener)>& make, bool gather,
            Functions functions = Functions::allowed);

  /// To ask; also from within functions that the world calls.
  World& world();
  /// To change; not from within a filter, nor while another thread's filter is at work: with std::runtime_error.
  World& to_change();
  /// A question with a filter, which may call Python: so other threads may come in between.
  template <class Ask>
  auto ask(const Ask& ask);

  /// Ctrl-C ends it between two events, with KeyboardInterrupt.
  void advance_to(double t);
  /// s of the wall clock, and s. True if t was reached. Not of a world in domains.
  bool advance_for(double budget, double t);
  bool step(double limit);

  /// None: calls nothing any more. The function is given an array of one Row.
  void call_at(std::size_t kind, pybind11::object function);
  std::vector<Row> take_events();

  /// For Python's garbage collector: a function that is called may hold the world.
  int traverse(visitproc visit, void* arg) const;
  void forget_functions();

 private:
  void told(const Row& event);
  template <class Work>
  auto run(const Work& work);

  std::vector<Row> events_;
  std::array<pybind11::object, event_kinds> functions_;
  bool gather_;
  Functions allowed_;
  bool running_ = false;
  int asked_ = 0;  ///< questions with filters that are under way
  std::thread::id runner_;
  std::unique_ptr<World> world_;
};

using PyWorld = HeldWorld<AnyWorld, EventRow>;
using PyPeriodicWorld = HeldWorld<AnyPeriodicWorld, PeriodicRow>;

extern template class HeldWorld<AnyWorld, EventRow>;
extern template class HeldWorld<AnyPeriodicWorld, PeriodicRow>;

std::unique_ptr<PyWorld> hold_world(const WorldType& type, const kds::collision::WorldOptions& options, bool gather);

template <class World, class Row>
template <class Ask>
auto HeldWorld<World, Row>::ask(const Ask& ask) {
  World& asked = world();
  struct Asked {
    explicit Asked(int& count) : count(count) { ++count; }
    ~Asked() { --count; }
    int& count;
  } counted(asked_);
  return ask(asked);
}

/// Throws std::invalid_argument, with all names there are, for any other.
kds::collision::BroadPhaseKind broad_phase_named(const std::string& name);

}  // namespace kds_python
