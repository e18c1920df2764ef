#include "collision/response/inertia.hpp"
#include "tests/support/random_numbers.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace test_inertia {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using kds::collision::checked_inertia;
using kds::collision::inverse_inertia;
using kds::collision::is_spherical;
using kds::collision::turned_tensor;
using kds::tests::Random;
using Matrix3l = Eigen::Matrix<long double, 3, 3>;

Matrix3d any_rotation(Random& random) {
  Eigen::Vector4d q;
  do {
    for (int i = 0; i < 4; ++i) q[i] = random.between(-1, 1);
  } while (q.norm() < 0.1);
  return Eigen::Quaterniond(q.normalized()).toRotationMatrix();
}

std::string message(const Matrix3d& inertia) {
  try {
    checked_inertia(inertia);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

Matrix3d moments(double x, double y, double z) { return Vector3d(x, y, z).asDiagonal(); }

TEST_CASE("A tensor that no body has is refused in one line", "[inertia]") {
  Matrix3d m = moments(1, 2, 2);
  CHECK(message(m).empty());
  m(0, 2) = std::numeric_limits<double>::quiet_NaN();
  CHECK(message(m) == "inertia: must be finite");
  m(0, 2) = -std::numeric_limits<double>::infinity();
  CHECK(message(m) == "inertia: must be finite");
  CHECK(message(Matrix3d::Zero()) == "inertia: must not be zero");
  CHECK(message(moments(1e-200, 1e-200, 1e-200)) ==
        "inertia: its greatest entry is 1e-200; from 2^-617 (1.8e-186) to 2^617 (5.4e185) is supported");
  CHECK(message(moments(1e200, 1e200, 1e200)) ==
        "inertia: its greatest entry is 1e+200; from 2^-617 (1.8e-186) to 2^617 (5.4e185) is supported");
  m(0, 2) = 0.5;
  CHECK(message(m) == "inertia: must be symmetric: entries (0, 2) and (2, 0) are 0.5 and 0");
  CHECK(message(moments(1, 1, 0)) == "inertia: must be positive definite");
  CHECK(message(moments(1, 1, -1)) == "inertia: must be positive definite");
  CHECK(message(moments(-1, -1, -1)) == "inertia: must be positive definite");
  m = Matrix3d::Identity();
  m(0, 1) = m(1, 0) = 2;
  CHECK(message(m) == "inertia: must be positive definite");
  CHECK(message(moments(1, 1, 2.001)) ==
        "inertia: is of no body: its greatest moment exceeds the sum of the two others");
}

TEST_CASE("Flat bodies, rods and the ends of the range are accepted", "[inertia]") {
  Random random(11);
  CHECK(message(moments(1, 1, 2)).empty());
  CHECK(message(moments(1, 1, 1e-25)).empty());
  CHECK(message(0x1p-617 * Matrix3d::Identity()).empty());
  CHECK(message(0x1p617 * Matrix3d::Identity()).empty());
  for (int i = 0; i < 1000; ++i) {
    // A plate, turned: what rounding makes of the equality must not matter, nor that entries differ by roundings.
    const double x = random.between(0.1, 1), y = random.between(0.1, 1);
    const Matrix3d r = any_rotation(random);
    const Matrix3d m = r * moments(x, y, x + y) * r.transpose();
    REQUIRE(message(m).empty());
    const Matrix3d checked = checked_inertia(m);
    CHECK(checked == checked.transpose());
    CHECK((checked - m).cwiseAbs().maxCoeff() < 1e-15);
    CHECK(message(checked * 1e100).empty());
    CHECK(message(r * moments(x, y, (x + y) * (1 + 1e-12)) * r.transpose()) != "");
  }
}

TEST_CASE("Moments that differ by roundings are equal", "[inertia]") {
  Random random(12);
  CHECK(is_spherical(Matrix3d::Identity()));
  CHECK(is_spherical(1e-150 * Matrix3d::Identity()));
  CHECK(!is_spherical(moments(1, 1, 1 + 0x1p-40)));
  CHECK(!is_spherical(moments(1, 1, 1 - 0x1p-40)));
  Matrix3d m = Matrix3d::Identity();
  m(1, 2) = m(2, 1) = 1e-13;
  CHECK(!is_spherical(m));
  for (int i = 0; i < 1000; ++i) {
    const Matrix3d r = any_rotation(random);
    CHECK(is_spherical(r * (random.between(1, 9) * Matrix3d::Identity()) * r.transpose()));
  }
}

TEST_CASE("Inverses of tensors are rounded once", "[inertia]") {
  Random random(13);
  for (const double thin : {1.0, 1e-3, 1e-6, 1e-11}) {
    for (int i = 0; i < 300; ++i) {
      const Matrix3d r = any_rotation(random);
      const double unit = std::ldexp(1.0, random.integer(-600, 600));
      Matrix3d m = turned_tensor(moments(random.between(0.5, 1) * thin, random.between(0.5, 0.7), 0.6), r);
      const Matrix3d inverse = inverse_inertia(unit * m);
      CHECK(inverse == inverse.transpose());
      // m times the inverse is 1, up to half a rounding of its greatest entry, thrice.
      const Matrix3l off = (unit * m).cast<long double>() * inverse.cast<long double>() - Matrix3l::Identity();
      CHECK(off.cwiseAbs().maxCoeff() <
            4 * 0x1p-53L * m.cwiseAbs().maxCoeff() * (unit * inverse).cwiseAbs().maxCoeff());
    }
  }
  CHECK(inverse_inertia(moments(2, 4, 5)) == moments(0.5, 0.25, 0.2));
}

TEST_CASE("Turned tensors are those of long doubles", "[inertia]") {
  Random random(14);
  for (int i = 0; i < 1000; ++i) {
    const Matrix3d r = any_rotation(random), s = any_rotation(random);
    const Matrix3d m = turned_tensor(moments(1, random.between(0.5, 1.5), 1), s);
    const Matrix3d turned = turned_tensor(m, r);
    CHECK(turned == turned.transpose());
    const Matrix3l exact = r.cast<long double>() * m.cast<long double>() * r.cast<long double>().transpose();
    CHECK((turned.cast<long double>() - exact).cwiseAbs().maxCoeff() < 16 * 0x1p-53L * m.cwiseAbs().sum());
  }
  CHECK(turned_tensor(moments(1, 2, 3), Matrix3d::Identity()) == moments(1, 2, 3));
}

}  // namespace

}  // namespace test_inertia
