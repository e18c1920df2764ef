// Impulses between two bodies that may turn: restitution, friction, and rough surfaces.
#pragma once

#include <Eigen/Core>

namespace kds::collision {

/// How a rigid body moves at an instant.
struct RigidVelocity {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< of the centre of mass, length / s
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< rad / s, in the axes of the world
};

/// How much an impulse changes the motion of a body: not at all, if it is fixed or driven.
struct Mobility {
  double inverse_mass = 0;
  double inverse_moment = 0;  ///< of a body whose moments are equal; 1 / (mass * length^2)
  /// For other bodies: in the axes of the world, symmetric.
  Eigen::Matrix3d inverse_inertia = Eigen::Matrix3d::Zero();
  bool spherical = true;  ///< whether inverse_inertia is left out

  static Mobility fixed() { return {}; }
  /// The mobility of a body whose moments are equal (is_spherical()).
  static Mobility of_spherical(double inverse_mass, double inverse_moment) { return {inverse_mass, inverse_moment}; }
  /// The mobility of any body: turned_tensor(inverse_inertia(inertia), rotation).
  static Mobility of(double inverse_mass, const Eigen::Matrix3d& inverse_inertia) {
    return {inverse_mass, 0, inverse_inertia, false};
  }

  /// The change of the angular velocity by an angular impulse.
  Eigen::Vector3d turned_by(const Eigen::Vector3d& push) const;
  /// Whether an impulse turns it.
  bool turns() const { return spherical ? inverse_moment != 0 : !inverse_inertia.isZero(0); }
};

/// Where two bodies touch. The arms lead from either's centre of mass to the point of contact. They should end at one
/// point: their distance there, times the impulse, is an error of the angular momentum.
struct ContactArms {
  Eigen::Vector3d normal;  ///< from a to b, of length 1 up to rounding
  Eigen::Vector3d a, b;    ///< units of length
};

/// The properties of the surfaces.
struct Surfaces {
  double restitution = 1;             ///< e, in [0, 1]: the speed of parting over that of approach
  double friction = 0;                ///< mu >= 0: the tangential impulse over the normal one, at most
  double tangential_restitution = 0;  ///< e_t, in [-1, 1]: -1 smooth, 0 the bodies stick, 1 perfectly rough

  bool smooth() const { return friction == 0 || tangential_restitution == -1; }
};

/// What two bodies that may turn do to each other in a contact.
struct TurningImpulse {
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();  ///< on b, and the opposite on a; mass * length / s, rounded
  bool slides = false;                                ///< whether friction was too little for e_t
};

/// Changes the motions of two bodies that touch and approach each other at the point of contact; changes nothing if
/// they do not approach, or if both are fixed. Pass a zero arm for a body whose turning shall not count.
///
/// **The law.** Let g be the velocity of b's point of contact seen from a's, n the normal, and K the matrix by which an
/// impulse changes g: K = (1 / m_a + 1 / m_b) 1 - [r_a] I_a^-1 [r_a] - [r_b] I_b^-1 [r_b], with [r] x = r x x.
///
/// 1. Normal velocity: n . g' = -e n . g.
/// 2. Without friction (mu = 0 or e_t = -1) the impulse is -(1 + e) (n . g) / K_nn along n.
/// 3. With friction there is a tangential part s besides, and the normal part is chosen such that law 1 holds: j = j0 -
///    K_nt s / K_nn, where j0 is that of law 2. Always |s| <= mu j (Coulomb's cone), up to roundings of the impulse.
/// 4. Let h = g_t - K_tn g_n / K_nn: the slip at the end of compression if there is no friction until then; for balls
///    it is the slip at the beginning. Where the cone allows, s changes h into -e_t h. For balls this is the rough
///    sphere of [Walton86].
/// 5. Where the cone does not allow it, s is smaller. As long as it is too small to reverse the slip it is along -h
///    (Coulomb's sliding); from there to the s of law 4, for bodies whose S = K_tt - K_tn K_nt / K_nn is not the same
///    in all directions, it follows a straight line: the path of [Powell70].
///
/// Energy: s changes it by h . s + s . S s / 2, and law 2 by -(1 - e^2) (n . g)^2 / (2 K_nn). With p the point of the
/// path, s = (1 + e_t) p, and p . (h + S p) <= 0 all along that path, so the first is at most -(1 - e_t^2) / 2 times p
/// . S p: never positive, and zero for e_t = 1 where nothing slides. So energy never grows, however eccentric the
/// bodies are; the laws of Newton and Coulomb, applied to the velocities before and after, would let it grow
/// [Stronge90]. The component of the slip along h ends at no less than -e_t times h.
///
/// **Roundings.** All is calculated in double-doubles (some 2^-95), except how far s goes where it slides, which law 3
/// does not need; the new velocities are rounded once, to the nearest double. So with u = 2^-53 each coordinate of a
/// velocity is off by u of itself at most, law 1 holds up to what that makes of g, momentum, angular momentum and
/// energy change by no more than that, and none of them is biased: roundings to nearest are as often up as down.
/// Numbers that are the same at every contact, as the quotient of two masses or the length of the normal (see
/// impulse.hpp), are not rounded. Masses are defined by their inverses, exactly.
///
/// Where neither turning nor friction matters, the velocities change as by change_relative_velocity(), bit for bit:
/// worlds give the same events whether or not they know of turning. That is where each arm is along the normal, with a
/// cross product that is zero in doubles, or its body neither turns nor can be turned.
///
/// Preconditions: numbers are finite, sizes and masses in the range of shape.hpp; a body of inverse mass 0 has inverse
/// inertia 0. Cost: some 1.5 us; with friction 3 us.
TurningImpulse collide(RigidVelocity& a, RigidVelocity& b, const Mobility& of_a, const Mobility& of_b,
                       const ContactArms& arms, const Surfaces& surfaces);

/// Rolling friction: brakes how the two turn against each other, by a couple of at most `most`, in mass * length^2 / s,
/// and by no more than makes the energy of turning least along their relative angular velocity. Returns the couple on
/// b; that on a is the opposite. To be applied before the impulse, which is then that of the motions that are left; if
/// these do not approach any more at the point of contact nothing changes, and the couple is 0. Energy never grows.
Eigen::Vector3d brake_turning(RigidVelocity& a, RigidVelocity& b, const Mobility& of_a, const Mobility& of_b,
                              const ContactArms& arms, double most);
/// The normal impulse without friction that changes the normal velocity at the point of contact by `change`.
double push_for(double change, const Mobility& of_a, const Mobility& of_b, const ContactArms& arms);

}  // namespace kds::collision
