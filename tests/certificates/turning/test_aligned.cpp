// Scenes in which a certificate of bodies that turn is zero at all times, and such that are next to them.
#include "certificates/turning/edge_edge_separation.hpp"
#include "certificates/turning/vertex_face_separation.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "tests/certificates/turning/check_turning.hpp"
#include "tests/certificates/turning/turning_scenes.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cstdint>

namespace test_aligned {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::EdgeEdgeSeparation;
using certificates::RigidMotion;
using certificates::VertexFaceSeparation;
using Eigen::Vector3d;
using Scene = TurningScene<2>;

/// Turns about z alone, and stays in its plane.
void flatten(RigidMotion<2>& motion) {
  for (auto& c : motion.path.coefficients) c[2] = 0;
  motion.angular_velocity[0] = motion.angular_velocity[1] = 0;
  motion.orientation.coeffs()[0] = motion.orientation.coeffs()[1] = 0;
  if (motion.orientation.coeffs().isZero(0)) motion.orientation.setIdentity();
}

Vector3d flat(Random& random, bool coarse) {
  Vector3d v = turning_vector(random, coarse);
  v[2] = 0;
  return v;
}

/// Zero throughout: at any time, just after it, and so are its derivatives.
template <class Certificate>
int mistakes_of_zero(const Certificate& f, const Scene& scene, Random& random, LadderTally& tally) {
  int wrong = !vanishes(f) || !vanishes(f, 1);
  for (const double t : {scene.a.start(), scene.time, random.between(-5, 5), scene.b.start()}) {
    wrong += sign_at(f, t) != 0 || sign_after(f, t) != 0 || sign_at(f, t, 1) != 0 || sign_after(f, t, 2) != 0;
    tally.cases += 4;
  }
  return wrong;
}

/// A number that is a little off makes signs, which are those of the definition.
template <class Certificate>
void compare_after_nudge(const Certificate& f, const Scene& scene, LadderTally& tally) {
  compare(f, scene.time, scene.span, tally);
}

void nudge(double& x) { x = x == 0 ? 0x1p-60 : next_up(x); }

}  // namespace

TEST_CASE("what is aligned for good is zero at all times, and a nudge makes signs", "[turning]") {
  const std::uint64_t seed = 330;
  CAPTURE(seed);
  Random random(seed);
  LadderTally tally;
  int wrong = 0;
  for (int round = 0; round < 100; ++round) {
    const bool coarse = random.one_in(2);
    Scene scene = turning_scene<2>(random, coarse);
    CAPTURE(round, coarse);
    {  // A vertex in a plane that turns in itself, both about axes upright on it, whatever the starts.
      Scene s = scene;
      flatten(s.a);
      flatten(s.b);
      VertexFaceSeparation<2> f{
          s.a, s.b, flat(random, coarse), {flat(random, coarse), flat(random, coarse), flat(random, coarse)}};
      wrong += mistakes_of_zero(f, s, random, tally);
      nudge(f.vertex[2]);
      compare_after_nudge(f, s, tally);
      // Edges in that plane, and edges upright on it.
      EdgeEdgeSeparation<2> g{
          s.a, s.b, {flat(random, coarse), flat(random, coarse)}, {flat(random, coarse), flat(random, coarse)}};
      wrong += mistakes_of_zero(g, s, random, tally);
      const Vector3d up(0, 0, 0.75);
      g.edge_a[1] = g.edge_a[0] + up;
      g.edge_b[1] = g.edge_b[0] + up;
      wrong += mistakes_of_zero(g, s, random, tally);
      nudge(g.edge_b[1][0]);
      compare_after_nudge(g, s, tally);
    }
    {  // Edges that are parallel and turn alike; a vertex of one body in a face of the other, which moves with it.
      Scene s = scene;
      s.b.angular_velocity = s.a.angular_velocity;
      s.b.orientation = s.a.orientation;
      s.b.path.start = s.a.path.start;
      const Vector3d direction = turning_vector(random, true);
      EdgeEdgeSeparation<2> f{s.a, s.b, {turning_vector(random, true), {}}, {turning_vector(random, true), {}}};
      f.edge_a[1] = f.edge_a[0] + direction;
      f.edge_b[1] = f.edge_b[0] + direction * 2;
      wrong += mistakes_of_zero(f, s, random, tally);
      nudge(s.b.angular_velocity[0]);
      compare_after_nudge(f, s, tally);
      s.b = s.a;
      const Vector3d corner = turning_vector(random, true);
      const Vector3d side = turning_vector(random, true);
      const VertexFaceSeparation<2> g{s.a, s.b, corner + direction + side, {corner, corner + direction, corner + side}};
      wrong += mistakes_of_zero(g, s, random, tally);
      nudge(s.b.orientation.coeffs()[3]);
      compare_after_nudge(g, s, tally);
    }
    {  // Edges through the common origin, each turning as it likes.
      Scene s = scene;
      const double start_b = s.b.start();
      if (start_b != s.a.start()) s.a.path.coefficients = s.b.path.coefficients = Vector3d(1, 2, 3);
      if (start_b == s.a.start()) s.b.path = s.a.path;
      const Vector3d u = turning_vector(random, true);
      const Vector3d v = turning_vector(random, true);
      EdgeEdgeSeparation<2> f{s.a, s.b, {Vector3d(u * -1.0), Vector3d(u * 2.0)}, {v, Vector3d(v * 0.5)}};
      wrong += mistakes_of_zero(f, s, random, tally);
      nudge(s.a.path.coefficients[0][1]);
      compare_after_nudge(f, s, tally);
    }
    {  // A face without an area.
      const Vector3d corner = turning_vector(random, true);
      const VertexFaceSeparation<2> f{
          scene.a, scene.b, turning_vector(random, true), {corner, corner, Vector3d::Zero()}};
      wrong += mistakes_of_zero(f, scene, random, tally);
    }
  }
  tally.print("aligned", seed);
  CHECK(wrong == 0);
  CHECK(tally.wrong == 0);
  CHECK(tally.zeros_throughout < 120);
}

TEST_CASE("turning at rates of a simple ratio is told from turning at nearly that", "[turning]") {
  // A gear twice as fast: cos 2 t + 1 - 2 cos^2 t = 0 has both frequencies. The vertex is (cos 2 t, sin 2 t, 0) + (1,
  // 0, 0), the face holds the z axis and (cos t, sin t, 0), which is parallel to that.
  RigidMotion<1> a{{{Vector3d(1, 0, 0)}}};
  RigidMotion<1> b{{{Vector3d(0, 0, 0)}}};
  a.angular_velocity = {0, 0, 2};
  b.angular_velocity = {0, 0, 1};
  const VertexFaceSeparation<1> f{a, b, Vector3d(1, 0, 0), {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 0, 1)}};
  CHECK(vanishes(f));
  CHECK(sign_after(f, 0.7) == 0);
  a.angular_velocity[2] = next_up(2.0);
  CHECK_FALSE(vanishes(f));
  CHECK(sign_at(f, 0) == 0);
  CHECK(sign_after(f, 0) == -1);
  CHECK(sign_at(f, 1e-30) == -1);
  a.angular_velocity = {0, 0, -2};  // against each other
  CHECK_FALSE(vanishes(f));
  b.angular_velocity = {0, 0, -1};
  CHECK(vanishes(f));
  // Started apart they are not aligned, but at one time.
  a.path.start = 1;
  CHECK_FALSE(vanishes(f));
}

}  // namespace test_aligned
