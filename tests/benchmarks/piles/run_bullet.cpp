// The same balls in Bullet.
#include "tests/benchmarks/piles/bullet_world.hpp"
#include "tests/benchmarks/piles/pile.hpp"
#include "tests/benchmarks/thread_time.hpp"

namespace piles {

Outcome run_bullet(const Pile& pile, double most_seconds) {
  using Eigen::Quaterniond, Eigen::Vector3d;
  using kds::benchmarks::BulletWorld, kds::benchmarks::scalar, kds::benchmarks::thread_seconds,
      kds::benchmarks::transform, kds::benchmarks::vector;
  Gauge gauge(pile);
  double seconds = 0;
  double begin = thread_seconds();
  BulletWorld bullet(Vector3d(0, -gravity, 0));
  bullet.add_plane(Vector3d::UnitY(), 0, restitution);
  bullet.add_plane(Vector3d::UnitX(), 0, restitution);
  bullet.add_plane(-Vector3d::UnitX(), -pile.space[0], restitution);
  bullet.add_plane(Vector3d::UnitZ(), 0, restitution);
  bullet.add_plane(-Vector3d::UnitZ(), -pile.space[2], restitution);
  for (const FixedBox& box : pile.boxes) {
    bullet.add(std::make_unique<btBoxShape>(vector(box.half_extents)), 0, restitution, transform(box.turn, box.place));
  }
  std::vector<btRigidBody*> balls;
  for (const Ball& ball : pile.balls) {
    balls.push_back(bullet.add(std::make_unique<btSphereShape>(scalar(ball.radius)), ball.mass(), restitution,
                               transform(Quaterniond::Identity(), ball.place)));
    balls.back()->setLinearVelocity(vector(ball.velocity));
  }
  std::vector<Vector3d> places(balls.size()), velocities(balls.size());
  const int frames = static_cast<int>(length_of_run * BulletWorld::frames_a_second);
  const int frames_a_sample = static_cast<int>(sample * BulletWorld::frames_a_second);
  for (int frame = 1; frame <= frames && seconds < most_seconds; ++frame) {
    bullet.frame();
    if (frame % frames_a_sample != 0) continue;
    seconds += thread_seconds() - begin;
    for (std::size_t i = 0; i < balls.size(); ++i) {
      places[i] = vector(balls[i]->getWorldTransform().getOrigin());
      velocities[i] = vector(balls[i]->getLinearVelocity());
    }
    gauge.look(static_cast<double>(frame) / BulletWorld::frames_a_second, seconds, places, velocities);
    begin = thread_seconds();
  }
  return gauge.outcome();
}

}  // namespace piles
