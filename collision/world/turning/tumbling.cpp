#include "collision/world/turning/tumbling.hpp"

#include "collision/motions.hpp"
#include "collision/vectors.hpp"
#include "collision/world/bodies_image.hpp"
#include "collision/world/queue_room.hpp"
#include "collision/world/saved_motion.hpp"
#include "collision/world/turning/turning_extents.hpp"
#include "kds/audit.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace kds::collision {

using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

Quaterniond of_axes(const PrincipalInertia& inertia, const Quaterniond& of_body) {
  return product(of_body, inertia.axes);
}
Quaterniond of_body(const PrincipalInertia& inertia, const Quaterniond& of_axes) {
  return product(of_axes, inertia.axes.conjugate());
}

Quaterniond unit(const Quaterniond& q) {
  const double length = norm(q);
  return {q.w() / length, q.x() / length, q.y() / length, q.z() / length};
}

}  // namespace

template <class Motion>
void Tumbling<Motion>::add(BodySlot slot, const PrincipalInertia& inertia) {
  make_room(ends_, slot + std::size_t{1});
  if (of_.size() <= slot) of_.resize(slot + std::size_t{1});
  of_[slot] = Body{.inertia = inertia};
}

template <class Motion>
void Tumbling<Motion>::remove(BodySlot slot) {
  if (!has(slot)) return;
  if (is_alone(slot)) --alone_;
  of_[slot].reset();
  ends_.clear(slot);
}

template <class Motion>
void Tumbling<Motion>::scale(BodySlot slot, double factor) {
  of_[slot]->inertia.moments *= factor;
  of_[slot]->state.momentum *= factor;
  of_[slot]->pieces.reset();
}

template <class Motion>
void Tumbling<Motion>::begin(BodySlot slot, const RotationPiece& piece) {
  of_[slot]->to = piece.to, of_[slot]->ahead = piece.ahead;
  of_[slot]->astray = false;
  set_end(slot, piece.end);
}

template <class Motion>
void Tumbling<Motion>::set_end(BodySlot slot, double end) {
  of_[slot]->ends = bodies_[slot].turns_until = end;
  ends_.set(slot, end);
}

template <class Motion>
Motion Tumbling<Motion>::motion_of(const Body& body, const Quaterniond& orientation, const RotationPiece& piece,
                                   double t) const {
  Motion motion;
  motion.path = body.path.start == t ? body.path : body.path.restarted(t);
  motion.orientation = orientation;
  motion.angular_velocity = piece.angular_velocity;
  return motion;
}

template <class Motion>
Motion Tumbling<Motion>::take_up(BodySlot slot, const Motion& given, double t) {
  Body& body = *of_[slot];
  body.path = given.path;
  const bool goes_on = body.ends > t && given.angular_velocity == bodies_.motion(slot).angular_velocity;
  if (bodies_[slot].entered && goes_on && !bodies_.is_jump(slot, given, t)) return given.restarted(t);
  const Quaterniond orientation = unit(given.restarted(t).orientation);
  body.state.orientation = of_axes(body.inertia, orientation);
  body.state.momentum = angular_momentum(body.inertia, body.state.orientation, given.angular_velocity);
  body.state.time = t;
  const RotationPiece piece = leading_piece(body.inertia, body.state, body.state.orientation, error_);
  begin(slot, piece);
  return motion_of(body, orientation, piece, t);
}

/// A path that is restarted is off by less than 2^-49 of the sum of its terms' magnitudes; so is the one with which it
/// is compared.
template <class Motion>
bool Tumbling<Motion>::can_leave_alone(BodySlot slot, double t) const {
  const Body& body = *of_[slot];
  if (body.astray || !(t < never)) return false;
  double farthest = 0;
  for (std::size_t k = Motion::degree + std::size_t{1}; k-- > 0;) {
    farthest = farthest * (t - body.path.start) + body.path.coefficients[k].cwiseAbs().maxCoeff();
  }
  return 0x1p-48 * farthest <= path_rounding * bodies_[slot].bounding_radius;
}

/// The motion is off the free rotation by up to twice the option, now and then: G is that free rotation, turned by a
/// small rotation D so that it begins where the motion is. For D the angular momentum is off, and so the angular
/// velocity that is calculated from it. The greatest magnitude of the latter follows from the energy, but is constant
/// for symmetric tops. Euler's equations in principal axes, w_i' = (I_j - I_k) / I_i w_j w_k, have |w'| <= K |w|^2 /
/// sqrt(3), where K is the greatest of these factors.
template <class Motion>
LooselyTurning<Motion::degree> Tumbling<Motion>::loosely_turning(BodySlot slot, double t) const {
  const Motion& moves = bodies_.motion(slot);
  LooselyTurning<Motion::degree> loose{moves.restarted(t), moves.path};
  Vector3d& rate = loose.motion.angular_velocity;
  if (!has(slot) || of_[slot]->ends == never) {
    loose.off = 0x1p-40;  // for roundings of the restart
    loose.bend = dot(rate, rate) * (1 + 0x1p-40);
    return loose;
  }
  constexpr double farthest = 2.0 + 0x1p-9;  // of the option, and some for the sum of small rotations
  const Body& body = *of_[slot];
  const Vector3d& moments = body.inertia.moments;
  const double least = moments.minCoeff(), momentum = norm(body.state.momentum), off = farthest * error_ + 0x1p-40;
  loose.path = body.path;
  loose.off = 2 * off;
  loose.rate_error = off * momentum / least;
  rate = collision::angular_velocity(body.inertia,
                                     {body.state.momentum, of_axes(body.inertia, unit(loose.motion.orientation)), t});
  double most = norm(rate) + loose.rate_error;
  if (body.inertia.symmetry < 0) {
    const double root_of_energy = std::sqrt(std::max(0.0, dot(body.state.momentum, rate)));
    most = (root_of_energy + off * momentum / std::sqrt(least)) / std::sqrt(least);
  }
  double factor = 0;
  for (int i = 0; i < 3; ++i) {
    factor = std::max(factor, std::abs(moments[(i + 1) % 3] - moments[(i + 2) % 3]) / moments[i]);
  }
  loose.bend = most * most * (1 + 0.578 * factor) * (1 + 0x1p-20);
  return loose;
}

template <class Motion>
void Tumbling<Motion>::leave_alone(BodySlot slot, double t) {
  ++alone_;
  ends_.set(slot, t);
  bodies_[slot].turns_until = -never;  // Pairs are not tested by its present piece.
}

template <class Motion>
bool Tumbling<Motion>::goes_on_alone(BodySlot slot, double t) {
  if (!(t > of_[slot]->ends)) return false;
  if (t < ends_.time(slot)) ends_.set(slot, t);
  return true;
}

template <class Motion>
Motion Tumbling<Motion>::catch_up(BodySlot slot, double t) {
  --alone_;
  Body& body = *of_[slot];
  if (!(body.ends < t)) return set_end(slot, body.ends), bodies_.motion(slot);
  return next_pieces(slot, t);
}

template <class Motion>
Motion Tumbling<Motion>::catch_up_alone(BodySlot slot, double t) {
  if (!(of_[slot]->ends < t)) return bodies_.motion(slot);
  const double until = ends_.time(slot);
  const Motion motion = catch_up(slot, t);
  // Where its piece ends just then, too, it is looked at an instant earlier: who is alone is seen from the two times.
  leave_alone(slot, until == of_[slot]->ends ? next_down(until) : until);
  return motion;
}

/// The last of the pieces after the present one that starts before t.
template <class Motion>
Motion Tumbling<Motion>::next_pieces(BodySlot slot, double t) {
  Body& body = *of_[slot];
  const RotationPiece present{.to = body.to, .ahead = body.ahead};
  const PiecesInARow row = pieces_until(t, body.inertia, body.state, body.ends, present, error_, body.pieces);
  counters_.rotation_pieces += row.count, counters_.motion_updates += row.count;
  begin(slot, row.last);
  return motion_of(body, of_body(body.inertia, row.last.from), row.last, row.start);
}

template <class Motion>
typename Tumbling<Motion>::Piece Tumbling<Motion>::take_next() {
  const double t = next_time();
  const BodySlot slot = next_body();
  Body& body = *of_[slot];
  if (is_alone(slot)) {
    const Motion motion = catch_up(slot, t);
    if (body.ends > t) return {slot, motion};
  }
  if (!body.astray) return {slot, next_pieces(slot, next_up(t))};
  ++counters_.rotation_pieces, ++counters_.motion_updates;
  const Quaterniond orientation = bodies_.motion(slot).restarted(t).orientation;
  reach(body, t);
  const RotationPiece piece = way_back(slot, orientation);
  begin(slot, piece);
  return {slot, motion_of(body, orientation, piece, t)};
}

/// Its free rotation is at t from now on.
template <class Motion>
void Tumbling<Motion>::reach(Body& body, double t) {
  if (!(t > body.state.time)) return;
  body.state.orientation = orientation_at(body.inertia, body.state, t);
  body.state.time = t;
}

template <class Motion>
void Tumbling<Motion>::meet(BodySlot slot, const Quaterniond& as_it_moves, double t) {
  constexpr double farthest = 1.75;  // of the option: a piece that leads back in part adds a quarter
  Body& body = *of_[slot];
  reach(body, t);
  const Quaterniond orientation = of_axes(body.inertia, as_it_moves);
  if (!(angle_between(body.state.orientation, orientation) > farthest * error_)) return;
  body.state.orientation = unit(orientation);
  ++counters_.orientation_resets;
}

template <class Motion>
Vector3d Tumbling<Motion>::angular_velocity(BodySlot slot) const {
  return collision::angular_velocity(of_[slot]->inertia, of_[slot]->state);
}

template <class Motion>
Eigen::Matrix3d Tumbling<Motion>::inverse_inertia(BodySlot slot) const {
  return collision::inverse_inertia(of_[slot]->inertia, of_[slot]->state.orientation);
}

template <class Motion>
RotationPiece Tumbling<Motion>::way_back(BodySlot slot, const Quaterniond& as_it_moves) const {
  const Body& body = *of_[slot];
  return leading_piece(body.inertia, body.state, of_axes(body.inertia, as_it_moves), error_);
}

/// A piece that does not lead back at all is off by a h^2 / 2 more at its end, four times the bulge; a piece half as
/// long by a quarter of the option.
template <class Motion>
void Tumbling<Motion>::follow(BodySlot slot, const RotationPiece& piece, bool whole, double t) {
  begin(slot, piece);
  if (whole || piece.end == never) return;
  Body& body = *of_[slot];
  body.astray = true;
  set_end(slot, std::max(t + (piece.end - t) / 2, next_up(t)));
}

template <class Motion>
FreeTurning Tumbling<Motion>::turning(BodySlot slot, double t) const {
  const Body& body = *of_[slot];
  const RotationState then{body.state.momentum, orientation_at(body.inertia, body.state, t), t};
  return {of_body(body.inertia, then.orientation), collision::angular_velocity(body.inertia, then), then.momentum};
}

template <class Motion>
void Tumbling<Motion>::audit(double t) const {
  constexpr double farthest = 2.0 + 0x1p-10;  // of the option, and some for the sum of small rotations
  for (BodySlot slot = 0; slot < of_.size(); ++slot) {
    if (!of_[slot] || !bodies_.entered(slot)) continue;
    const auto need = [&](bool right, const char* what) {
      if (!right) throw AuditFailure("World: body " + std::to_string(bodies_.id_of(slot)) + ": " + what);
    };
    const Body& body = *of_[slot];
    need(body.ends >= t, "its piece of rotation is over");
    need(ends_.time(slot) >= t, "it should have been looked at");
    const Quaterniond moves = bodies_.motion(slot).restarted(t).orientation;
    need(angle_between(moves, turning(slot, t).orientation) <= farthest * error_, "it is off its free rotation");
  }
}

template <class Motion>
void Tumbling<Motion>::Image::check(const typename Bodies<Motion>::Image& bodies, double now,
                                    const WorldOptions&) const {
  for (BodySlot slot = 0; slot < bodies.bodies.size(); ++slot) {
    image::require(!bodies.alive(slot) || bodies.bodies[slot].tumbles == (slot < of.size() && of[slot]), "tumbling",
                   slot, "is of no body, or missing");
  }
  for (BodySlot slot = 0; slot < of.size(); ++slot) {
    if (!of[slot]) continue;
    const Body& body = *of[slot];
    const auto need = [slot](bool right, const char* what) { image::require(right, "tumbling", slot, what); };
    const auto is_rotation = [](const Quaterniond& q) {
      const double length = norm(q);
      return length > 0.5 && length < 2;
    };
    need(bodies.alive(slot), "is of no body");
    const PrincipalInertia& inertia = body.inertia;
    for (const double moment : inertia.moments) {
      need(image::is_moment(moment), "its moments are not > 0, or out of range");
    }
    need(inertia.symmetry >= -1 && inertia.symmetry < 3, "has no such axis");
    need(is_rotation(inertia.axes) && is_rotation(body.state.orientation) && is_rotation(body.ahead) &&
             is_rotation(body.to),
         "a quaternion is not of length 1");
    need(body.state.momentum.allFinite(), "its angular momentum is not finite");
    need(image::can_have_come_about(collision::angular_velocity(inertia, body.state)),
         "its free angular velocity is beyond 2^450");
    need(image::can_have_come_about(body.path), "its path is not finite, or out of range");
    need(std::isfinite(body.state.time) && body.state.time <= now && image::is_to_come(body.ends, now),
         "its piece is over, or to begin");
  }
}

template <class Motion>
void Tumbling<Motion>::take_in(BodySlot slot, const Tumbling& from, BodySlot of) {
  if (!from.has(of)) return;
  add(slot, from.of_[of]->inertia);
  of_[slot] = from.of_[of];
  set_end(slot, of_[slot]->ends);
}

template <class Motion>
void Tumbling<Motion>::go_on_from(BodySlot slot, const Progress& progress) {
  if (!progress.body()) return;
  of_[slot] = *progress.body();
  bodies_[slot].turns_until = of_[slot]->ends;
}

template <class Motion>
void Tumbling<Motion>::go_on() {
  become(image());
}

template <class Motion>
void Tumbling<Motion>::become(const Image& image) {
  of_ = image.of;
  alone_ = 0;
  ends_.resize(0);
  ends_.resize(of_.size());
  for (BodySlot slot = 0; slot < of_.size(); ++slot) {
    if (of_[slot]) set_end(slot, of_[slot]->ends);
  }
}

#define KDS_INSTANTIATE(motion) template class Tumbling<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
