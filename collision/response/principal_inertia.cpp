#include "collision/response/principal_inertia.hpp"

#include "collision/response/inertia.hpp"
#include "collision/vectors.hpp"
#include "kds/arithmetic/power_of_two.hpp"

#include <algorithm>
#include <cmath>

namespace kds::collision {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;

/// Turns the axes i and j so that the entry between them is zero; k is the third, after them in cyclic order.
void rotate(Matrix3d& m, Quaterniond& axes, Eigen::Index i) {
  const Eigen::Index j = (i + 1) % 3, k = (i + 2) % 3;
  const double off = m(i, j);
  if (off == 0) return;
  const double ratio = (m(i, i) - m(j, j)) / (2 * off);
  const double tangent = (ratio < 0 ? -1 : 1) / (std::abs(ratio) + std::sqrt(ratio * ratio + 1));
  const double cosine = 1 / std::sqrt(1 + tangent * tangent), sine = tangent * cosine;
  m(i, i) += tangent * off, m(j, j) -= tangent * off;
  m(i, j) = m(j, i) = 0;
  const double ik = m(i, k), jk = m(j, k);
  m(i, k) = m(k, i) = cosine * ik + sine * jk;
  m(j, k) = m(k, j) = cosine * jk - sine * ik;
  Quaterniond turn(std::sqrt((1 + cosine) / 2), 0, 0, 0);
  turn.vec()[k] = sine / (2 * turn.w());
  axes = product(axes, turn);
}

}  // namespace

PrincipalInertia principal_inertia(const Matrix3d& tensor) {
  constexpr int sweeps = 12;  // four do, as what is off the diagonal is squared by each
  int exponent = 0;
  std::frexp(tensor.cwiseAbs().maxCoeff(), &exponent);
  const double unit = power_of_two(-exponent);
  Matrix3d m = unit * tensor;
  PrincipalInertia result;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (Eigen::Index i = 0; i < 3; ++i) rotate(m, result.axes, i);
  }
  result.moments = m.diagonal() / unit;
  const double alike = inertia_tolerance * result.moments.maxCoeff();
  for (int k = 0; k < 3 && result.symmetry < 0; ++k) {
    double& first = result.moments[(k + 1) % 3];
    double& second = result.moments[(k + 2) % 3];
    if (!(std::abs(first - second) <= alike)) continue;
    result.symmetry = k;
    first = second = (first + second) / 2;
  }
  return result;
}

}  // namespace kds::collision
