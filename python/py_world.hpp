// A world as Python holds it: events that are gathered, functions that are called, and one thread at a time.
#pragma once

#include "python/any_world.hpp"

#include <pybind11/pybind11.h>

#include <array>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace kds_python {

/// All members want the GIL. It is released while the world runs, if no function is to be called: other threads go on,
/// and what they ask of this world meanwhile is refused with std::runtime_error.
class PyWorld {
 public:
  PyWorld(int degree, bool turning, const kds::collision::WorldOptions& options, bool gather);

  /// To ask; also from within functions that the world calls.
  AnyWorld& world();
  /// To change; not from within a filter, nor while another thread's filter is at work: with std::runtime_error.
  AnyWorld& to_change();
  /// A question with a filter, which may call Python: so other threads may come in between.
  template <class Ask>
  auto ask(const Ask& ask);

  /// Ctrl-C ends it between two events, with KeyboardInterrupt.
  void advance_to(double t);
  bool step(double limit);

  /// None: calls nothing any more. The function is given an array of one EventRow.
  void call_at(std::size_t kind, pybind11::object function);
  std::vector<EventRow> take_events();

  /// For Python's garbage collector: a function that is called may hold the world.
  int traverse(visitproc visit, void* arg) const;
  void forget_functions();

 private:
  void told(const EventRow& event);
  template <class Work>
  auto run(const Work& work);

  std::vector<EventRow> events_;
  std::array<pybind11::object, event_kinds> functions_;
  bool gather_;
  bool running_ = false;
  int asked_ = 0;  ///< questions with filters that are under way
  std::thread::id runner_;
  std::unique_ptr<AnyWorld> world_;
};

template <class Ask>
auto PyWorld::ask(const Ask& ask) {
  AnyWorld& asked = world();
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
