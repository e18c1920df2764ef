// Which functions of a world may be called when, and its state after an exception.
#include "collision/motions.hpp"
#include "collision/world/engine.hpp"

#include <exception>
#include <stdexcept>
#include <string>

namespace kds::collision {

/// Keeps the first reason: later exceptions follow from it.
template <class Motion>
void Engine<Motion>::note_failure() {
  if (!failure_) failure_ = std::current_exception();
}

template <class Motion>
void Engine<Motion>::refuse(const char* function) const {
  const std::string called = std::string(function) + ": ";
  if (!failure_ && volumes_.calling()) throw std::logic_error(called + "a box function must not change the world");
  if (!failure_) throw std::logic_error(called + "must not be called from within a callback");
  std::string why = "what was thrown is no std::exception";
  try {
    std::rethrow_exception(failure_);
  } catch (const std::exception& error) {
    why = error.what();
  } catch (...) {
  }
  throw std::logic_error(called + "the world can no longer be used, since a change was interrupted half-way: " + why);
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class Engine<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
