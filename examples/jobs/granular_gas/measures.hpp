// What is measured of a gas, besides the sums over its contacts.
#pragma once

#include "examples/jobs/granular_gas/gas.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace granular_gas {

/// A mean and its standard error, from blocks of time that are taken to be independent.
struct Mean {
  double value = 0;
  double error = 0;
};
Mean mean_of(const std::vector<double>& blocks);

/// Pairs of balls by the distance of their centres over that at contact, relative to what there would be if balls were
/// spread evenly (of equal balls, the radial distribution).
class RadialDistribution {
 public:
  static constexpr double width = 0.02;     ///< of a bin; the first begins at contact
  static constexpr std::size_t bins = 100;  ///< up to three diameters

  /// Counts the pairs of some balls with all others as they are now.
  void sample(const Gas& gas);
  /// The middle of a bin, and the distribution there.
  static double distance(std::size_t bin) { return 1 + (double(bin) + 0.5) * width; }
  double value(std::size_t bin) const { return counts_[bin] / expected_[bin]; }
  /// At contact: a parabola through the first ten bins, by least squares.
  double at_contact() const;

 private:
  std::vector<double> counts_ = std::vector<double>(bins, 0);
  std::vector<double> expected_ = std::vector<double>(bins, 0);
};

/// How far balls have come after some time, from samples at equal intervals.
class Displacements {
 public:
  explicit Displacements(double interval) : interval_(interval) {}

  void sample(const Gas& gas);
  /// The greatest number of intervals for which there is a mean over many starts.
  std::size_t longest() const { return samples_.size() / 4; }
  double interval() const { return interval_; }
  /// Mean square of the displacement after so many intervals, over starts in [first, last).
  double mean_square(std::size_t intervals, std::size_t first, std::size_t last) const;
  double mean_square(std::size_t intervals) const { return mean_square(intervals, 0, samples_.size() - intervals); }
  /// Coefficient of diffusion: a sixth of the slope between two numbers of intervals; error from ten spans of time.
  Mean diffusion(std::size_t from, std::size_t to) const;

 private:
  static constexpr std::size_t most_balls = 2000;  ///< that are followed

  double interval_;
  std::vector<std::vector<Eigen::Vector3d>> samples_;
};

}  // namespace granular_gas
