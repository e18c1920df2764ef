// Bullet's conservative advancement, of boxes, in calls of up to 0.7 rad: it turns by at most an eighth of a turn a
// call.
#include "tests/benchmarks/turning/query.hpp"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/NarrowPhaseCollision/btContinuousConvexCollision.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

namespace turning {
namespace {

btVector3 vector(const Eigen::Vector3d& v) {
  return {static_cast<btScalar>(v[0]), static_cast<btScalar>(v[1]), static_cast<btScalar>(v[2])};
}
btTransform transform(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond q(pose.linear());
  return btTransform(btQuaternion(static_cast<btScalar>(q.x()), static_cast<btScalar>(q.y()),
                                  static_cast<btScalar>(q.z()), static_cast<btScalar>(q.w())),
                     vector(pose.translation()));
}

}  // namespace

double bullet_contact(const Query& query) {
  btBoxShape a(vector(query.half_a)), b(vector(query.half_b));
  btVoronoiSimplexSolver simplex;
  btGjkEpaPenetrationDepthSolver depth;
  const int parts = calls(query, 0.7);
  for (int part = 0; part < parts; ++part) {
    const double from = static_cast<double>(part) / parts, to = (part + 1.0) / parts;
    btContinuousConvexCollision cast(&a, &b, &simplex, &depth);
    btConvexCast::CastResult result;
    if (cast.calcTimeOfImpact(transform(pose(query.a, from)), transform(pose(query.a, to)),
                              transform(pose(query.b, from)), transform(pose(query.b, to)), result)) {
      return from + static_cast<double>(result.m_fraction) * (to - from);
    }
  }
  return 2;
}

}  // namespace turning
