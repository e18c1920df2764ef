// The times that the parts of a world share.
#pragma once

namespace kds::collision {

/// Parts read it. It is set by the world, and while a broad phase is at work by the pairs that it reports.
struct Clock {
  double now = 0;      ///< s: of what is being done
  double horizon = 0;  ///< s: what happens later need not be known yet
};

}  // namespace kds::collision
