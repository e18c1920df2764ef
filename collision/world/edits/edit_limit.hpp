// A bound on the changes by callbacks while the clock hardly moves.
#pragma once

#include "kds/roots/failure_time.hpp"

#include <cstdint>
#include <stdexcept>
#include <string>

namespace kds::collision {

/// Counts the changes that callbacks make. Changes that go on for ever at one time would stop the clock.
class EditLimit {
 public:
  /// Counts one more, at `now`. Throws std::runtime_error if it exceeds `most` within `interval` seconds.
  void count(double now, double interval, std::uint64_t most) {
    if (now - since_ > interval) {
      since_ = now;
      edits_ = 0;
    }
    if (++edits_ <= most) return;
    throw std::runtime_error("World: callbacks have changed bodies " + std::to_string(edits_) + " times within " +
                             std::to_string(now - since_) + " s, at " + std::to_string(now) +
                             " s; WorldOptions.most_edits allows no more");
  }

  /// Whether the count began not after `now`.
  bool began_by(double now) const { return since_ <= now; }

  template <class Archive>
  void archive(Archive& archive) {
    archive(edits_, since_);
  }

 private:
  std::uint64_t edits_ = 0;  ///< since that time
  double since_ = -never;    ///< s
};

}  // namespace kds::collision
