// Bodies that precess: pieces a radian, time for a piece, and what becomes of the energy.
#include "collision/response/rotation_piece.hpp"
#include "collision/world.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "tests/benchmarks/thread_time.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/support/random_numbers.hpp"
#include "tests/support/random_vectors.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>

namespace {

using namespace kds;
using namespace kds::collision;
using kds::tests::random_vector;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Turning = TurningWorld<1>;

struct Kind {
  const char* name;
  Vector3d moments;
};
constexpr int seeds = 50;

/// The mean of angular velocities at random.
void pieces(const Kind& kind) {
  const PrincipalInertia inertia = principal_inertia(kind.moments.asDiagonal());
  std::printf("%-22s", kind.name);
  double micros = 0;
  for (const double error : {1e-2, 1e-3, 1e-4, 1e-6}) {
    double turned = 0;
    std::uint64_t count = 0;
    const double start = benchmarks::thread_seconds();
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      tests::Random random(seed);
      const Quaterniond upright = Quaterniond::Identity();
      RotationState state{angular_momentum(inertia, upright, random_vector(random)), upright, 0};
      RotationPiece piece = leading_piece(inertia, state, upright, error);
      std::optional<TopPieces> known;
      for (double t = piece.end; t < 50; t = piece.end) {
        piece = pieces_until(next_up(t), inertia, state, t, piece, error, known).last;
        turned += piece.angular_velocity.norm() * (piece.end - t);
        ++count;
      }
    }
    micros = 1e6 * (benchmarks::thread_seconds() - start) / static_cast<double>(count);
    std::printf("  %6.3g", static_cast<double>(count) / turned);
  }
  std::printf("   %.1f us\n", micros);
}

/// A million pieces of a body that nothing meets: the change of its energy, relative.
void drift(const Kind& kind) {
  const PrincipalInertia inertia = principal_inertia(kind.moments.asDiagonal());
  double greatest = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    tests::Random random(seed);
    RotationState state{Vector3d::Zero(), Quaterniond::Identity(), 0};
    state.momentum = angular_momentum(inertia, state.orientation, random_vector(random));
    const auto energy = [&](const Quaterniond& q) {
      return state.momentum.dot(angular_velocity(inertia, {state.momentum, q, 0}));
    };
    const double before = energy(state.orientation);
    RotationPiece piece = leading_piece(inertia, state, state.orientation, 1e-3);
    std::optional<TopPieces> known;
    for (int i = 0; i < 1'000'000; ++i) {
      piece = pieces_until(next_up(piece.end), inertia, state, piece.end, piece, 1e-3, known).last;
    }
    greatest = std::max(greatest, std::abs(energy(orientation_at(inertia, state, piece.end)) / before - 1));
  }
  std::printf("%-22s  %.1e\n", kind.name, greatest);
}

/// What is conserved, of bodies without walls, and sums of magnitudes to compare it with.
struct Conserved {
  double energy = 0;
  Vector3d momentum = Vector3d::Zero(), angular = Vector3d::Zero();  ///< the latter about the common centre of mass
  double momenta = 0, angular_momenta = 0;
};
Conserved conserved(const Turning& world) {
  const double t = world.now();
  double mass = 0;
  Vector3d centre = Vector3d::Zero(), drift = Vector3d::Zero();
  for (BodyId id = 0; id < world.size(); ++id) {
    const auto& path = world.motion(id).path;
    mass += world.mass(id);
    centre += world.mass(id) * path.position(t), drift += world.mass(id) * path.velocity(t);
  }
  centre /= mass, drift /= mass;
  Conserved sum;
  for (BodyId id = 0; id < world.size(); ++id) {
    const FreeTurning turning = world.free_turning(id);
    const Vector3d velocity = world.motion(id).path.velocity(t);
    const Vector3d momentum = world.mass(id) * velocity;
    const Vector3d arm = world.motion(id).path.position(t) - centre;
    sum.energy += momentum.dot(velocity) + turning.angular_momentum.dot(turning.angular_velocity);
    sum.momentum += momentum, sum.momenta += momentum.norm();
    const Vector3d of_path = arm.cross(momentum - world.mass(id) * drift);
    sum.angular += of_path + turning.angular_momentum;
    sum.angular_momenta += of_path.norm() + turning.angular_momentum.norm();
  }
  return sum;
}

enum class Around { walls, shell };
/// 18 bodies at restitution 1, of all kinds of inertia: between walls, or in a hollow box that flies and tumbles
/// itself, a mesh, so that momenta are conserved.
void contacts(Around around, double error, std::uint64_t seed, std::uint64_t count) {
  WorldOptions options{.response = Response::elastic, .shortest_flight = 1e-12, .orientation_error = error};
  if (around == Around::walls) options.walls = Walls{Vector3d::Constant(-3), Vector3d::Constant(3)};
  Turning world(options);
  tests::Random random(seed);
  const Vector3d halves[] = {{0.8, 0.2, 0.3}, {0.7, 0.7, 0.1}, {0.1, 0.1, 0.9}, {0.5, 0.5, 0.5}};
  Vector3d momentum = Vector3d::Zero();
  for (int i = 0; i < 18; ++i) {
    Turning::Motion motion;
    motion.path.coefficients = {Vector3d(i % 3 * 2 - 2, i / 3 % 3 * 2 - 2, i / 9 * 2 - 1), 2 * random_vector(random)};
    motion.angular_velocity = 4 * random_vector(random);
    const double mass = random.between(1, 3);
    momentum += mass * motion.path.coefficients[1];
    world.add_body({.shape = Box{halves[i % 4]}, .motion = {motion}, .mass = mass});
  }
  if (around == Around::shell) {
    Turning::Motion motion;
    constexpr double mass = 50;
    // All together stay where they are: far from the origin places are rounded more, and with them angular momenta.
    motion.path.coefficients = {Vector3d::Zero(), -momentum / mass};
    motion.angular_velocity = {0.1, 0.2, -0.1};
    const Eigen::Matrix3d inertia = Vector3d(300, 400, 500).asDiagonal();
    const MeshShape box{samples::cuboid(Vector3d::Constant(3)), 1};
    world.add_body({.shape = box, .motion = {motion}, .mass = mass, .inertia = inertia});
  }
  const Conserved before = conserved(world);
  const double start = benchmarks::thread_seconds();
  while (world.counters().contacts < count) world.advance_to(world.now() + 10);
  const WorldCounters counters = world.counters();
  const Conserved after = conserved(world);
  std::printf("%s, error %g, seed %d: %llu contacts, %llu pieces, %llu resets, energy %+.1e",
              around == Around::shell ? "shell" : "walls", error, static_cast<int>(seed),
              static_cast<unsigned long long>(counters.contacts),
              static_cast<unsigned long long>(counters.rotation_pieces),
              static_cast<unsigned long long>(counters.orientation_resets), after.energy / before.energy - 1);
  if (around == Around::shell) {
    std::printf(", momentum %.1e, angular %.1e", (after.momentum - before.momentum).norm() / before.momenta,
                (after.angular - before.angular).norm() / before.angular_momenta);
  }
  std::printf(", %.1f s\n", benchmarks::thread_seconds() - start);
}

/// Many slender bodies that fly and turn, as the solids that they are and as if their moments were equal.
void crowd(const char* name, const Vector3d& half, double packing, double rate, bool precess) {
  constexpr int bodies = 1000, side = 10;
  const double spacing = std::cbrt(8 * half.prod() / packing);
  WorldOptions options{.response = Response::elastic};
  options.walls = Walls{Vector3d::Zero(), Vector3d::Constant(spacing * side)};
  Turning world(options);
  tests::Random random(1);
  const double start = benchmarks::thread_seconds();
  for (int i = 0; i < bodies; ++i) {
    Turning::Motion motion;
    motion.path.coefficients = {spacing * Vector3d(i % 10 + 0.5, i / 10 % 10 + 0.5, i / 100 + 0.5),
                                random_vector(random)};
    motion.angular_velocity = rate * random_vector(random).normalized();
    Turning::Description body{.shape = Box{half}, .motion = {motion}};
    if (!precess) body.inertia = 2 * half.squaredNorm() / 9;
    world.add_body(body);
  }
  world.advance_to(2);
  const WorldCounters counters = world.counters();
  std::printf("%-8s %3g rad/s, %s: %7.1f ms, %llu contacts, %llu pieces, %llu tests\n", name, rate,
              precess ? "precess   " : "fixed axes", 1e3 * (benchmarks::thread_seconds() - start),
              static_cast<unsigned long long>(counters.contacts),
              static_cast<unsigned long long>(counters.rotation_pieces),
              static_cast<unsigned long long>(counters.pair_tests));
}

}  // namespace

int main(int argc, char** argv) {
  const Kind kinds[] = {{"plate, 1 : 1 : 2", {1, 1, 2}},     {"rod, 0.01 : 1 : 1", {0.01, 1, 1}},
                        {"rod, 1e-6 : 1 : 1", {1e-6, 1, 1}}, {"box, 1 : 2 : 2.5", {1, 2, 2.5}},
                        {"box, 1 : 1.5 : 2", {1, 1.5, 2}},   {"box, 1 : 1.1 : 1.2", {1, 1.1, 1.2}}};
  std::printf("pieces a radian at 1e-2, 1e-3, 1e-4, 1e-6 rad; time for a piece\n");
  for (const Kind& kind : kinds) pieces(kind);
  std::printf("\nenergy after 10^6 pieces, greatest change of three runs\n");
  for (const Kind& kind : kinds) drift(kind);
  const std::uint64_t count = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 20'000;
  std::printf("\nenergy and momenta over contacts\n");
  for (const double error : {1e-2, 1e-3}) {
    for (const std::uint64_t seed : {1, 2}) {
      for (const Around around : {Around::walls, Around::shell}) contacts(around, error, seed, count);
    }
  }
  std::printf("\n1 000 bodies, 2 s\n");
  for (const double rate : {1.0, 10.0}) {
    for (const bool precess : {false, true}) {
      crowd("rods", {0.1, 0.12, 1}, 0.002, rate, precess);
      crowd("plates", {0.1, 0.8, 1}, 0.01, rate, precess);
      crowd("boxes", {0.4, 0.5, 0.6}, 0.1, rate, precess);
    }
  }
}
