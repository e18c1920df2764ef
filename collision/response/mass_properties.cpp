#include "collision/response/mass_properties.hpp"

#include "collision/precise_vector.hpp"
#include "collision/response/inertia.hpp"
#include "collision/shapes/compound.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/shapes/polytope.hpp"
#include "collision/vectors.hpp"
#include "kds/arithmetic/power_of_two.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

namespace kds::collision {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

[[noreturn]] void refuse(const char* kind, const std::string& what) {
  throw std::invalid_argument(std::string("mass_properties: the ") + kind + ' ' + what);
}
[[noreturn]] void refuse_mesh(const std::string& what) { refuse("mesh", what); }

/// For each vertex the first one at its place.
std::vector<std::uint32_t> first_at_place(std::span<const Vector3d> vertices) {
  const auto before = [&](std::uint32_t i, std::uint32_t j) {
    const Vector3d& v = vertices[i];
    const Vector3d& w = vertices[j];
    return std::tie(v[0], v[1], v[2], i) < std::tie(w[0], w[1], w[2], j);
  };
  std::vector<std::uint32_t> order(vertices.size()), first(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), before);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool same = k > 0 && vertices[order[k]] == vertices[order[k - 1]];
    first[order[k]] = same ? first[order[k - 1]] : order[k];
  }
  return first;
}

/// A side of a triangle, between places.
struct Side {
  std::uint32_t low, high;  // the first vertices at its ends
  bool upward;              // from low to high
  std::uint32_t triangle;
};

/// Precondition: all sides between two places, whose directions do not cancel each other.
[[noreturn]] void refuse_edge(std::span<const Side> sides) {
  const std::string edge = "edge " + std::to_string(sides[0].low) + "-" + std::to_string(sides[0].high);
  if (sides.size() == 1) {
    refuse_mesh("is open: " + edge + " belongs to one triangle, " + std::to_string(sides[0].triangle));
  }
  if (sides.size() % 2 != 0)
    refuse_mesh("is open: " + edge + " belongs to " + std::to_string(sides.size()) + " triangles");
  std::vector<std::uint32_t> up, down;
  for (const Side& side : sides) (side.upward ? up : down).push_back(side.triangle);
  const std::vector<std::uint32_t>& more = up.size() > down.size() ? up : down;
  refuse_mesh("is not consistently oriented: triangles " + std::to_string(more[0]) + " and " + std::to_string(more[1]) +
              " both run along " + edge + " that way");
}

/// Checks that triangles run along each edge as often in one direction as in the other. Then the integrals do not
/// depend on the common corner of the tetrahedra.
void require_closed(const Mesh& mesh) {
  const std::vector<std::uint32_t> first = first_at_place(mesh.vertices());
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles().size());
  for (std::uint32_t i = 0; i < mesh.triangles().size(); ++i) {
    const Mesh::Triangle& triangle = mesh.triangles()[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = first[triangle[k]], to = first[triangle[(k + 1) % 3]];
      sides.push_back({std::min(from, to), std::max(from, to), from < to, i});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
    return std::tie(x.low, x.high, x.triangle) < std::tie(y.low, y.high, y.triangle);
  });
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i, upward = 0;
    for (; end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high; ++end) {
      upward += sides[end].upward;
    }
    if (2 * upward != end - i) refuse_edge(std::span(sides).subspan(i, end - i));
    i = end;
  }
}

/// Integrals over the solid, with lengths in `unit`, a power of two, counted from `origin`: 6 times the volume, 24
/// times the integral of x, 120 times that of x x^T. In this unit no coordinate is beyond 1.
struct Integrals {
  Vector3d origin;
  double unit = 1;
  DoubleDouble volume{};
  PreciseVector first{};
  PreciseVector squares{}, products{};  // of x x, y y, z z; of y z, z x, x y
  double magnitude = 0;                 // sum of bounds on the magnitudes of the tetrahedra's volumes

  /// 6 times the volume, off the exact one by at most this. A determinant is 6 products of 3 exact differences, each
  /// sum and product rounded by 2^-102 of itself; so are the n sums. The other integrals, with their factors of 6 / 24
  /// and 6 / 120 and coordinates up to 1, are off by less.
  double error(std::size_t triangles) const { return (static_cast<double>(triangles) + 16) * 0x1p-102 * magnitude; }
};

Integrals integrate(const Mesh& mesh) {
  Integrals sum;
  // A corner of a triangle: the triangles around it make tetrahedra without volume, which are left out.
  sum.origin = mesh.vertices()[mesh.triangles()[0][0]];
  double largest = 0;
  for (const Mesh::Triangle& triangle : mesh.triangles()) {
    for (const std::uint32_t i : triangle) {
      largest = std::max(largest, (mesh.vertices()[i] - sum.origin).cwiseAbs().maxCoeff());
    }
  }
  int exponent = 0;
  std::frexp(largest, &exponent);
  sum.unit = power_of_two(exponent);
  const double per_unit = power_of_two(-exponent);
  for (const auto& [i, j, k] : mesh.triangles()) {
    const Vector3d &p = mesh.vertices()[i], &q = mesh.vertices()[j], &r = mesh.vertices()[k];
    const PreciseVector a = precise_difference(p, sum.origin) * per_unit;
    const PreciseVector b = precise_difference(q, sum.origin) * per_unit;
    const PreciseVector c = precise_difference(r, sum.origin) * per_unit;
    const PreciseVector e = precise_difference(q, p) * per_unit;
    const PreciseVector f = precise_difference(r, p) * per_unit;
    const DoubleDouble determinant = dot(a, cross(e, f));
    sum.magnitude += magnitude_sum(a) * magnitude_sum(e) * magnitude_sum(f);
    sum.volume = sum.volume + determinant;
    // Over a tetrahedron with a corner at the origin the integral of x is V / 4 times the sum s of the other corners,
    // that of x x^T is V / 20 times the sum of their squares and that of s.
    const PreciseVector s = a + b + c;
    sum.first += s * determinant;
    for (std::size_t d = 0; d < 3; ++d) {
      const auto product = [&](std::size_t x, std::size_t y) {
        return (a[x] * a[y] + b[x] * b[y] + c[x] * c[y] + s[x] * s[y]) * determinant;
      };
      sum.squares[d] = sum.squares[d] + product(d, d);
      sum.products[d] = sum.products[d] + product((d + 1) % 3, (d + 2) % 3);
    }
  }
  return sum;
}

/// Errors of the integrals, each relative to 6 times the volume and in the unit of lengths, make at most 12 times as
/// much of the tensor: 2 for a quotient of integrals, 4 for the product of two centres, both of two squares. The unit
/// is at most twice the extent, so it makes 48 of 2^-56 m s^2.
constexpr double largest_error = 0x1p-56;

/// 16 times the bound on the error of the tensor, 2^-50, over a greatest moment that is seldom below a quarter of m
/// s^2.
constexpr double least_share = 0x1p-44;

/// A solid that a closed surface bounds, by its integrals. `kind`, in messages.
Integrals solid_in(const char* kind, const Mesh& mesh) {
  const Integrals sum = integrate(mesh);
  const double least = sum.error(mesh.triangles().size()) / largest_error;
  if (sum.volume.high < -least) refuse(kind, "is inside out: its triangles turn clockwise seen from outside");
  if (!(sum.volume.high > least)) refuse(kind, "has no volume beyond rounding");
  return sum;
}

MassProperties of_integrals(const char* kind, const Integrals& sum, double scale, double mass) {
  MassProperties result{mass, Vector3d::Zero(), Matrix3d::Zero()};
  PreciseVector centre, mean_square;
  for (std::size_t d = 0; d < 3; ++d) {
    centre[d] = sum.first[d] / (sum.volume * 4.0);
    const DoubleDouble place = (centre[d] * sum.unit + sum.origin[static_cast<Eigen::Index>(d)]) * scale;
    result.centre[static_cast<Eigen::Index>(d)] = place.high;
  }
  const DoubleDouble twenty = sum.volume * 20.0;
  for (std::size_t d = 0; d < 3; ++d) mean_square[d] = sum.squares[d] / twenty - centre[d] * centre[d];
  const double length = scale * sum.unit;
  const double whole = mass * length * length;
  for (std::size_t d = 0; d < 3; ++d) {
    const std::size_t e = (d + 1) % 3, f = (d + 2) % 3;
    const auto i = static_cast<Eigen::Index>(d), j = static_cast<Eigen::Index>(e), k = static_cast<Eigen::Index>(f);
    result.inertia(i, i) = whole * (mean_square[e] + mean_square[f]).high;
    const DoubleDouble product = sum.products[d] / twenty - centre[e] * centre[f];
    result.inertia(j, k) = result.inertia(k, j) = -(whole * product.high);
  }
  Matrix3d certain = result.inertia;
  certain.diagonal().array() -= least_share * result.inertia.diagonal().maxCoeff();
  if (!detail::positive_definite(certain))
    refuse(kind, "is too thin: its least moment of inertia is lost in roundings");
  checked_inertia(result.inertia);
  return result;
}

MassProperties solid(double mass, const Vector3d& moments) {
  return {mass, Vector3d::Zero(), Matrix3d(moments.asDiagonal())};
}

MassProperties of(const Sphere& ball, double mass) {
  return solid(mass, Vector3d::Constant(0.4 * mass * (ball.radius * ball.radius)));
}

MassProperties of(const Box& box, double mass) {
  const Vector3d squares = box.half_extents.cwiseProduct(box.half_extents);
  return solid(mass, Vector3d(mass * (squares[1] + squares[2]) / 3, mass * (squares[2] + squares[0]) / 3,
                              mass * (squares[0] + squares[1]) / 3));
}

/// A cylinder and two halves of a ball, whose centres of mass are 3/8 of the radius from where they are cut.
MassProperties of(const Capsule& capsule, double mass) {
  const double r = capsule.radius, h = capsule.half_length;
  const double of_cylinder = mass * (3 * h) / (3 * h + 2 * r);
  const double of_ball = mass * (2 * r) / (3 * h + 2 * r);
  const double ball = 0.4 * (r * r);
  const double across = of_cylinder * (r * r / 4 + h * h / 3) + of_ball * (ball + h * h + 0.75 * (h * r));
  const double along = of_cylinder * (r * r / 2) + of_ball * ball;
  return solid(mass, Vector3d(across, across, along));
}

MassProperties of(const MeshShape& shape, double mass) {
  require_closed(*shape.mesh);
  return of_integrals("mesh", solid_in("mesh", *shape.mesh), shape.scale, mass);
}

MassProperties of(const ConvexHull& hull, double mass) {
  return of_integrals("hull", solid_in("hull", *hull.polytope->surface()), 1, mass);
}

MassProperties of(const HalfSpace&, double) {
  throw std::invalid_argument("mass_properties: a half-space has no mass");
}

/// A part of a compound.
struct SolidPart {
  const char* kind;
  Integrals integrals;
  double volume;
};

SolidPart solid_part(const Shape& shape) {
  const auto* const hull = std::get_if<ConvexHull>(&shape);
  const char* const kind = hull ? "hull" : "mesh";
  const Mesh& mesh = hull ? *hull->polytope->surface() : *std::get<MeshShape>(shape).mesh;
  if (!hull) require_closed(mesh);
  const Integrals sum = solid_in(kind, mesh);
  return {kind, sum, (sum.volume / 6.0).high * sum.unit * sum.unit * sum.unit};
}

/// Parts of one density, by the theorem of parallel axes. What cancels where parts are about each other, the sum of
/// their places, is summed up in double-doubles.
MassProperties of(const Compound& whole, double mass) {
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
    return of_integrals(solids[i].kind, solids[i].integrals, 1, mass * (solids[i].volume / volume.high));
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

MassProperties of(const BendingMesh&, double) {
  throw std::invalid_argument("shape: a mesh that bends has no mass properties of its own");
}

}  // namespace

MassProperties mass_properties(const Shape& shape, double mass) {
  require_size(mass, "mass");
  place(shape, Eigen::Quaterniond::Identity());
  return std::visit([&](const auto& each) { return of(each, mass); }, shape);
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
