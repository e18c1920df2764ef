// Balls that fall and come to rest, for this engine and for others.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace piles {

struct Ball {
  double radius;
  Eigen::Vector3d place;
  Eigen::Vector3d velocity;
  double mass() const { return radius * radius * radius; }
};

struct FixedBox {
  Eigen::Vector3d half_extents;
  Eigen::Vector3d place;
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
};

/// Balls between walls: four at the sides, from 0 to `space`, and a floor at height 0. Gravity is along -y.
struct Pile {
  std::string name;
  Eigen::Vector3d space;
  std::vector<Ball> balls{};
  std::vector<FixedBox> boxes{};

  /// Kinetic and potential energy at the start, seen from the floor.
  double energy() const;
};

inline constexpr double restitution = 0.6;   ///< of every contact
inline constexpr double gravity = 9.81;      ///< length / s^2
inline constexpr double length_of_run = 20;  ///< s
/// s between measurements, which are left out of the time that is taken.
inline constexpr double sample = 0.1;
/// Below this part of the energy at the start a pile counts as resting, if it stays so.
inline constexpr double resting_energy = 1e-12;

/// The same on every compiler. Balls of radii 0.25 to 0.4 in layers above the floor.
Pile make_pile(std::size_t balls, int wide, int deep);
/// Two inclined boxes with a hole between them, and balls above.
Pile make_hopper(std::size_t balls);

/// What came of a run.
struct Outcome {
  double seconds = 0;                                                ///< of the processor, for the whole run
  double seconds_to_rest = std::numeric_limits<double>::infinity();  ///< infinity: it was never at rest
  double rest = std::numeric_limits<double>::infinity();             ///< s of simulated time
  double reached = 0;                                                ///< s of simulated time
  double overlap = 0;  ///< the deepest of two balls, a ball and a wall, or a ball and a box; in units of length
  double kinetic = 0;  ///< at the end, in parts of the energy at the start
};

/// Measures balls where they are at a time.
class Gauge {
 public:
  explicit Gauge(const Pile& pile) : pile_(pile), energy_(pile.energy()) {}
  /// `seconds`: of the processor so far.
  void look(double t, double seconds, const std::vector<Eigen::Vector3d>& places,
            const std::vector<Eigen::Vector3d>& velocities);
  const Outcome& outcome() const { return outcome_; }

 private:
  const Pile& pile_;
  double energy_;
  Outcome outcome_{};
};

/// Stops after so many seconds of the processor.
Outcome run_world(const Pile& pile, double most_seconds);
/// 240 frames a second. Only with KDS_PEER_BULLET.
Outcome run_bullet(const Pile& pile, double most_seconds);

}  // namespace piles
