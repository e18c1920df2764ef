// A periodic world of any degree, behind one interface.
#pragma once

#include "collision/periodic/periodic_options.hpp"
#include "collision/periodic/periodic_world.hpp"
#include "python/any_world.hpp"

#include <Eigen/Core>

#include <functional>
#include <memory>
#include <vector>

namespace kds_python {

/// Members are those of kds::collision::PeriodicWorld.
class AnyPeriodicWorld : public AnyBodies {
 public:
  using Listener = std::function<void(const PeriodicRow&)>;

  virtual std::vector<BodyId> bodies() const = 0;  ///< ascending
  virtual kds::collision::Offset crossings(BodyId id) const = 0;
  /// By how much the periods that have been taken away moved a body.
  virtual Eigen::Vector3d way_wrapped(BodyId id) const = 0;
  virtual kds::collision::PeriodicCounters counters() const = 0;
};

/// Of degree 1 or 2; throws std::invalid_argument for another, and what the world throws for its options. `record`:
/// whether it can be asked for pictures.
std::unique_ptr<AnyPeriodicWorld> make_periodic_world(int degree, bool record,
                                                      const kds::collision::PeriodicOptions& options,
                                                      AnyPeriodicWorld::Listener listener);

}  // namespace kds_python
