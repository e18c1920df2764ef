// The times that the parts of a world share.
#pragma once

namespace kds::collision {

/// Parts read it. The world sets it, and so do the pairs while the broad phase reports them.
struct Clock {
  double now = 0;      ///< s: the time of the event that is being processed
  double horizon = 0;  ///< s: events later than this need not be known yet
};

}  // namespace kds::collision
