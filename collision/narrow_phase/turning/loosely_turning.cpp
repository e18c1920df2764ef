#include "collision/narrow_phase/turning/loosely_turning.hpp"

#include "collision/narrow_phase/turning/turning_mesh_sides.hpp"
#include "collision/narrow_phase/turning/turning_nodes.hpp"
#include "collision/shapes/polytope.hpp"
#include "collision/shapes/shape_forms.hpp"

#include <cstddef>
#include <variant>

namespace kds::collision {
namespace {

/// Calls ask(side) with what has the outer points of a shape, and their units; returns whether there is such a thing.
template <class Ask>
bool with_outer_points(const PlacedShape& placed, const Ask& ask) {
  const Shape& shape = placed.shape;
  if (placed.parts) return false;
  if (const auto* const mesh = std::get_if<MeshShape>(&shape)) return ask(MeshOfPair(*mesh)), true;
  if (polytope_of(shape)) {
    const MeshShape surface = surface_of(shape);
    return ask(MeshOfPair(surface, true)), true;
  }
  if (std::holds_alternative<Capsule>(shape)) return ask(CapsuleOfPair(shape)), true;
  if (const auto* const box = std::get_if<Box>(&shape)) return ask(BoxOfPair(*box)), true;
  if (const auto* const ball = std::get_if<Sphere>(&shape)) return ask(BallOfPair(*ball)), true;
  return false;
}

/// The sum of the terms of a path at t.
template <int Degree>
double sum_of_terms(const certificates::PointMotion<Degree>& path, double t) {
  double sum = 0;
  for (std::size_t k = Degree + std::size_t{1}; k-- > 0;) {
    sum = sum * (t - path.start) + path.coefficients[k].cwiseAbs().maxCoeff();
  }
  return sum;
}

}  // namespace

template <int Degree>
double apart_until(const PlacedShape& shape_a, const LooselyTurning<Degree>& a, const PlacedShape& shape_b,
                   const LooselyTurning<Degree>& b) {
  const double t = a.motion.start();
  double until = t;
  with_outer_points(shape_a, [&](const auto& of_a) {
    with_outer_points(shape_b, [&](const auto& of_b) {
      const NodeUnits units_a = of_a.units(), units_b = of_b.units();
      const PairRates not_needed{};  // since the motions start then
      const NodesView<Degree> view(a.motion, b.motion, not_needed, units_a, units_b, t, never);
      const double s = view.ahead;
      if (!view.certain || !(s > 0 && s < never)) return;
      LooseTurns loose;
      const auto charge = [&](std::size_t i, const LooselyTurning<Degree>& body, double farthest) {
        const auto in_units = [&](double x) { return static_cast<float>(x / view.size * (1 + 0x1p-20)); };
        loose.off[i] = in_units(body.off * farthest + 0x1p-46 * sum_of_terms(body.path, t + s));
        loose.rate[i] = in_units(body.rate_error * farthest * s);
        loose.bend[i] = in_units(body.bend * farthest * s * s);
      };
      charge(0, a, units_a.farthest), charge(1, b, units_b.farthest);
      const float part = separated_part(view, of_a.outer_points(), of_b.outer_points(), &loose);
      if (part > 0) until = std::max(t, next_down(t + static_cast<double>(part) * s * (1 - 0x1p-30)));
    });
  });
  return until;
}

template double apart_until(const PlacedShape&, const LooselyTurning<1>&, const PlacedShape&, const LooselyTurning<1>&);
template double apart_until(const PlacedShape&, const LooselyTurning<2>&, const PlacedShape&, const LooselyTurning<2>&);

}  // namespace kds::collision
