// A satellite on a Kepler orbit: where it is, and how sharply its path can bend.
#pragma once

#include <Eigen/Core>

namespace conjunctions {

/// The Earth's gravitational parameter, km^3/s^2, and its equatorial radius, km (WGS 84).
inline constexpr double mu = 398600.4418;
inline constexpr double earth_radius = 6378.137;

/// Kepler's elements. Angles in rad; those of the plane and the perigee do not change.
struct Elements {
  double semi_major_axis;  ///< km, > 0
  double eccentricity;     ///< in [0, 1)
  double inclination;
  double node;          ///< right ascension of the ascending node
  double perigee;       ///< argument of perigee
  double mean_anomaly;  ///< at t = 0
};

/// Of the centre of a satellite, in an inertial frame about the centre of the Earth: km, km/s, km/s^2.
struct State {
  Eigen::Vector3d position;
  Eigen::Vector3d velocity;
  Eigen::Vector3d acceleration;
};

/// Motion of two bodies: no flattening of the Earth, drag, Moon or Sun. This is where a user puts SGP4, or tabulated
/// ephemerides: the screening asks for state() and for piece_length() only.
class Orbit {
 public:
  /// Throws std::invalid_argument, naming the element, for one that is out of range.
  explicit Orbit(const Elements& elements);

  /// At t (s), by Kepler's equation: exact but for roundings, some 1e-9 km in a day.
  State state(double t) const;

  /// A length of time (s) such that the quintic that has place, velocity and acceleration of both ends of any stretch
  /// of the orbit so long differs from the orbit by less than `error` (km): so long at perigee, where the path bends
  /// most. Derivation: orbit.cpp.
  double piece_length(double error) const;

 private:
  Elements elements_;
  double mean_motion_;    ///< rad/s
  Eigen::Vector3d axis_;  ///< to the perigee, as long as the semi-major axis, km
  Eigen::Vector3d side_;  ///< at a right angle to it, as long as the semi-minor axis
};

}  // namespace conjunctions
