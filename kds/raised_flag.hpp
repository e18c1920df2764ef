// A flag that is set for the length of a scope.
#pragma once

#include <utility>

namespace kds::detail {

/// Sets a flag, and restores its value at the end of the scope, also if something throws.
class RaisedFlag {
 public:
  explicit RaisedFlag(bool& flag) : flag_(flag), before_(std::exchange(flag, true)) {}
  ~RaisedFlag() { flag_ = before_; }
  RaisedFlag(const RaisedFlag&) = delete;
  RaisedFlag& operator=(const RaisedFlag&) = delete;

 private:
  bool& flag_;
  bool before_;
};

}  // namespace kds::detail
