// How far the history of a body has come.
#pragma once

#include "collision/world/turning/tumbling.hpp"

#include <cstdint>

namespace kds::collision {

/// All that changes in the state of a body without a caller, but for what rests (resting_progress.hpp): another world
/// that has the same body can go on from it. The pieces of motion to come are not in it, since they follow from the
/// time.
template <class Motion>
struct BodyProgress {
  Motion motion{};
  std::uint64_t meetings = 0;  ///< as in Body
  double burst_start = 0;
  typename Tumbling<Motion>::Progress turning{};

  template <class Archive>
  void archive(Archive& archive) {
    archive(motion, meetings, burst_start, turning);
  }
};

}  // namespace kds::collision
