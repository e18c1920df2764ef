#include "collision/world/guard.hpp"

#include <exception>
#include <stdexcept>
#include <string>

namespace kds::collision {

/// Keeps the first reason: later exceptions follow from it.
void Guard::note_failure() {
  if (!failure_) failure_ = std::current_exception();
}

void Guard::refuse(const char* function) const {
  const std::string called = std::string(function) + ": ";
  if (!failure_ && in_box_function_) throw std::logic_error(called + "a box function must not change the world");
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

}  // namespace kds::collision
