#include "collision/response/inertia.hpp"

#include "kds/arithmetic/double_double.hpp"
#include "kds/arithmetic/power_of_two.hpp"
#include "kds/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace kds::collision {
namespace {

using Eigen::Matrix3d;

constexpr double least_entry = 0x1p-617;
constexpr double greatest_entry = 0x1p617;

/// For symmetric matrices; products of entries must neither overflow nor underflow.
DoubleDouble minor_of(const Matrix3d& m, Eigen::Index i, Eigen::Index j, Eigen::Index k, Eigen::Index l) {
  return two_product(m(i, k), m(j, l)) - two_product(m(i, l), m(j, k));
}
DoubleDouble determinant(const Matrix3d& m) {
  return minor_of(m, 1, 2, 1, 2) * m(0, 0) - minor_of(m, 1, 2, 0, 2) * m(0, 1) + minor_of(m, 1, 2, 0, 1) * m(0, 2);
}

/// A power of two that brings the greatest entry to between 1/2 and 1.
double unit_of(const Matrix3d& m) {
  int exponent = 0;
  std::frexp(m.cwiseAbs().maxCoeff(), &exponent);
  return power_of_two(-exponent);
}

[[noreturn]] void refuse_tensor(const std::string& what) { throw std::invalid_argument("inertia: " + what); }

}  // namespace

bool detail::positive_definite(const Matrix3d& matrix) {
  const Matrix3d m = unit_of(matrix) * matrix;
  return m(0, 0) > 0 && minor_of(m, 0, 1, 0, 1).high > 0 && determinant(m).high > 0;
}

bool is_spherical(const Matrix3d& inertia) {
  const double greatest = inertia.cwiseAbs().maxCoeff();
  const double least_moment = std::min({inertia(0, 0), inertia(1, 1), inertia(2, 2)});
  const double greatest_moment = std::max({inertia(0, 0), inertia(1, 1), inertia(2, 2)});
  double off = greatest_moment - least_moment;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      if (i != j) off = std::max(off, std::abs(inertia(i, j)));
    }
  }
  return off <= inertia_tolerance * greatest;
}

Matrix3d checked_inertia(const Matrix3d& inertia) {
  if (!inertia.allFinite()) refuse_tensor("must be finite");
  const double greatest = inertia.cwiseAbs().maxCoeff();
  if (!(greatest > 0)) refuse_tensor("must not be zero");
  if (!(greatest >= least_entry && greatest <= greatest_entry)) {
    refuse_tensor("its greatest entry is " + number_text(greatest) + "; from " + power_text(least_entry) + " to " +
                  power_text(greatest_entry) + " is supported");
  }
  const double unit = unit_of(inertia);
  Matrix3d m = unit * inertia;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      if (!(std::abs(m(i, j) - m(j, i)) <= inertia_tolerance)) {
        refuse_tensor("must be symmetric: entries (" + std::to_string(j) + ", " + std::to_string(i) + ") and (" +
                      std::to_string(i) + ", " + std::to_string(j) + ") are " + number_text(inertia(j, i)) + " and " +
                      number_text(inertia(i, j)));
      }
      m(i, j) = m(j, i) = (m(i, j) + m(j, i)) / 2;
    }
  }
  if (!detail::positive_definite(m)) refuse_tensor("must be positive definite");
  // The integrals of x x^T over the body: half the trace minus the tensor. They are not negative for any body.
  const double trace = m(0, 0) + m(1, 1) + m(2, 2);
  Matrix3d spread = -m;
  for (Eigen::Index i = 0; i < 3; ++i) spread(i, i) += trace / 2 + 4 * inertia_tolerance * trace;
  if (!detail::positive_definite(spread))
    refuse_tensor("is of no body: its greatest moment exceeds the sum of the two others");
  return m / unit;
}

Matrix3d inverse_inertia(const Matrix3d& inertia) {
  const double unit = unit_of(inertia);
  const Matrix3d m = unit * inertia;
  const DoubleDouble whole = determinant(m);
  Matrix3d inverse;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      const DoubleDouble cofactor = minor_of(m, (j + 1) % 3, (j + 2) % 3, (i + 1) % 3, (i + 2) % 3);
      inverse(i, j) = inverse(j, i) = unit * (cofactor / whole).high;
    }
  }
  return inverse;
}

Matrix3d turned_tensor(const Matrix3d& tensor, const Matrix3d& rotation) {
  const auto row_by_column = [](const Matrix3d& a, Eigen::Index i, const Matrix3d& b, Eigen::Index j) {
    return a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j);
  };
  Matrix3d half, result;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) half(i, j) = row_by_column(rotation, i, tensor, j);
  }
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      result(i, j) = result(j, i) =
          half(i, 0) * rotation(j, 0) + half(i, 1) * rotation(j, 1) + half(i, 2) * rotation(j, 2);
    }
  }
  return result;
}

}  // namespace kds::collision
