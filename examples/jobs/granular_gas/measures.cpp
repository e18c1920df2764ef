#include "examples/jobs/granular_gas/measures.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace granular_gas {

using Eigen::Vector3d;

Mean mean_of(const std::vector<double>& blocks) {
  const double count = double(blocks.size());
  Mean mean;
  for (const double block : blocks) mean.value += block / count;
  for (const double block : blocks) mean.error += (block - mean.value) * (block - mean.value);
  mean.error = std::sqrt(mean.error / (count * (count - 1)));
  return mean;
}

void RadialDistribution::sample(const Gas& gas) {
  constexpr std::size_t most_pairs = 4'000'000;
  const std::size_t centres = std::min(gas.size(), most_pairs / gas.size() + 1);
  std::vector<Vector3d> places;
  for (std::size_t i = 0; i < gas.size(); ++i) places.push_back(gas.position(i));
  const double farthest = distance(bins - 1) + width / 2;
  for (std::size_t i = 0; i < centres; ++i) {
    double cubes = 0;  // of the distances at contact
    for (std::size_t j = 0; j < gas.size(); ++j) {
      if (j == i) continue;
      const double contact = gas.radius(i) + gas.radius(j);
      cubes += contact * contact * contact;
      double square = 0;
      for (int d = 0; d < 3; ++d) {
        const double apart = places[j][d] - places[i][d];
        const double nearest = apart - gas.side() * std::round(apart / gas.side());
        square += nearest * nearest;
      }
      if (square > farthest * farthest * contact * contact) continue;
      const double bin = (std::sqrt(square) / contact - 1) / width;
      if (bin >= 0 && bin < double(bins)) counts_[static_cast<std::size_t>(bin)] += 1;
    }
    for (std::size_t bin = 0; bin < bins; ++bin) {
      const double low = distance(bin) - width / 2, high = low + width;
      const double shell = 4 * std::numbers::pi / 3 * (high * high * high - low * low * low);
      expected_[bin] += cubes * shell / gas.volume();
    }
  }
}

double RadialDistribution::at_contact() const {
  constexpr std::size_t used = 10;
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Vector3d products = Vector3d::Zero();
  for (std::size_t bin = 0; bin < used; ++bin) {
    const double x = distance(bin) - 1;
    const Vector3d powers(1, x, x * x);
    squares += powers * powers.transpose();
    products += value(bin) * powers;
  }
  return (squares.inverse() * products)[0];
}

void Displacements::sample(const Gas& gas) {
  std::vector<Vector3d>& places = samples_.emplace_back();
  for (std::size_t i = 0; i < std::min(gas.size(), most_balls); ++i) places.push_back(gas.unwrapped(i));
}

double Displacements::mean_square(std::size_t intervals, std::size_t first, std::size_t last) const {
  double sum = 0;
  for (std::size_t start = first; start < last; ++start) {
    const auto &from = samples_[start], &to = samples_[start + intervals];
    for (std::size_t i = 0; i < from.size(); ++i) sum += (to[i] - from[i]).squaredNorm();
  }
  return sum / double((last - first) * samples_.front().size());
}

Mean Displacements::diffusion(std::size_t from, std::size_t to) const {
  constexpr std::size_t spans = 10;
  const std::size_t starts = samples_.size() - to;
  std::vector<double> slopes;
  for (std::size_t span = 0; span < spans; ++span) {
    const std::size_t first = span * starts / spans, last = (span + 1) * starts / spans;
    const double gain = mean_square(to, first, last) - mean_square(from, first, last);
    slopes.push_back(gain / (6 * double(to - from) * interval_));
  }
  return mean_of(slopes);
}

}  // namespace granular_gas
