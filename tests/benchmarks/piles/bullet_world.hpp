// Bullet's world of rigid bodies, as it is by default: bodies that rest are put to sleep. Without friction.
#pragma once

#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace kds::benchmarks {

inline btScalar scalar(double x) { return static_cast<btScalar>(x); }
inline btVector3 vector(const Eigen::Vector3d& v) { return {scalar(v[0]), scalar(v[1]), scalar(v[2])}; }
inline Eigen::Vector3d vector(const btVector3& v) { return {v[0], v[1], v[2]}; }
inline btTransform transform(const Eigen::Quaterniond& turn, const Eigen::Vector3d& place) {
  const btQuaternion q(scalar(turn.x()), scalar(turn.y()), scalar(turn.z()), scalar(turn.w()));
  return btTransform(q, vector(place));
}

/// The lower counts, as in a world of this library; Bullet's own rule is the product.
inline btScalar lower_restitution(const btCollisionObject* a, const btCollisionObject* b) {
  return std::min(a->getRestitution(), b->getRestitution());
}

/// A world of which 240 frames a second are simulated.
struct BulletWorld {
  static constexpr int frames_a_second = 240;

  btDefaultCollisionConfiguration configuration{};
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broad_phase{};
  btSequentialImpulseConstraintSolver solver{};
  btDiscreteDynamicsWorld world{&dispatcher, &broad_phase, &solver, &configuration};
  std::vector<std::unique_ptr<btCollisionShape>> shapes{};
  std::vector<std::unique_ptr<btRigidBody>> bodies{};

  explicit BulletWorld(const Eigen::Vector3d& gravity) {
    gCalculateCombinedRestitutionCallback = lower_restitution;
    world.setGravity(vector(gravity));
  }
  BulletWorld(const BulletWorld&) = delete;
  BulletWorld& operator=(const BulletWorld&) = delete;
  ~BulletWorld() {
    for (const auto& body : bodies) world.removeRigidBody(body.get());
  }

  /// A mass of 0 is that of what does not move.
  btRigidBody* add(std::unique_ptr<btCollisionShape> shape, double mass, double restitution, const btTransform& place) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(scalar(mass), inertia);
    btRigidBody::btRigidBodyConstructionInfo info(scalar(mass), nullptr, shape.get(), inertia);
    info.m_startWorldTransform = place;
    info.m_restitution = scalar(restitution);
    info.m_friction = 0;
    shapes.push_back(std::move(shape));
    bodies.push_back(std::make_unique<btRigidBody>(info));
    world.addRigidBody(bodies.back().get());
    return bodies.back().get();
  }

  void add_plane(const Eigen::Vector3d& normal, double offset, double restitution) {
    add(std::make_unique<btStaticPlaneShape>(vector(normal), scalar(offset)), 0, restitution,
        btTransform::getIdentity());
  }

  void frame() { world.stepSimulation(scalar(1.0 / frames_a_second), 0); }
};

}  // namespace kds::benchmarks
