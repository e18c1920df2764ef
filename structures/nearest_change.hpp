// What rules of nearest neighbours report.
#pragma once

#include "kds/framework/moving_set.hpp"

namespace kds::structures {

/// The nearest neighbour of a point has become another, or its list of k nearest; or one of these, or the point itself,
/// has got a new motion; or the point has come or gone. Where points stay in one place together it may be reported of
/// others too.
struct NearestChange {
  Id id;

  friend bool operator==(const NearestChange&, const NearestChange&) = default;
};

}  // namespace kds::structures
