#include "collision/response/rotation_piece.hpp"

#include "collision/vectors.hpp"
#include "kds/arithmetic/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace kds::collision {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// The angle of which x >= 0 is the tangent: Gregory's series, after the angle has been halved twice. Each halving
/// takes x to x / (1 + sqrt(1 + x^2)); from at most infinity, which counts as a right angle, to tan(pi / 8) < 0.415.
/// 0.415^(2 n + 1) is below 2^-56 for n = 22.
double arc_tangent(double x) {
  constexpr int terms = 22;
  const double half = x > 0x1p60 ? 1 : x / (1 + std::sqrt(1 + x * x));
  const double quarter = half / (1 + std::sqrt(1 + half * half));
  const double square = quarter * quarter;
  double sum = 0;
  for (int n = terms; n >= 0; --n) sum = 1.0 / (2 * n + 1) - square * sum;
  return 4 * quarter * sum;
}

/// a b^-1, but for its length.
Quaterniond turn_between(const Quaterniond& from, const Quaterniond& to) { return product(to, from.conjugate()); }

/// When the piece ends that begins at t, where the free rotation is at its state's time and turns by longest_turn in
/// `turn` s. Expands it as far.
double end_of_piece(const PrincipalInertia& inertia, FreeRotation& rotation, double t, double turn, double bulge) {
  constexpr double spared = 1.125;
  constexpr double shorter = 0.875;  // of a span that was too long
  const bool top = inertia.symmetry >= 0;
  const auto span_for = [&](double acceleration) { return std::sqrt(8 * bulge / (spared * acceleration)); };
  const double span = std::min(span_for(rotation.acceleration(t)), turn);
  if (!top) rotation.expand(span);
  double end = std::max(std::min(t + span, rotation.valid_until()), next_up(t));
  while (!top && end > next_up(t)) {  // The acceleration of a top does not grow.
    const double greatest = std::max(rotation.acceleration(t + (end - t) / 2), rotation.acceleration(end));
    if (end - t <= span_for(greatest)) break;
    end = std::max(t + shorter * (end - t), next_up(t));
  }
  if (end == next_up(t) && turn < end - t) {
    throw std::runtime_error(
        "World: a body that precesses turns by more than a radian between two doubles of the clock");
  }
  return end;
}

}  // namespace

Vector3d rate_between(const Quaterniond& from, const Quaterniond& to, double span) {
  const Quaterniond turn = turn_between(from, to);
  const Vector3d v(turn.x(), turn.y(), turn.z());
  const double sine = norm(v);
  if (sine == 0) return Vector3d::Zero();
  const double factor = 2 * arc_tangent(sine / std::abs(turn.w())) / (sine * span);
  return (turn.w() < 0 ? -factor : factor) * v;
}

double angle_between(const Quaterniond& a, const Quaterniond& b) {
  const Quaterniond turn = turn_between(a, b);
  return 2 * arc_tangent(norm(Vector3d(turn.x(), turn.y(), turn.z())) / std::abs(turn.w()));
}

RotationPiece rotation_piece(const PrincipalInertia& inertia, const RotationState& state, double t,
                             const Quaterniond& free, const Quaterniond& from, double bulge) {
  const RotationState here{state.momentum, free, t};
  FreeRotation rotation(inertia, here);
  const Vector3d velocity = rotation.angular_velocity();
  const bool on_it = from.coeffs() == here.orientation.coeffs();
  const double turn = longest_turn / norm(velocity);
  if (rotation.steady() && (on_it || !(t + turn < never))) return {never, here.orientation, velocity};
  const double end = end_of_piece(inertia, rotation, t, turn, bulge);
  const Quaterniond ahead = state.time == t ? rotation.orientation(end) : orientation_at(inertia, state, end);
  return {end, ahead, rate_between(from, ahead, end - t)};
}

PiecesInARow pieces_until(double t, const PrincipalInertia& inertia, RotationState& state, double start,
                          const Quaterniond& from, double bulge) {
  PiecesInARow row{.start = start, .from = from};
  std::optional<FreeRotation> of_top;
  if (inertia.symmetry >= 0) of_top.emplace(inertia, state), of_top->expand(t - start);
  for (;;) {
    ++row.count;
    const RotationState here{state.momentum, row.from, row.start};
    FreeRotation rotation(inertia, here);
    const Vector3d velocity = rotation.angular_velocity();
    if (inertia.symmetry < 0) state = here;
    if (rotation.steady()) {
      row.last = {never, row.from, velocity};
      return row;
    }
    const double end = end_of_piece(inertia, rotation, row.start, longest_turn / norm(velocity), bulge);
    const Quaterniond ahead = of_top ? of_top->orientation(end) : rotation.orientation(end);
    if (!(end < t)) {
      row.last = {end, ahead, rate_between(row.from, ahead, end - row.start)};
      return row;
    }
    row.start = end, row.from = ahead;
  }
}

}  // namespace kds::collision
