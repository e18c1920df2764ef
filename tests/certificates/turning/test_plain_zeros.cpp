// Certificates that are zero at all times, told in doubles.
#include "certificates/turning/edge_edge_separation.hpp"
#include "certificates/turning/vertex_face_separation.hpp"
#include "kds/turning/turning_certificate.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstdint>

namespace test_plain_zeros {
namespace {

using namespace kds;
using namespace kds::certificates;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::tests::Random;

/// Falls along the z axis from a height that has all its digits.
RigidMotion<2> falling(double height, double start) {
  return {{{Vector3d(0.25, -0.5, height), Vector3d(0, 0, -0.1 * height), Vector3d(0, 0, -4.905)}, start}};
}

}  // namespace

TEST_CASE("corners of crates in the planes of the sides of others are told to stay there by doubles", "[turning]") {
  const RigidMotion<2> a = falling(1.1, 0.3), b = falling(0.1, 0.7);
  const std::array<Vector3d, 3> side{Vector3d(0.5, -0.5, -0.5), Vector3d(0.5, 0.5, -0.5), Vector3d(0.5, 0.5, 0.5)};
  const VertexFaceSeparation<2> flush{a, b, Vector3d(0.5, -0.5, 0.5), side};
  CHECK(detail::plainly_vanishes(flush));
  CHECK(vanishes(flush));
  CHECK(sign_after(flush, 0.9) == 0);
  const VertexFaceSeparation<2> beyond{a, b, Vector3d(0.75, -0.5, 0.5), side};
  CHECK_FALSE(detail::plainly_vanishes(beyond));
  CHECK(sign_after(beyond, 0.9) == 1);
  // They turn together, by an angular velocity with all its digits: that takes exact numbers.
  RigidMotion<2> turning_a = a, turning_b = b;
  for (RigidMotion<2>* motion : {&turning_a, &turning_b}) {
    motion->angular_velocity = {0, 0, 0.1};
    motion->path.start = 0.3;
  }
  const VertexFaceSeparation<2> turns{turning_a, turning_b, Vector3d(0.5, -0.5, 0.5), side};
  CHECK(vanishes(turns));
  CHECK(sign_after(turns, 0.9) == 0);
}

TEST_CASE("what doubles tell to be zero at all times is, on a lattice", "[turning]") {
  int plain = 0, zeros = 0;
  for (std::uint64_t seed = 1; seed <= 4000; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const auto coarse = [&] { return std::round(random.between(-1.5, 1.5)) / 2; };
    const auto point = [&] { return Vector3d(coarse(), coarse(), coarse()); };
    const auto motion = [&] {
      RigidMotion<2> m{{{point(), random.one_in(2) ? Vector3d(0, 0, random.unit()) : point()}, coarse()}};
      if (random.one_in(3)) m.angular_velocity = point();
      if (random.one_in(3)) m.orientation = Quaterniond(1, coarse(), coarse(), coarse());
      return m;
    };
    const RigidMotion<2> a = motion(), b = random.one_in(2) ? motion() : a;
    const std::array<Vector3d, 3> face{point(), point(), point()};
    const auto check = [&](const auto& certificate) {
      const bool told = detail::plainly_vanishes(certificate);
      const auto f = certificate.template turning_sum<Exact, 2>(1.0);
      const bool zero = vanishes_throughout(f, certificate.spins()[0], certificate.spins()[1]);
      if (told) CHECK(zero);
      CHECK(vanishes(certificate) == zero);
      CHECK((sign_after(certificate, 1.25) == 0) == zero);
      plain += told, zeros += zero;
    };
    check(VertexFaceSeparation<2>{a, b, point(), face});
    check(EdgeEdgeSeparation<2>{a, b, {point(), point()}, {point(), point()}});
  }
  CHECK(plain > 100);
  CHECK(zeros >= plain);
}

}  // namespace test_plain_zeros
