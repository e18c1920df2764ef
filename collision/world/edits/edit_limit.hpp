// A bound on the changes by callbacks while the clock hardly moves.
#pragma once

#include "kds/number_text.hpp"
#include "kds/roots/failure_time.hpp"

#include <cstdint>
#include <stdexcept>
#include <string>

namespace kds::collision {

/// Counts the changes that callbacks make. Changes that go on for ever at one time would stop the clock.
class EditLimit {
 public:
  /// Counts one more, at `now`. Throws std::runtime_error if it is one too many within `interval` seconds: more than
  /// `most`, as that was when the first of them came. (It grows with the bodies, so changes that add bodies would never
  /// come to the end of one that is asked for anew each time.)
  void count(double now, double interval, std::uint64_t most) {
    if (now - since_ > interval) {
      since_ = now;
      left_ = most;
    }
    if (left_ == 0) {
      throw std::runtime_error("World: callbacks have changed bodies more often within " + number_text(interval) +
                               " s, at " + number_text(now) + " s, than WorldOptions.most_edits allows");
    }
    --left_;
  }

  /// Whether the count began not after `now`.
  bool began_by(double now) const { return since_ <= now; }

  template <class Archive>
  void archive(Archive& archive) {
    archive(left_, since_);
  }

 private:
  std::uint64_t left_ = 0;  ///< may still come, counted since that time
  double since_ = -never;   ///< s
};

}  // namespace kds::collision
