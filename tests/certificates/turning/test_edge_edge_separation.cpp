// Edges of bodies that turn, against the definition in 330 bits.
#include "certificates/turning/edge_edge_separation.hpp"
#include "tests/certificates/turning/check_random_signs.hpp"
#include "tests/certificates/turning/check_turning.hpp"
#include "tests/certificates/turning/turning_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>

namespace test_edge_edge_separation {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::EdgeEdgeSeparation;
using certificates::RigidMotion;
using Eigen::Vector3d;

}  // namespace

TEMPLATE_TEST_CASE_SIG("signs of two edges that turn are those of the definition", "[turning]", ((int Degree), Degree),
                       1, 2) {
  check_random_signs<Degree>("two edges", 320 + Degree, [](Random& random, bool coarse, const auto& scene) {
    EdgeEdgeSeparation<Degree> f{scene.a, scene.b, {}, {}};
    for (Vector3d& end : f.edge_a) end = turning_vector(random, coarse);
    for (Vector3d& end : f.edge_b) end = turning_vector(random, coarse);
    if (random.one_in(10)) f.edge_b = f.edge_a;
    return f;
  });
}

TEST_CASE("a blade that turns meets an edge", "[turning]") {
  // An edge along y, at x = 1 in its body, turns about z; the other is upright, at a distance of 1.25 and 30 degrees.
  RigidMotion<1> blade{{{Vector3d(0, 0, 0)}}};
  blade.angular_velocity = {0, 0, 2};
  RigidMotion<1> pole{{{Vector3d(0, 1, 0)}}};
  const EdgeEdgeSeparation<1> f{
      blade, pole, {Vector3d(0, 0, 0.5), Vector3d(2, 0, 0.5)}, {Vector3d(1, 0, 0), Vector3d(1, 0, 1)}};
  // The blade points to (cos 2 t, sin 2 t), the pole stands in (1, 1): coplanar at 2 t = pi / 4, and 5 pi / 4.
  const double met = change_of_sign(f, 0, 1);
  CHECK(std::abs(met - 0.39269908169872414) < 1e-15);
  CHECK(std::abs(change_of_sign(f, 1, 2) - 1.9634954084936207) < 1e-15);
  const EdgeEdgeSeparation<1> exchanged{blade, pole, {f.edge_a[1], f.edge_a[0]}, f.edge_b};
  CHECK(sign_after(exchanged, 0) == -sign_after(f, 0));
  // The derivative has the sign that the blade's turning gives.
  CHECK(sign_at(f, met, 1) == sign_after(f, met));
}

}  // namespace test_edge_edge_separation
