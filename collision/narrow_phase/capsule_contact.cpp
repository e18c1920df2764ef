#include "collision/narrow_phase/capsule_contact.hpp"

#include "collision/degrees.hpp"
#include "collision/narrow_phase/contact_patch.hpp"
#include "collision/narrow_phase/zonotope_cells.hpp"
#include "collision/shapes/rounded_core.hpp"
#include "collision/shapes/support.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace kds::collision {
namespace {

using certificates::Generator;
using certificates::ZonotopeCell;
using Eigen::Vector3d;

/// The point of a cell nearest to x, except for parallelograms beside which x is: the nearest point is on their sides,
/// which are cells too.
bool nearest_of_cell(const ZonotopeCells& cells, const ZonotopeCell& cell, const Vector3d& x, Vector3d& nearest) {
  const Vector3d centre = cells.centre(cell);
  const auto swept = [&](std::size_t k) -> const Generator& { return cells.generators()[cell.swept[k]]; };
  nearest = centre;
  if (cell.dimension == 1) {
    const Vector3d& u = swept(0).direction;
    const double along = dot(u, x - centre) / squared_norm(u);
    nearest += std::clamp(along, -swept(0).length, swept(0).length) * u;
  } else if (cell.dimension == 2) {
    const Vector3d product = accurate_cross(swept(0).direction, swept(1).direction);
    if (!(norm(product) >= unknown_normal)) return false;
    const Vector3d normal = normalized(product);
    for (std::size_t k = 0; k < 2; ++k) {
      const Vector3d axis = cross(normal, swept(1 - k).direction);
      if (std::abs(dot(axis, x - centre)) > swept(k).length * std::abs(dot(axis, swept(k).direction))) return false;
    }
    nearest = x - dot(normal, x - centre) * normal;
  }
  return true;
}

/// Where a zonotope is the least deep at x.
struct WayOut {
  Vector3d normal = Vector3d::UnitX();
  double height = -never;  ///< of x above the zonotope along the normal
};
/// Across its faces; of a flat zonotope, with one or two generators, across its line or plane.
WayOut way_out(const ZonotopeCells& cells, const Vector3d& x) {
  WayOut out;
  const auto look = [&](const Vector3d& direction) {
    const Vector3d normal = normalized(direction) * (dot(direction, x) < 0 ? -1.0 : 1.0);
    double gap = dot(normal, x);
    for (const Generator& each : cells.generators()) gap -= each.length * std::abs(dot(normal, each.direction));
    if (gap > out.height) out = {normal, gap};
  };
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (std::size_t j = i + 1; j < cells.size(); ++j) {
      const Vector3d product = accurate_cross(cells.generators()[i].direction, cells.generators()[j].direction);
      if (norm(product) >= unknown_normal) look(product);
    }
  }
  if (out.height == -never) {  // All generators are parallel: any direction across them.
    int smallest = 0;
    const Vector3d& u = cells.generators()[0].direction;
    u.cwiseAbs().minCoeff(&smallest);
    look(cross(u, Vector3d::Unit(smallest)));
  }
  return out;
}

/// From the zonotope to x, unit. A flat one has no inside: what is below its plane by a rounding may be beside it. Only
/// where x is on the zonotope itself, up to roundings, the way out is across it.
Vector3d normal_at(const ZonotopeCells& cells, const Vector3d& x) {
  constexpr double roundings = 0x1p-46;
  const WayOut out = way_out(cells, x);
  const bool flat = cells.size() < 3;
  if (out.height < 0 && !flat) return out.normal;
  double least = never;
  Vector3d apart = Vector3d::Zero();
  cells.every_cell([&](const ZonotopeCell& cell) {
    Vector3d nearest;
    if (!nearest_of_cell(cells, cell, x, nearest)) return true;
    const double square = squared_norm(x - nearest);
    if (square < least) {
      least = square;
      apart = x - nearest;
    }
    return true;
  });
  double size = norm(x);
  for (std::size_t k = 0; k < cells.size(); ++k) size += norm(cells.half(k));
  return std::sqrt(least) > roundings * size ? normalized(apart) : out.normal;
}

}  // namespace

template <int Degree>
Contact rounded_contact(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b, double t) {
  RoundedCore core = rounded_core(a.shape);
  for (const Generator& each : rounded_core(b.shape).generators) core.generators.push_back(each);
  const Vector3d centre_a = a.motion.position(t);
  const Vector3d apart = b.motion.position(t) - centre_a;
  Contact contact;
  contact.time = t;
  contact.normal = normal_at(ZonotopeCells({core.generators.data(), core.generators.size()}), apart);
  const SupportingFeature of_a = supporting_feature(a.shape, contact.normal);
  const SupportingFeature of_b = supporting_feature(b.shape, -contact.normal);
  contact.feature_a = of_a.feature;
  contact.feature_b = of_b.feature;
  contact.point = centre_a + patch_centre(of_a.vertices, of_b.vertices, apart, contact.normal);
  return contact;
}

#define KDS_INSTANTIATE(degree) \
  template Contact rounded_contact(const TranslatingShape<degree>&, const TranslatingShape<degree>&, double);
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
