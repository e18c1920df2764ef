// The same balls in Bullet's world of rigid bodies, as it is by default: bodies that rest are put to sleep.
#include "tests/benchmarks/piles/pile.hpp"
#include "tests/benchmarks/thread_time.hpp"

#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <memory>

namespace piles {
namespace {

using Eigen::Vector3d;

constexpr int frames_a_second = 240;

btVector3 vector(const Vector3d& v) {
  return {static_cast<btScalar>(v[0]), static_cast<btScalar>(v[1]), static_cast<btScalar>(v[2])};
}

/// The lower counts, as in a world of this library; Bullet's own rule is the product.
btScalar lower(const btCollisionObject* a, const btCollisionObject* b) {
  return std::min(a->getRestitution(), b->getRestitution());
}

struct Simulation {
  btDefaultCollisionConfiguration configuration{};
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broad_phase{};
  btSequentialImpulseConstraintSolver solver{};
  btDiscreteDynamicsWorld world{&dispatcher, &broad_phase, &solver, &configuration};
  std::vector<std::unique_ptr<btCollisionShape>> shapes{};
  std::vector<std::unique_ptr<btRigidBody>> bodies{};

  ~Simulation() {
    for (const auto& body : bodies) world.removeRigidBody(body.get());
  }

  btRigidBody* add(std::unique_ptr<btCollisionShape> shape, double mass, const btTransform& place) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(static_cast<btScalar>(mass), inertia);
    btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(mass), nullptr, shape.get(), inertia);
    info.m_startWorldTransform = place;
    info.m_restitution = static_cast<btScalar>(restitution);
    info.m_friction = 0;
    shapes.push_back(std::move(shape));
    bodies.push_back(std::make_unique<btRigidBody>(info));
    world.addRigidBody(bodies.back().get());
    return bodies.back().get();
  }

  void add_plane(const Vector3d& normal, double offset) {
    add(std::make_unique<btStaticPlaneShape>(vector(normal), static_cast<btScalar>(offset)), 0,
        btTransform::getIdentity());
  }
};

}  // namespace

Outcome run_bullet(const Pile& pile, double most_seconds) {
  using kds::benchmarks::thread_seconds;
  gCalculateCombinedRestitutionCallback = lower;
  Gauge gauge(pile);
  double seconds = 0;
  double begin = thread_seconds();
  Simulation simulation;
  simulation.world.setGravity(vector(Vector3d(0, -gravity, 0)));
  simulation.add_plane(Vector3d::UnitY(), 0);
  simulation.add_plane(Vector3d::UnitX(), 0);
  simulation.add_plane(-Vector3d::UnitX(), -pile.space[0]);
  simulation.add_plane(Vector3d::UnitZ(), 0);
  simulation.add_plane(-Vector3d::UnitZ(), -pile.space[2]);
  for (const FixedBox& box : pile.boxes) {
    const Eigen::Quaternionf q = box.turn.cast<float>();
    simulation.add(std::make_unique<btBoxShape>(vector(box.half_extents)), 0,
                   btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), vector(box.place)));
  }
  std::vector<btRigidBody*> balls;
  for (const Ball& ball : pile.balls) {
    btTransform place = btTransform::getIdentity();
    place.setOrigin(vector(ball.place));
    balls.push_back(
        simulation.add(std::make_unique<btSphereShape>(static_cast<btScalar>(ball.radius)), ball.mass(), place));
    balls.back()->setLinearVelocity(vector(ball.velocity));
  }
  std::vector<Vector3d> places(balls.size()), velocities(balls.size());
  const int frames = static_cast<int>(length_of_run * frames_a_second);
  const int frames_a_sample = static_cast<int>(sample * frames_a_second);
  for (int frame = 1; frame <= frames && seconds < most_seconds; ++frame) {
    simulation.world.stepSimulation(static_cast<btScalar>(1.0 / frames_a_second), 0);
    if (frame % frames_a_sample != 0) continue;
    seconds += thread_seconds() - begin;
    for (std::size_t i = 0; i < balls.size(); ++i) {
      const btVector3& x = balls[i]->getWorldTransform().getOrigin();
      const btVector3& v = balls[i]->getLinearVelocity();
      places[i] = Vector3d(x[0], x[1], x[2]);
      velocities[i] = Vector3d(v[0], v[1], v[2]);
    }
    gauge.look(static_cast<double>(frame) / frames_a_second, seconds, places, velocities);
    begin = thread_seconds();
  }
  return gauge.outcome();
}

}  // namespace piles
