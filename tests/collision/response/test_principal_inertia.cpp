#include "collision/response/principal_inertia.hpp"

#include "collision/response/inertia.hpp"
#include "tests/collision/response/random_rotation.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace test_principal_inertia {
namespace {

using namespace kds::collision;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::collision::tests::random_rotation;
using kds::tests::Random;

Matrix3d put_together(const PrincipalInertia& inertia) {
  const Matrix3d axes = inertia.axes.toRotationMatrix();
  return axes * inertia.moments.asDiagonal() * axes.transpose();
}

}  // namespace

TEST_CASE("principal inertia: moments and axes make the tensor again") {
  constexpr double tolerance = 0x1p-46;  // as the header says
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    Vector3d moments(random.between(0.1, 1), random.between(0.1, 1), 0);
    moments[2] = random.between(std::abs(moments[0] - moments[1]), moments[0] + moments[1]);
    if (seed % 5 == 0) moments = Vector3d(1e-6, 1, 1);
    if (seed % 5 == 1) moments = Vector3d(0.5, 0.5 * (1 + 1e-12), 0.75);
    const Matrix3d axes = random_rotation(random).toRotationMatrix();
    const Matrix3d tensor = checked_inertia(std::ldexp(1.0, static_cast<int>(seed % 41) * 20 - 400) *
                                            (axes * moments.asDiagonal() * axes.transpose()));
    const PrincipalInertia found = principal_inertia(tensor);
    const double greatest = tensor.cwiseAbs().maxCoeff();
    CHECK((put_together(found) - tensor).cwiseAbs().maxCoeff() <= tolerance * greatest);
    CHECK(std::abs(found.axes.norm() - 1) < 1e-14);
    CHECK((found.symmetry >= 0) == (seed % 5 == 0));
  }
}

TEST_CASE("principal inertia: a diagonal tensor is as it is, and equal moments make a top") {
  const auto of = [](double a, double b, double c) { return principal_inertia(Vector3d(a, b, c).asDiagonal()); };
  const PrincipalInertia three = of(3, 4, 5);
  CHECK(three.moments == Vector3d(3, 4, 5));
  CHECK(three.axes.coeffs() == Quaterniond::Identity().coeffs());
  CHECK(three.symmetry == -1);
  CHECK(of(2, 1, 1).symmetry == 0);
  CHECK(of(1, 2, 1).symmetry == 1);
  CHECK(of(1, 1, 2).symmetry == 2);
  CHECK(of(1, 1 + 1e-12, 2).symmetry == -1);
  const PrincipalInertia nearly = of(1, 1 + 0x1p-48, 2);
  CHECK(nearly.symmetry == 2);
  CHECK(nearly.moments[0] == nearly.moments[1]);
}

}  // namespace test_principal_inertia
