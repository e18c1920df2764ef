// Which functions of a world may be called at a moment, and whether the world is still whole.
#pragma once

#include "kds/raised_flag.hpp"

#include <exception>
#include <utility>

namespace kds::collision {

/// Knows what the world is doing, and refuses calls that it cannot take then by std::logic_error, which names the
/// function.
///
/// 1. A step calls listeners when the world is consistent. They may change it and ask it, but not run, save or load it.
/// 2. A box function of the caller is called in the middle of a change: while it runs the world cannot be changed.
/// 3. An exception in the middle of a step or of a change leaves the world broken: from then on all calls are refused,
///    with the first reason, until another state is loaded. One that a listener has thrown does not.
class Guard {
 public:
  /// `in_box_function`: whether a box function runs at a moment.
  explicit Guard(const bool& in_box_function) : in_box_function_(in_box_function) {}
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;

  bool whole() const { return !failure_; }
  bool stepping() const { return stepping_; }
  bool in_box_function() const { return in_box_function_; }

  /// For functions that answer questions.
  void require_whole(const char* function) const {
    if (failure_) [[unlikely]]
      refuse(function);
  }
  /// For functions that change bodies, which listeners may call.
  void require_changeable(const char* function) const {
    if (failure_ || in_box_function_) [[unlikely]]
      refuse(function);
  }
  /// For functions that run, save or load the world.
  void require_idle(const char* function) const {
    if (failure_ || in_box_function_ || stepping_) [[unlikely]]
      refuse(function);
  }

  /// Makes a change, and returns what that returns.
  template <class Change>
  auto change(const Change& make) {
    try {
      return make();
    } catch (...) {
      note_failure();
      throw;
    }
  }
  /// The same for a step.
  template <class Step>
  auto step(const Step& make) {
    const kds::detail::RaisedFlag raised(stepping_);
    try {
      return make();
    } catch (...) {
      if (!std::exchange(telling_, false)) note_failure();
      throw;
    }
  }
  /// Calls a listener, in a step.
  template <class Call>
  void tell(const Call& call) {
    telling_ = true;
    call();
    telling_ = false;
    require_whole("World::step");  // The listener may have caught the exception of a change that it made.
  }
  /// Another state has been loaded.
  void mend() { failure_ = nullptr; }

 private:
  [[noreturn]] void refuse(const char* function) const;
  void note_failure();

  const bool& in_box_function_;
  bool stepping_ = false;
  bool telling_ = false;        ///< a listener is being told, or has thrown
  std::exception_ptr failure_;  ///< the exception that has left the world broken
};

}  // namespace kds::collision
