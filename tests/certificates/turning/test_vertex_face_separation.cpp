// A vertex and a face of bodies that turn, against the definition in 330 bits.
#include "certificates/turning/vertex_face_separation.hpp"
#include "kds/turning/turning_failure_time.hpp"
#include "tests/certificates/turning/check_random_signs.hpp"
#include "tests/certificates/turning/check_turning.hpp"
#include "tests/certificates/turning/turning_scenes.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>

namespace test_vertex_face_separation {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::RigidMotion;
using certificates::VertexFaceSeparation;
using Eigen::Vector3d;

const std::array<Vector3d, 3> floor_of_body{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};

}  // namespace

TEMPLATE_TEST_CASE_SIG("signs of a vertex and a face that turn are those of the definition", "[turning]",
                       ((int Degree), Degree), 1, 2) {
  check_random_signs<Degree>("vertex and face", 310 + Degree, [](Random& random, bool coarse, const auto& scene) {
    VertexFaceSeparation<Degree> f{scene.a, scene.b, turning_vector(random, coarse), {}};
    for (Vector3d& corner : f.corners) corner = turning_vector(random, coarse);
    return f;
  });
}

TEST_CASE("a corner that turns goes through the floor where it is as low as its body is high", "[turning]") {
  // A rod of the length 1, turning in the plane x z at 1 rad/s: its end is at height 0.5 - sin t.
  RigidMotion<1> rod{{{Vector3d(0, 0, 0.5)}}};
  rod.angular_velocity = {0, 1, 0};
  const RigidMotion<1> ground{{{Vector3d(0, 0, 0)}}};
  const VertexFaceSeparation<1> f{rod, ground, Vector3d(1, 0, 0), floor_of_body};
  CHECK(sign_after(f, 0) == 1);
  const double through = failure_time(f, 0, 1);
  CHECK(std::abs(through - 0.52359877559829887) < 1e-15);  // pi / 6
  CHECK(sign_at(f, next_down(through)) == 1);
  CHECK(std::abs(recovery_time(f, 1, 10) - 2.6179938779914944) < 1e-15);  // 5 pi / 6
  CHECK(sign_after(f, 2) == -1);
  CHECK(sign_after(f, 3) == 1);
  CHECK(sign_at(f, 0, 1) == -1);  // it comes down
  CHECK(sign_at(f, 3, 1) == 1);
  // At the start it is exact: the height is 0.5, and so is that of the ground.
  const RigidMotion<1> table{{{Vector3d(0, 0, 0.5)}}};
  const VertexFaceSeparation<1> g{rod, table, Vector3d(1, 0, 0), floor_of_body};
  CHECK(sign_at(g, 0) == 0);
  CHECK(sign_after(g, 0) == -1);
  const VertexFaceSeparation<1> h{rod, table, Vector3d(-1, 0, 0), floor_of_body};
  CHECK(sign_after(h, 0) == 1);
}

TEST_CASE("a vertex that starts in a plane leaves it by the first derivative that is not zero", "[turning]") {
  // It turns about an axis in the plane, and comes from above: the first and the second derivatives decide.
  RigidMotion<2> body{{{Vector3d(0, 0, 0)}}};
  body.angular_velocity = {0, 0, 1};
  RigidMotion<2> plane{{{Vector3d(0, 0, 0)}}};
  const std::array<Vector3d, 3> upright{Vector3d(1, 0, 0), Vector3d(1, 1, 0), Vector3d(1, 0, 1)};  // x = 1, normal +x
  const VertexFaceSeparation<2> f{body, plane, Vector3d(1, 0, 0), upright};                        // cos t - 1
  CHECK(sign_at(f, 0) == 0);
  CHECK(sign_at(f, 0, 1) == 0);
  CHECK(sign_at(f, 0, 2) == -1);
  CHECK(sign_after(f, 0) == -1);
  CHECK_FALSE(vanishes(f));
  // The plane moves away as t^2 / 2 does: what is left is t^4 / 24.
  plane.path.coefficients[2] = Vector3d(-0.5, 0, 0);
  CHECK(sign_at(f, 0, 2) == 0);
  CHECK(sign_at(f, 0, 3) == 0);
  CHECK(sign_after(f, 0) == 1);
  plane.path.start = body.path.start = -5;  // the same where the epoch is another, but not at the start
  CHECK(sign_after(f, -5) == 1);
  CHECK(sign_after(f, 0) == 1);
}

TEST_CASE("numbers out of all range have exact signs too", "[turning]") {
  RigidMotion<1> body{{{Vector3d(0, 0, 0)}}};
  const RigidMotion<1> ground{{{Vector3d(0, 0, 0)}}};
  body.path.coefficients[1] = Vector3d::Zero();
  for (const double rate : {1e-300, 1e-160, 1e160, 1e300}) {
    for (const double length : {1e-250, 1.0, 1e250}) {
      CAPTURE(rate, length);
      body.angular_velocity = {0, rate, 0};
      body.orientation.coeffs() = {0, 0, 0, length};
      const VertexFaceSeparation<1> f{body, ground, Vector3d(length, 0, 0), floor_of_body};
      CHECK(sign_at(f, 0) == 0);
      CHECK(sign_after(f, 0) == -1);
      CHECK(sign_at(f, 1 / rate) == -1);  // an angle of 1
      CHECK(sign_at(f, 4 / rate) == 1);
    }
  }
}

}  // namespace test_vertex_face_separation
