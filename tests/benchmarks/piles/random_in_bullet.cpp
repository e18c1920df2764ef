#include "tests/benchmarks/piles/random_in_bullet.hpp"

#include "tests/benchmarks/piles/bullet_world.hpp"
#include "tests/benchmarks/thread_time.hpp"
#include "tests/fuzz/random_piles/depth.hpp"
#include "tests/fuzz/random_piles/meter.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

namespace kds::piles {
namespace {

using benchmarks::BulletWorld, benchmarks::scalar, benchmarks::thread_seconds, benchmarks::transform,
    benchmarks::vector;
using Eigen::Vector3d;

/// Bullet's thresholds (speeds below which bodies sleep or do not rebound, margins, depths that it lets be) are lengths
/// made for bodies of about 1. Random scenes are about so large, or a thousand times larger or smaller: Bullet is given
/// the power of 1 000 that fits the largest free body.
double unit_of(const Scene& scene) {
  double size = 0;
  for (const Description& body : scene.bodies) {
    if (!body.fixed) size = std::max(size, collision::place(body.shape, body.orientation).bounding_radius);
  }
  return size > 0 ? std::pow(1000, std::round(std::log10(size) / 3)) : 1;
}

/// Bullet takes a body for a fixed one whose inverse mass is below the spacing of floats at 1, so that two of those
/// pass through each other; random masses go up to 10^9. It is given parts of the greatest.
double greatest_mass(const Scene& scene) {
  double greatest = 0;
  for (const Description& body : scene.bodies) {
    if (!body.fixed) greatest = std::max(greatest, body.mass);
  }
  return greatest;
}

/// A scene in Bullet, whose lengths there are those of the scene over `unit_`.
class Copy {
 public:
  explicit Copy(const Scene& scene)
      : scene_(scene), unit_(unit_of(scene)), greatest_mass_(greatest_mass(scene)), bullet_(scene.gravity / unit_) {
    // By default overlaps of up to 0.04 are taken back by speed, which stays: what rebounds well would rise to many
    // times its height. This costs no depth.
    bullet_.world.getSolverInfo().m_splitImpulsePenetrationThreshold = 0;
    if (scene.walls) add_walls(*scene.walls);
    for (const Description& body : scene.bodies) add(body);
  }

  /// The frame that ends at a time.
  void frame(double until) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (scene_.bodies[i].fixed) move(scene_.bodies[i], *bodies_[i], until);
    }
    bullet_.frame();
  }

  /// Whether all are numbers.
  bool read(Meter& meter) const {
    bool numbers = true;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      meter.places[i] = unit_ * vector(bodies_[i]->getWorldTransform().getOrigin());
      meter.velocities[i] = unit_ * vector(bodies_[i]->getLinearVelocity());
      numbers = numbers && meter.places[i].allFinite() && meter.velocities[i].allFinite();
    }
    return numbers;
  }

 private:
  /// They hold the bounding balls of bodies, which Bullet's planes do for bodies that are balls.
  void add_walls(const collision::Walls& walls) {
    for (int d = 0; d < 3; ++d) {
      const Vector3d inward = Vector3d::Unit(d);
      bullet_.add_plane(inward, walls.min[d] / unit_, walls.restitution);
      bullet_.add_plane(-inward, -walls.max[d] / unit_, walls.restitution);
    }
  }

  void add(const Description& body) {
    const auto& motion = body.motion.front();
    // Corners of a mesh are turned already.
    const bool mesh = collision::has_mesh(body.shape);
    const auto turn = mesh ? Eigen::Quaterniond::Identity() : body.orientation;
    btRigidBody* const added = bullet_.add(shape_of(body), body.fixed ? 0 : body.mass / greatest_mass_,
                                           body.restitution, transform(turn, motion.position(0) / unit_));
    added->setAngularFactor(0);
    if (!body.fixed) added->setLinearVelocity(vector(motion.velocity(0) / unit_));
    if (body.fixed && body.motion.size() > 1) {
      added->setCollisionFlags(added->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    }
    bodies_.push_back(added);
  }

  std::unique_ptr<btCollisionShape> shape_of(const Description& body) {
    if (const auto* ball = std::get_if<collision::Sphere>(&body.shape)) {
      return std::make_unique<btSphereShape>(scalar(ball->radius / unit_));
    }
    if (const auto* box = std::get_if<collision::Box>(&body.shape)) {
      return std::make_unique<btBoxShape>(vector(box->half_extents / unit_));
    }
    if (const auto* capsule = std::get_if<collision::Capsule>(&body.shape)) {
      return std::make_unique<btCapsuleShapeZ>(scalar(capsule->radius / unit_),
                                               scalar(2 * capsule->half_length / unit_));
    }
    auto triangles = std::make_unique<btTriangleMesh>();
    for (const Face& face : Solid(collision::place(body.shape, body.orientation)).faces) {
      const auto& c = face.corners;
      triangles->addTriangle(vector(c[0] / unit_), vector(c[1] / unit_), vector(c[2] / unit_));
    }
    meshes_.push_back(std::move(triangles));
    return std::make_unique<btBvhTriangleMeshShape>(meshes_.back().get(), true);
  }

  /// Bullet finds the velocity by where the body was in the frame before. While it does not move it sleeps, so that
  /// what lies on it may.
  void move(const Description& body, btRigidBody& in_bullet, double until) const {
    if (!in_bullet.isKinematicObject()) return;
    const auto* piece = &body.motion.front();
    for (const auto& next : body.motion) {
      if (next.start <= until) piece = &next;
    }
    const btVector3 place = vector(piece->position(until) / unit_);
    const bool moves = (place - in_bullet.getWorldTransform().getOrigin()).length2() > 0;
    in_bullet.getWorldTransform().setOrigin(place);
    in_bullet.forceActivationState(moves ? DISABLE_DEACTIVATION : ISLAND_SLEEPING);
    if (!moves) in_bullet.setLinearVelocity(btVector3(0, 0, 0));
  }

  const Scene& scene_;
  double unit_;
  double greatest_mass_;
  std::vector<std::unique_ptr<btTriangleMesh>> meshes_{};  // which their shapes refer to
  BulletWorld bullet_;
  std::vector<btRigidBody*> bodies_{};
};

}  // namespace

Result run_in_bullet(const Scene& scene, double most_seconds) {
  Result result;
  Meter meter(scene, result);
  constexpr double rate = BulletWorld::frames_a_second;
  const auto frames = static_cast<int>(std::round(scene.seconds * rate));
  const auto frames_a_sample = static_cast<int>(std::round(sample * rate));
  double begin = thread_seconds();
  Copy copy(scene);
  for (int frame = 1; frame <= frames && result.seconds < most_seconds; ++frame) {
    copy.frame(frame / rate);
    if (frame % frames_a_sample != 0) continue;
    result.seconds += thread_seconds() - begin;
    if (!copy.read(meter)) break;
    meter.look_at_all(frame / rate);
    result.reached = frame / rate;
    begin = thread_seconds();
  }
  result.kinetic = meter.kinetic();
  return result;
}

}  // namespace kds::piles
