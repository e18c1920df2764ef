#include "tests/benchmarks/speed/scenes.hpp"

#include "tests/support/random_numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <stdexcept>

namespace speed {
namespace {

using Eigen::Vector3d;
using kds::tests::Random;

/// Balls placed so far: for each doubling of the radius a hashed grid of cells as wide as its largest diameter. What a
/// new ball might overlap lies in 27 cells of each, if none placed before is smaller.
class Placement {
 public:
  Placement(std::size_t balls, double largest) : largest_(largest), next_(balls), placed_(balls) {
    while (buckets_ < 2 * balls) buckets_ *= 2;
  }

  bool is_free(const Vector3d& at, double radius) const {
    for (std::size_t level = 0; level < levels_.size(); ++level) {
      if (levels_[level].empty()) continue;
      const auto home = cell_of(at, level);
      for (int k = 0; k < 27; ++k) {
        const std::array<std::int64_t, 3> cell{home[0] + k % 3 - 1, home[1] + k / 3 % 3 - 1, home[2] + k / 9 - 1};
        for (std::int32_t i = levels_[level][bucket(cell)]; i >= 0; i = next_[static_cast<std::size_t>(i)]) {
          const auto& [centre, r] = placed_[static_cast<std::size_t>(i)];
          const double sum_of_radii = (radius + r) * (1 + 1e-9);  // not in touch either, whoever rounds how
          if ((centre - at).squaredNorm() <= sum_of_radii * sum_of_radii) return false;
        }
      }
    }
    return true;
  }

  void add(std::size_t i, const Vector3d& at, double radius) {
    const auto level = static_cast<std::size_t>(std::max(0, static_cast<int>(std::log2(largest_ / radius))));
    if (levels_.size() <= level) levels_.resize(level + 1);
    if (levels_[level].empty()) levels_[level].assign(buckets_, -1);
    placed_[i] = {at, radius};
    std::int32_t& head = levels_[level][bucket(cell_of(at, level))];
    next_[i] = head;
    head = static_cast<std::int32_t>(i);
  }

 private:
  struct Placed {
    Vector3d centre;
    double radius;
  };

  std::array<std::int64_t, 3> cell_of(const Vector3d& at, std::size_t level) const {
    const double width = std::ldexp(2 * largest_ * (1 + 1e-6), -static_cast<int>(level));
    std::array<std::int64_t, 3> cell{};
    for (int d = 0; d < 3; ++d) cell[static_cast<std::size_t>(d)] = static_cast<std::int64_t>(at[d] / width);
    return cell;
  }
  std::size_t bucket(const std::array<std::int64_t, 3>& cell) const {
    std::uint64_t h = 0;
    for (const std::int64_t c : cell) h = (h ^ static_cast<std::uint64_t>(c)) * 0x9E3779B97F4A7C15u;
    return static_cast<std::size_t>(h >> 20) & (buckets_ - 1);
  }

  double largest_;
  std::size_t buckets_ = 16;
  std::vector<std::vector<std::int32_t>> levels_;
  std::vector<std::int32_t> next_;
  std::vector<Placed> placed_;
};

std::vector<double> draw(Random& random, std::size_t n, double spread, Draw how) {
  std::vector<double> values(n);
  for (double& x : values) {
    x = how == Draw::uniform ? random.between(1, spread) : std::exp(random.between(0, std::log(spread)));
  }
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(n);
  for (double& x : values) x /= mean;
  return values;
}

Vector3d direction(Random& random) {
  for (;;) {
    Vector3d v;
    for (int d = 0; d < 3; ++d) v[d] = random.between(-1, 1);
    const double square = v.squaredNorm();
    if (square > 0.01 && square < 1) return v / std::sqrt(square);
  }
}

/// The sides of a box of this volume; the short ones hold the largest ball with some room.
Vector3d sides(double volume, Flatness flatness, double largest) {
  constexpr double thin = 0.02;
  const double least = 2.5 * largest;
  if (flatness == Flatness::cube) return Vector3d::Constant(std::max(std::cbrt(volume), least));
  if (flatness == Flatness::slab) {
    const double z = std::max(thin * std::cbrt(volume / thin), least);
    const double x = std::max(std::sqrt(volume / z), least);
    return {x, x, z};
  }
  const double z = std::max(thin * std::cbrt(volume / (thin * thin)), least);
  return {std::max(volume / (z * z), least), z, z};
}

/// Centres of balls of these radii, or nothing where one finds no room.
std::optional<std::vector<Vector3d>> place(Random& random, const std::vector<double>& radii, const Vector3d& side) {
  std::vector<std::size_t> order(radii.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return radii[i] > radii[j]; });
  Placement placement(radii.size(), radii[order[0]]);
  std::vector<Vector3d> centres(radii.size());
  constexpr int most_tries = 20'000;  // some 50 are needed at a packing of 0.25
  for (const std::size_t i : order) {
    const double r = radii[i] * (1 + 1e-9);
    Vector3d at;
    int tries = 0;
    do {
      if (++tries > most_tries) return std::nullopt;
      for (int d = 0; d < 3; ++d) at[d] = random.between(r, side[d] - r);
    } while (!placement.is_free(at, r));
    placement.add(i, at, r);
    centres[i] = at;
  }
  return centres;
}

/// A normal deviate, by the polar method ([Knuth] section 3.4.1).
double normal(Random& random) {
  for (;;) {
    const double x = random.between(-1, 1);
    const double y = random.between(-1, 1);
    const double s = x * x + y * y;
    if (s > 0 && s < 1) return x * std::sqrt(-2 * std::log(s) / s);
  }
}

}  // namespace

const char* name(Flatness flatness) {
  switch (flatness) {
    case Flatness::cube:
      return "cube";
    case Flatness::slab:
      return "slab";
    case Flatness::line:
      return "line";
  }
  return "?";
}

BallScene make_scene(const SceneOptions& options) {
  if (options.bodies == 0) throw std::invalid_argument("SceneOptions.bodies: must be > 0");
  if (!(options.packing > 0 && options.packing <= 0.3)) {
    throw std::invalid_argument("SceneOptions.packing: must be > 0 and at most 0.3");
  }
  if (!(options.size_spread >= 1)) throw std::invalid_argument("SceneOptions.size_spread: must be >= 1");
  if (!(options.speed_spread >= 1)) throw std::invalid_argument("SceneOptions.speed_spread: must be >= 1");
  Random random(options.seed);
  const auto radii = draw(random, options.bodies, options.size_spread, options.draw);
  const auto speeds = draw(random, options.bodies, options.speed_spread, options.draw);
  double volume = 0;
  for (const double r : radii) volume += 4.0 / 3.0 * std::numbers::pi * r * r * r;
  const double largest = *std::max_element(radii.begin(), radii.end());

  BallScene scene;
  std::optional<std::vector<Vector3d>> centres;
  // A few balls in a box not much wider than they are may not find the packing asked for.
  for (double room = volume / options.packing; !centres; room *= 1.1) {
    scene.side = sides(room, options.flatness, largest);
    centres = place(random, radii, scene.side);
  }
  scene.packing = volume / scene.side.prod();
  for (std::size_t i = 0; i < options.bodies; ++i) {
    Vector3d velocity = direction(random) * speeds[i];
    if (options.maxwell) {
      for (int d = 0; d < 3; ++d) velocity[d] = normal(random);
    }
    if (random.unit() < options.at_rest) velocity.setZero();
    scene.balls.push_back({radii[i], (*centres)[i], velocity});
  }
  return scene;
}

}  // namespace speed
