#include "collision/response/rotation_piece.hpp"

#include "certificates/turning/rotation.hpp"
#include "certificates/turning/turned_orientation.hpp"
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

/// What a piece has: `bulge`: how far it may be off halfway where it leads from the free rotation to the free rotation;
/// by how much it leans at both ends besides, and at its end.
struct Limits {
  double bulge, lean, lean_at_end;
};
/// Two leanings in the same direction, a turn of t rad between them, are 1 / cos(t / 4) of them halfway: up to 1 / 31
/// more.
double lean_for(double error) { return error * (1 - 0x1p-5); }
Limits while_leaning(double error) { return {error, lean_for(error), lean_for(error)}; }
Limits while_led_away(double error) { return {error, 0, lean_for(error)}; }
Limits while_led_back(double error) { return {error / 4, 0, 0}; }

/// The span in which a body that turns at a rate, with an acceleration, is off by a bulge.
double span_for(double bulge, double acceleration, double rate) {
  const double square = 8 * bulge / acceleration;
  const double turn = std::min(1.0, rate * rate * square);
  return std::sqrt(square / (1 + 0.125 * turn));
}

/// An orientation turned by up to an angle against an acceleration, which is in principal axes.
Quaterniond leaning(const Quaterniond& q, const Vector3d& acceleration, double angle) {
  const double size = norm(acceleration);
  if (!(size > 0) || angle == 0) return q;
  const Vector3d half = (-0.5 * angle / size) * acceleration;
  return product(q, {1, half[0], half[1], half[2]});
}

void check_clock(double turn, double t, double end) {
  if (end == next_up(t) && turn < end - t) {
    throw std::runtime_error(
        "World: a body that precesses turns by more than a radian between two doubles of the clock");
  }
}

/// The piece of a body that is no top, from the time of its state on.
RotationPiece expanded_piece(FreeRotation& rotation, double t, const Vector3d& velocity, const Quaterniond& from,
                             const Limits& limits) {
  constexpr double shorter = 1 - 0x1p-6;  // of a span that was too long
  const double rate = norm(velocity), turn = longest_turn / rate;
  const Vector3d at_first = rotation.acceleration(t);
  const double size = norm(at_first);
  const double span = std::min(span_for(limits.bulge + limits.lean, size, rate), turn);
  rotation.expand(span);
  double end = std::max(std::min(t + span, rotation.valid_until()), next_up(t));
  Vector3d at_last = rotation.acceleration(end);
  while (end > next_up(t)) {
    const double last = norm(at_last);
    const double greatest = std::max({size, norm(rotation.acceleration(t + (end - t) / 2)), last});
    const double cosine = std::max(0.0, dot(at_first, at_last) / (size * last));
    const double longest = span_for(limits.bulge + limits.lean * cosine, greatest, rate);
    if (end - t <= longest) break;
    end = std::max(t + shorter * std::min(longest, end - t), next_up(t));
    at_last = rotation.acceleration(end);
  }
  check_clock(turn, t, end);
  const Quaterniond ahead = rotation.orientation(end);
  const Quaterniond to = leaning(ahead, at_last, limits.lean_at_end);
  return {end, from, rate_between(from, to, end - t), to, ahead};
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

TopSpans::TopSpans(const RotationState& state, const FreeRotation& rotation, double error)
    : state_(state),
      spins_(rotation.top_spins()),
      rate_(norm(rotation.angular_velocity())),
      acceleration_(norm(rotation.acceleration(state.time))) {
  const Limits limits = while_leaning(error);
  // Halfway both ends lean by the cosine of half of the angle between them, as the body sees it: 1 - x^2 / 2 <= cos x.
  const double half_angle = 0.5 * spins_.own_rate.middle.high * longest(limits.bulge + limits.lean);
  const double cosine = std::max(0.0, 1 - half_angle * half_angle / 2);
  span_ = (1 - 0x1p-12) * longest(limits.bulge + limits.lean * cosine);
  leading_span_ = longest(while_led_back(error).bulge);
}

TopPieces::TopPieces(const TopSpans& spans, const FreeRotation& rotation, double error)
    : TopSpans(spans),
      leaning_(leaning(state_.orientation, rotation.acceleration(state_.time), while_leaning(error).lean)) {
  const double end = state_.time + span_;
  angular_velocity_ = rate_between(leaning_, spins_.carried(leaning_, end), end - state_.time);
}

double TopSpans::longest(double bulge) const {
  return std::min(span_for(bulge, acceleration_, rate_), longest_turn / rate_);
}
bool TopSpans::equal_to(double part, double t) const {
  return span_ > part * std::max(std::abs(t), std::abs(state_.time));
}
/// The bulge of the first one is that of pieces that lead away, or less.
double TopSpans::end(double number) const {
  const double first = std::min(2 * leading_span_, span_);
  return number > 0 ? state_.time + (first + (number - 1) * span_) : state_.time;
}
double TopSpans::number_at(double t) const { return std::max(0.0, 1 + std::round((t - end(1)) / span_)); }
bool TopSpans::ends_at(double t) const { return t == state_.time || (equal_near(t) && end(number_at(t)) == t); }

RotationPiece TopSpans::leading(const Quaterniond& from) const {
  const double t = state_.time, end = std::max(t + leading_span_, next_up(t));
  check_clock(longest_turn / rate_, t, end);
  const Quaterniond to = free(end);
  return {end, from, rate_between(from, to, end - t), to};
}

/// Where spans are as good as equal the angular velocity is that of the first piece, precessing, and so that it turns
/// as far in a span that is rounded otherwise.
RotationPiece TopPieces::piece(double t) const {
  constexpr double as_good_as_equal = 0x1p-16;
  const double end = this->end(t == state_.time ? 1 : number_at(t) + 1);
  check_clock(longest_turn / rate_, t, end);
  Quaterniond from = state_.orientation;
  if (t != state_.time) {
    const Quaterniond precession =
        certificates::turned_orientation(Quaterniond::Identity(), spins_.precession, spins_.precession_rate, t);
    const Quaterniond half = product(precession, leaning_).conjugate();
    from = certificates::turned_orientation(half, spins_.own, spins_.own_rate, t).conjugate();
    if (equal_to(as_good_as_equal, end)) {
      const Vector3d velocity = certificates::Rotation(precession, Spin{}, 0)(angular_velocity_);
      const double span = (state_.time + span_) - state_.time;  // the one that gave the angular velocity
      return {end, from, span / (end - t) * velocity, Quaterniond::Identity()};
    }
  }
  return {end, from, rate_between(from, spins_.carried(leaning_, end), end - t), Quaterniond::Identity()};
}

RotationPiece leading_piece(const PrincipalInertia& inertia, const RotationState& state, const Quaterniond& from,
                            double error) {
  FreeRotation rotation(inertia, state);
  const double t = state.time;
  const Vector3d velocity = rotation.angular_velocity();
  if (rotation.steady()) {
    const double turn = longest_turn / norm(velocity), end = std::max(t + turn, next_up(t));
    if (from.coeffs() == state.orientation.coeffs() || !(end < never)) return {never, from, velocity, from};
    check_clock(turn, t, end);
    const Quaterniond to = rotation.orientation(end);
    return {end, from, rate_between(from, to, end - t), to, to};
  }
  if (inertia.symmetry >= 0) return TopSpans(state, rotation, error).leading(from);
  return expanded_piece(rotation, t, velocity, from, while_led_back(error));
}

namespace {

/// Those of a top.
PiecesInARow top_pieces_until(double t, const PrincipalInertia& inertia, RotationState& state, double start,
                              const RotationPiece& before, double error, std::optional<TopPieces>& known) {
  PiecesInARow row{.last = before, .start = start, .count = 0};
  for (;; row.start = row.last.end) {
    if (!(known && known->are_of(state) && known->ends_at(row.start))) {
      known.reset();
      std::optional<TopSpans> spans;
      const auto steady_from = [&](const FreeRotation& rotation) {
        return PiecesInARow{{never, row.last.to, rotation.angular_velocity(), row.last.to}, row.start, row.count + 1};
      };
      const FreeRotation rotation(inertia, state);
      if (!rotation.steady()) spans.emplace(state, rotation, error);
      if (row.start != state.time && !(spans && spans->ends_at(row.start))) {
        // The state is that at the start from now on.
        state = {state.momentum, spans ? spans->free(row.start) : rotation.orientation(row.start), row.start};
        const FreeRotation anew(inertia, state);
        if (anew.steady()) return steady_from(anew);
        known.emplace(TopSpans(state, anew, error), anew, error);
      } else if (spans) {
        known.emplace(*spans, rotation, error);
      } else {
        return steady_from(rotation);
      }
    }
    const bool equal = known->equal_near(row.start);
    if (equal && known->equal_near(t)) {
      // The last one that starts before t, or else the first.
      const double first = known->number_at(row.start);
      double last = known->number_at(t);
      while (last > first && !(known->end(last) < t)) --last;
      if (last > first) {
        row.start = known->end(last);
        row.count += static_cast<std::size_t>(last - first);
      }
    }
    ++row.count;
    row.last = equal ? known->piece(row.start) : known->leading(row.last.to);
    if (!(row.last.end < t)) return row;
  }
}

}  // namespace

PiecesInARow pieces_until(double t, const PrincipalInertia& inertia, RotationState& state, double start,
                          const RotationPiece& before, double error, std::optional<TopPieces>& known) {
  if (inertia.symmetry >= 0) return top_pieces_until(t, inertia, state, start, before, error, known);
  PiecesInARow row{.last = before, .start = start, .count = 0};
  for (;; row.start = row.last.end) {
    ++row.count;
    state.orientation = row.last.ahead, state.time = row.start;
    FreeRotation rotation(inertia, state);
    const Vector3d velocity = rotation.angular_velocity();
    if (rotation.steady()) {
      row.last = {never, row.last.to, velocity, row.last.to, row.last.ahead};
      return row;
    }
    const bool leans = row.last.to.coeffs() != row.last.ahead.coeffs();
    row.last = expanded_piece(rotation, row.start, velocity, row.last.to,
                              leans ? while_leaning(error) : while_led_away(error));
    if (!(row.last.end < t)) return row;
  }
}

}  // namespace kds::collision
