#include "collision/response/turning_impulse.hpp"

#include "collision/precise_vector.hpp"
#include "collision/response/impulse.hpp"
#include "collision/vectors.hpp"
#include "kds/arithmetic/square_root.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// A vector in the plane of contact.
struct PlaneVector {
  DoubleDouble x, y;
};
PlaneVector operator+(const PlaneVector& v, const PlaneVector& w) { return {v.x + w.x, v.y + w.y}; }
PlaneVector operator-(const PlaneVector& v, const PlaneVector& w) { return {v.x - w.x, v.y - w.y}; }
PlaneVector operator*(const PlaneVector& v, const DoubleDouble& factor) { return {v.x * factor, v.y * factor}; }
DoubleDouble product(const PlaneVector& v, const PlaneVector& w) { return v.x * w.x + v.y * w.y; }

/// Scaled, so that the length of a slip of the size of rounding errors does not underflow; hypot differs between C
/// libraries.
double length(const PlaneVector& v) {
  const double greatest = std::max(std::abs(v.x.high), std::abs(v.y.high));
  if (greatest == 0) return 0;
  const double x = v.x.high / greatest, y = v.y.high / greatest;
  return greatest * std::sqrt(x * x + y * y);
}

PreciseVector turned_by(const Mobility& body, const PreciseVector& angular_impulse) {
  return body.spherical ? angular_impulse * body.inverse_moment : body.inverse_inertia * angular_impulse;
}

/// Normalised to 2^-100.
PreciseVector precise_unit(const Vector3d& normal) {
  return PreciseVector(normal) * (DoubleDouble(1.0) - 0.5 * excess_of_unit(normal));
}

PreciseVector contact_velocity(const RigidVelocity& body, const Vector3d& arm) {
  return PreciseVector(body.velocity) + precise_cross(body.angular_velocity, arm);
}

/// One body of a pair, and what impulses along up to three directions do to it.
class Partner {
 public:
  Partner(const Mobility& mobility, const Vector3d& arm) : mobility_(mobility), arm_(arm), turns_(mobility.turns()) {}

  void set_direction(std::size_t i, const PreciseVector& direction) {
    if (!turns_) return;
    levers_[i] = cross(arm_, direction);
    turns_by_[i] = turned_by(mobility_, levers_[i]);
  }

  /// The change of the velocity of the point of contact along d_i when an impulse along d_j turns the body.
  DoubleDouble by_turning(std::size_t i, std::size_t j) const {
    return turns_ ? dot(levers_[i], turns_by_[j]) : DoubleDouble(0.0);
  }

  /// `impulse` is the sum of `parts` along the directions, of which there are `count`.
  void give(RigidVelocity& body, const PreciseVector& impulse, const std::array<DoubleDouble, 3>& parts,
            std::size_t count) const {
    if (mobility_.inverse_mass != 0) {
      body.velocity = (PreciseVector(body.velocity) + impulse * mobility_.inverse_mass).rounded();
    }
    if (!turns_) return;
    PreciseVector angular_velocity(body.angular_velocity);
    for (std::size_t i = 0; i < count; ++i) angular_velocity += turns_by_[i] * parts[i];
    body.angular_velocity = angular_velocity.rounded();
  }

 private:
  const Mobility& mobility_;
  const Vector3d& arm_;
  bool turns_;
  std::array<PreciseVector, 3> levers_, turns_by_;
};

/// A pair in contact. Directions: unit vectors d_0 = n, and d_1, d_2 in the plane of contact where that is asked for.
class Pair {
 public:
  Pair(const Mobility& of_a, const Mobility& of_b, const ContactArms& arms)
      : a_(of_a, arms.a),
        b_(of_b, arms.b),
        normal_(arms.normal),
        masses_(two_sum(of_a.inverse_mass, of_b.inverse_mass)) {
    set_direction(precise_unit(arms.normal));
  }

  /// d_1 is perpendicular to n and to the axis along which n is least, so that neither cross product is short.
  void set_tangents() {
    Eigen::Index axis = 0;
    for (Eigen::Index d = 1; d < 3; ++d) {
      if (std::abs(normal_[d]) < std::abs(normal_[axis])) axis = d;
    }
    const PreciseVector across = cross(Vector3d(Vector3d::Unit(axis)), directions_[0]);
    set_direction(across * (DoubleDouble(1.0) / kds::detail::rounded_root(dot(across, across))));
    set_direction(cross(directions_[0], directions_[1]));
  }

  const PreciseVector& direction(std::size_t i) const { return directions_[i]; }

  /// K_ij: the change of the relative velocity along d_i by an impulse along d_j.
  DoubleDouble coupling(std::size_t i, std::size_t j) const {
    const DoubleDouble turning = a_.by_turning(i, j) + b_.by_turning(i, j);
    return i == j ? masses_ + turning : turning;
  }

  /// An impulse on b with these parts along the directions, and the opposite on a. Returns it, rounded.
  Vector3d give(RigidVelocity& a, RigidVelocity& b, const std::array<DoubleDouble, 3>& parts) const {
    PreciseVector impulse = directions_[0] * parts[0];
    for (std::size_t i = 1; i < count_; ++i) impulse += directions_[i] * parts[i];
    a_.give(a, impulse * -1.0, {-parts[0], -parts[1], -parts[2]}, count_);
    b_.give(b, impulse, parts, count_);
    return impulse.rounded();
  }

 private:
  void set_direction(const PreciseVector& direction) {
    a_.set_direction(count_, direction);
    b_.set_direction(count_, direction);
    directions_[count_++] = direction;
  }

  Partner a_, b_;
  const Vector3d& normal_;
  DoubleDouble masses_;
  std::array<PreciseVector, 3> directions_;
  std::size_t count_ = 0;
};

/// The tangential part of an impulse: law 3 to 5. `push` is j0, `tilt` K_nt / K_nn, h the slip, S by its three entries.
class Friction {
 public:
  Friction(const Pair& pair, const DoubleDouble& resistance, const DoubleDouble& push, const PlaneVector& slip,
           const DoubleDouble& approach, const Surfaces& surfaces)
      : push_(push), surfaces_(surfaces), factor_(two_sum(1, surfaces.tangential_restitution)) {
    const PlaneVector coupled{pair.coupling(0, 1), pair.coupling(0, 2)};
    tilt_ = {coupled.x / resistance, coupled.y / resistance};
    xx_ = pair.coupling(1, 1) - coupled.x * tilt_.x;
    xy_ = pair.coupling(1, 2) - coupled.x * tilt_.y;
    yy_ = pair.coupling(2, 2) - coupled.y * tilt_.y;
    slip_ = slip - tilt_ * approach;
  }

  struct Result {
    PlaneVector along;    // s
    DoubleDouble normal;  // j
    bool slides;
  };

  Result solve() const {
    if (slip_.x.high == 0 && slip_.y.high == 0) return {{}, push_, false};
    const DoubleDouble determinant = xx_ * yy_ - xy_ * xy_;
    const PlaneVector sticking =
        PlaneVector{xy_ * slip_.y - yy_ * slip_.x, xy_ * slip_.x - xx_ * slip_.y} * (factor_ / determinant);
    if (in_cone(sticking)) return {sticking, normal(sticking), false};
    const PlaneVector along = sliding(sticking);
    return {along, normal(along), true};
  }

 private:
  DoubleDouble normal(const PlaneVector& along) const { return push_ - product(tilt_, along); }
  bool in_cone(const PlaneVector& along) const { return length(along) <= surfaces_.friction * normal(along).high; }

  /// The last point inside the cone on the path that starts from zero along -h and, where the slip along h has become
  /// -e_t of itself, goes straight on to `sticking`, which is outside.
  PlaneVector sliding(const PlaneVector& sticking) const {
    const double size = length(slip_);
    const double x = slip_.x.high / size, y = slip_.y.high / size;
    const double stiffness = xx_.high * x * x + 2 * xy_.high * x * y + yy_.high * y * y;
    const double far = factor_.high * size / stiffness;
    const PlaneVector turned{-far * x, -far * y};
    if (!in_cone(turned)) {
      // |s| = mu j: positive, since law 3 cannot hold at `turned` either.
      const double mu = surfaces_.friction;
      const double part = mu * push_.high / (1 - mu * (tilt_.x.high * x + tilt_.y.high * y));
      return {-part * x, -part * y};
    }
    // The cone is convex: the path crosses its surface once. Bisection is enough, since sliding need not be exact.
    const PlaneVector rest = sticking - turned;
    double inside = 0, outside = 1;
    for (int i = 0; i < 53; ++i) {
      const double middle = (inside + outside) / 2;
      (in_cone(turned + rest * middle) ? inside : outside) = middle;
    }
    return turned + rest * inside;
  }

  DoubleDouble push_;
  const Surfaces& surfaces_;
  DoubleDouble factor_;  // 1 + e_t
  PlaneVector tilt_, slip_;
  DoubleDouble xx_, xy_, yy_;
};

/// Whether neither the impulse along the normal turns the body, nor its turning moves the contact along the normal.
bool passes_centre(const RigidVelocity& body, const Mobility& mobility, const Vector3d& arm, const Vector3d& normal) {
  return (!mobility.turns() && body.angular_velocity.isZero(0)) || collision::cross(arm, normal).isZero(0);
}

TurningImpulse collide_centrally(RigidVelocity& a, RigidVelocity& b, const Mobility& of_a, const Mobility& of_b,
                                 const Vector3d& normal, double restitution) {
  const double approach = -collision::dot(normal, b.velocity - a.velocity);
  if (!(approach > 0)) return {};
  const double change = (1 + restitution) * approach;
  change_relative_velocity(a.velocity, b.velocity, normal, change, of_a.inverse_mass, of_b.inverse_mass);
  return {change / (of_a.inverse_mass + of_b.inverse_mass) * normal, false};
}

}  // namespace

TurningImpulse collide(RigidVelocity& a, RigidVelocity& b, const Mobility& of_a, const Mobility& of_b,
                       const ContactArms& arms, const Surfaces& surfaces) {
  if (of_a.inverse_mass == 0 && of_b.inverse_mass == 0) return {};
  const bool smooth = surfaces.smooth();
  if (smooth && passes_centre(a, of_a, arms.a, arms.normal) && passes_centre(b, of_b, arms.b, arms.normal)) {
    return collide_centrally(a, b, of_a, of_b, arms.normal, surfaces.restitution);
  }
  Pair pair(of_a, of_b, arms);
  const PreciseVector apart = contact_velocity(b, arms.b) - contact_velocity(a, arms.a);
  const DoubleDouble approach = dot(pair.direction(0), apart);
  if (!(approach.high < 0)) return {};
  const DoubleDouble resistance = pair.coupling(0, 0);
  const DoubleDouble push = -(two_sum(1, surfaces.restitution) * approach) / resistance;
  if (smooth) return {pair.give(a, b, {push, {}, {}}), false};
  pair.set_tangents();
  const PlaneVector slip{dot(pair.direction(1), apart), dot(pair.direction(2), apart)};
  const auto [along, normal, slides] = Friction(pair, resistance, push, slip, approach, surfaces).solve();
  return {pair.give(a, b, {normal, along.x, along.y}), slides};
}

Vector3d Mobility::turned_by(const Vector3d& push) const {
  if (spherical) return inverse_moment * push;
  const auto row = [&](int i) {
    return inverse_inertia(i, 0) * push[0] + inverse_inertia(i, 1) * push[1] + inverse_inertia(i, 2) * push[2];
  };
  return {row(0), row(1), row(2)};
}

Vector3d brake_turning(RigidVelocity& a, RigidVelocity& b, const Mobility& of_a, const Mobility& of_b,
                       const ContactArms& arms, double most) {
  const Vector3d relative = b.angular_velocity - a.angular_velocity;
  const double rate = certificates::norm(relative);
  if (!(rate > 0 && most > 0)) return Vector3d::Zero();
  const Vector3d axis = relative / rate;
  const Vector3d turns_a = of_a.turned_by(axis), turns_b = of_b.turned_by(axis);
  const double turns = collision::dot(axis, turns_a + turns_b);
  if (!(turns > 0)) return Vector3d::Zero();
  const double couple = std::min(most, rate / turns);
  const Vector3d left_a = a.angular_velocity + couple * turns_a;
  const Vector3d left_b = b.angular_velocity - couple * turns_b;
  const Vector3d apart = (b.velocity + cross(left_b, arms.b)) - (a.velocity + cross(left_a, arms.a));
  if (!(collision::dot(arms.normal, apart) < 0)) return Vector3d::Zero();
  a.angular_velocity = left_a, b.angular_velocity = left_b;
  return -couple * axis;
}

double push_for(double change, const Mobility& of_a, const Mobility& of_b, const ContactArms& arms) {
  const auto yields = [&](const Mobility& body, const Vector3d& arm) {
    const Vector3d torque = cross(arm, arms.normal);
    return body.inverse_mass + collision::dot(torque, body.turned_by(torque));
  };
  return change / (yields(of_a, arms.a) + yields(of_b, arms.b));
}

}  // namespace kds::collision
