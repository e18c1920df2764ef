#include "collision/response/mass_properties.hpp"

#include "collision/precise_vector.hpp"
#include "collision/response/inertia.hpp"
#include "collision/shapes/shape_forms.hpp"
#include "collision/shapes/shape_kinds.hpp"
#include "collision/shapes/solid_integrals.hpp"
#include "collision/vectors.hpp"

#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace kds::collision {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

[[noreturn]] void refuse(const char* kind, const std::string& what) {
  throw std::invalid_argument(std::string("mass_properties: the ") + kind + ' ' + what);
}

/// Errors of the integrals, each relative to 6 times the volume and in the unit of lengths, make at most 12 times as
/// much of the tensor: 2 for a quotient of integrals, 4 for the product of two centres, both of two squares. The unit
/// is at most twice the extent, so it makes 48 of 2^-56 m s^2.
constexpr double largest_error = 0x1p-56;

/// 16 times the bound on the error of the tensor, 2^-50, over a greatest moment that is seldom below a quarter of m
/// s^2.
constexpr double least_share = 0x1p-44;

/// A solid that a closed surface bounds, by its integrals. `kind`, in messages.
const SolidIntegrals& solid_in(const char* kind, const Mesh& mesh) {
  const SolidIntegrals& sum = mesh.solid();
  const double least = sum.error(mesh.triangles().size()) / largest_error;
  if (sum.volume.high < -least) refuse(kind, "is inside out: its triangles turn clockwise seen from outside");
  if (!(sum.volume.high > least)) refuse(kind, "has no volume beyond rounding");
  return sum;
}

/// What is not told from zero is zero, as the products of inertia of what is symmetric up to roundings of the sums:
/// then a body that turns about an axis of symmetry keeps it exactly, and the signs of what is parallel to it are those
/// of zero.
MassProperties of_integrals(const char* kind, const SolidIntegrals& sum, std::size_t triangles, double scale,
                            double mass) {
  const double error = 12 * sum.error(triangles) / sum.volume.high;  // as above, of the tensor in its unit
  const auto told = [error](DoubleDouble x) { return std::abs(x.high) > error ? x : DoubleDouble{}; };
  MassProperties result{mass, Vector3d::Zero(), Matrix3d::Zero()};
  PreciseVector centre, mean_square;
  for (std::size_t d = 0; d < 3; ++d) {
    centre[d] = sum.first[d] / (sum.volume * 4.0);
    const double origin = sum.origin[static_cast<Eigen::Index>(d)];
    result.centre[static_cast<Eigen::Index>(d)] = (told(centre[d] + origin / sum.unit) * (sum.unit * scale)).high;
  }
  const DoubleDouble twenty = sum.volume * 20.0;
  for (std::size_t d = 0; d < 3; ++d) mean_square[d] = sum.squares[d] / twenty - centre[d] * centre[d];
  const double length = scale * sum.unit;
  const double whole = mass * length * length;
  for (std::size_t d = 0; d < 3; ++d) {
    const std::size_t e = (d + 1) % 3, f = (d + 2) % 3;
    const auto i = static_cast<Eigen::Index>(d), j = static_cast<Eigen::Index>(e), k = static_cast<Eigen::Index>(f);
    result.inertia(i, i) = whole * (mean_square[e] + mean_square[f]).high;
    const DoubleDouble product = told(sum.products[d] / twenty - centre[e] * centre[f]);
    result.inertia(j, k) = result.inertia(k, j) = -(whole * product.high);
  }
  Matrix3d certain = result.inertia;
  certain.diagonal().array() -= least_share * result.inertia.diagonal().maxCoeff();
  if (!detail::positive_definite(certain))
    refuse(kind, "is too thin: its least moment of inertia is lost in roundings");
  checked_inertia(result.inertia);
  return result;
}

/// A part of a compound, a hull or a mesh.
struct SolidPart {
  const char* kind;
  SolidIntegrals integrals;
  std::size_t triangles;
  double volume;
};

SolidPart solid_part(const Shape& shape) {
  const char* const kind = kind_name(shape);
  const Mesh& mesh = *triangles_of(shape);
  const SolidIntegrals& sum = solid_in(kind, mesh);
  return {kind, sum, mesh.triangles().size(), (sum.volume / 6.0).high * sum.unit * sum.unit * sum.unit};
}

/// Parts of one density, by the theorem of parallel axes. What cancels where parts are about each other, the sum of
/// their places, is summed up in double-doubles.
MassProperties of_parts(const Compound& whole, double mass) {
  const auto shapes = whole.parts->parts();
  const auto of_each_part = [&](const auto& make) {
    std::vector<std::decay_t<decltype(make(std::size_t{0}))>> made;
    try {
      while (made.size() < shapes.size()) made.push_back(make(made.size()));
    } catch (const std::invalid_argument& error) {
      throw InvalidCompound(error.what(), made.size());
    }
    return made;
  };
  const auto solids = of_each_part([&](std::size_t i) { return solid_part(shapes[i]); });
  DoubleDouble volume{};
  for (const SolidPart& solid : solids) volume = volume + solid.volume;
  const auto parts = of_each_part([&](std::size_t i) {
    return of_integrals(solids[i].kind, solids[i].integrals, solids[i].triangles, 1,
                        mass * (solids[i].volume / volume.high));
  });
  MassProperties result{mass, Vector3d::Zero(), Matrix3d::Zero()};
  for (Eigen::Index d = 0; d < 3; ++d) {
    DoubleDouble moment{};
    for (std::size_t i = 0; i < parts.size(); ++i) moment = moment + two_product(solids[i].volume, parts[i].centre[d]);
    result.centre[d] = (moment / volume).high;
  }
  for (const MassProperties& part : parts) {
    const Vector3d arm = part.centre - result.centre;
    result.inertia += part.inertia + part.mass * (dot(arm, arm) * Matrix3d::Identity() - arm * arm.transpose());
  }
  result.inertia = checked_inertia(result.inertia);
  return result;
}

}  // namespace

MassProperties mass_properties(const Shape& shape, double mass) {
  require_size(mass, "mass");
  place(shape, Eigen::Quaterniond::Identity());
  return ask_kind(shape, [&](auto kind, const auto& each) -> MassProperties {
    using Kind = std::decay_t<decltype(each)>;
    if constexpr (requires { kind.moments(each, mass); }) {
      return {mass, Vector3d::Zero(), Matrix3d(kind.moments(each, mass).asDiagonal())};
    } else if constexpr (std::is_same_v<Kind, Compound>) {
      return of_parts(each, mass);
    } else if constexpr (std::is_same_v<Kind, BendingMesh>) {
      throw std::invalid_argument("shape: a mesh that bends has no mass properties of its own");
    } else if constexpr (std::is_same_v<Kind, HalfSpace>) {
      throw std::invalid_argument("mass_properties: a half-space has no mass");
    } else {
      const MeshShape surface = surface_of(shape);
      const SolidIntegrals& sum = solid_in(kind.name, *surface.mesh);
      return of_integrals(kind.name, sum, surface.mesh->triangles().size(), surface.scale, mass);
    }
  });
}

/// Twice, since coordinates of parts that are far from the origin are rounded more coarsely.
std::vector<CompoundPart> about_centre_of_mass(std::span<const CompoundPart> parts) {
  std::vector<CompoundPart> moved(parts.begin(), parts.end());
  for (int round = 0; round < 2; ++round) {
    const Vector3d centre = mass_properties(compound(moved), 1).centre;
    for (CompoundPart& part : moved) part.position -= centre;
  }
  return moved;
}

}  // namespace kds::collision
