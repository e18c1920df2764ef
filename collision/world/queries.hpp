// What callers ask a world.
#pragma once

#include "collision/broad_phase/body_visitor.hpp"
#include "collision/broad_phase/kinetic_box.hpp"
#include "collision/free_turning.hpp"
#include "collision/world/callers_clock.hpp"
#include "collision/world/guard.hpp"
#include "collision/world/motion_updates.hpp"
#include "collision/world/world_parts.hpp"

#include <Eigen/Core>

namespace kds::collision {

/// The functions of a world (world.hpp documents them) that answer questions about it as it is now, by the clock that
/// callers know.
template <class Motion>
class Queries {
 public:
  Queries(const WorldParts<Motion>& parts, const MotionUpdates<Motion>& motions, const Guard& guard,
          const CallersClock& callers);
  Queries(const Queries&) = delete;
  Queries& operator=(const Queries&) = delete;

  double now() const { return guard_.stepping() ? clock_.now : callers_.now; }
  Motion free_motion(BodyId id) const { return parts_.free_motion(bodies_.slot_of(id), now()); }
  FreeTurning free_turning(BodyId id) const requires(turns<Motion>);  // turning/turning_queries.cpp
  bool touching(BodyId a, BodyId b) const;
  bool resting(BodyId a, BodyId b) const;
  bool resting_at_wall(BodyId a, int wall) const;
  void visit_partners(BodyId id, BodyVisitor visit) const;
  void visit_overlapping(const Eigen::Vector3d& min, const Eigen::Vector3d& max, BodyVisitor visit) const;
  void visit_swept(const KineticBox<Motion::degree>& box, double until, BodyVisitor visit) const;

 private:
  template <class Ask, class Meets>
  void answer(const char* function, const Ask& ask, const Meets& meets, BodyVisitor visit) const;

  const Clock& clock_;
  const Bodies<Motion>& bodies_;
  const Volumes<Motion>& volumes_;
  const RestingPart<Motion>& resting_;
  const Pairs<Motion>& pairs_;
  const Unbounded<Motion>& unbounded_;
  const SelfContacts<Motion>& self_contacts_;
  const WorldParts<Motion>& parts_;
  const MotionUpdates<Motion>& motions_;
  const Guard& guard_;
  const CallersClock& callers_;
};

}  // namespace kds::collision
