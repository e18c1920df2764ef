// Measures the bodies of a scene where they are at a time, whoever moves them.
#pragma once

#include "tests/fuzz/random_piles/depth.hpp"
#include "tests/fuzz/random_piles/measure.hpp"
#include "tests/fuzz/random_piles/scene.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <deque>
#include <limits>
#include <string>
#include <vector>

namespace kds::piles {

/// Writes into a result what was measured, and what is wrong. Pairs that begin in overlap are not measured.
class Meter {
 public:
  /// Both have to outlive the meter.
  Meter(const Scene& scene, Result& result);

  /// Of all bodies, in their order; to be set before each look. At the start: those of the scene.
  std::vector<Eigen::Vector3d> places{};
  std::vector<Eigen::Vector3d> velocities{};

  /// A body whose motion has changed since the last look.
  void touch(std::size_t i);
  /// Looks at those; at all where there are few.
  void look_at_touched(double now);
  void look_at_all(double now);

  /// In parts of the energy at the start.
  double kinetic() const;
  /// Something wrong, by so much.
  void find(const char* what, double now, double amount, const std::string& text);

 private:
  double smaller(std::size_t a, std::size_t b) const;
  void look_at(std::size_t i, std::size_t after, double now);
  void look_outside(std::size_t i, double now);
  void look_at_sums(double now);
  double energy() const;
  Eigen::Vector3d momentum() const;
  double gained_for_good(double now, double energy);
  void make_scales();

  const Scene& scene_;
  Result& result_;
  std::vector<Solid> solids_{};
  std::vector<std::size_t> free_{};
  std::vector<char> skipped_{};  ///< pairs that are not measured
  std::vector<char> touched_{};
  std::vector<char>
      left_{};  ///< have been above the region: a light body among heavy ones may be tossed over its sides
  std::vector<std::size_t> list_{};
  double scale_ = 0;
  struct Sample {
    double time, energy;
  };
  std::deque<Sample> recent_{};  ///< of the last few spans; no later one has less energy
  double lasting_ = 0;           ///< s
  double least_energy_ = std::numeric_limits<double>::infinity();
  Eigen::Vector3d momentum_ = Eigen::Vector3d::Zero();
  double momenta_ = 0;
};

}  // namespace kds::piles
