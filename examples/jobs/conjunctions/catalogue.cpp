#include "examples/jobs/conjunctions/catalogue.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace conjunctions {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// The engine's sequence is fixed by the standard, that of std::uniform_real_distribution is not.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  /// In (-1, 1), most near 0.
  double peaked() {
    const double x = uniform(-1, 1);
    const double y = uniform(-1, 1);
    return x * y * y;
  }
  Elements orbit(double perigee_height, double apogee_height, double inclination) {
    const double low = earth_radius + perigee_height, high = earth_radius + apogee_height;
    const double node = uniform(0, 360 * degree);
    const double perigee = uniform(0, 360 * degree);
    const double anomaly = uniform(0, 360 * degree);
    return {(low + high) / 2, (high - low) / (high + low), inclination, node, perigee, anomaly};
  }

 private:
  std::mt19937_64 engine_;
};

Elements low_orbit(Random& random, std::size_t i) {
  constexpr std::array<double, 3> busy{550, 800, 1400};
  const double height = std::max(400.0, busy[i % 3] + 250 * random.peaked());
  const double rise = std::abs(0.04 * random.peaked()) * (earth_radius + height);
  const double inclination = random.uniform(50, 100) * degree;
  return random.orbit(height, height + rise, inclination);
}

/// In one of 72 planes.
Elements constellation_orbit(Random& random, std::size_t i) {
  const double height = random.uniform(500, 600);
  Elements elements = random.orbit(height, height, 53 * degree);
  elements.node = static_cast<double>(i % 72) * 5 * degree;
  elements.perigee = 0;
  return elements;
}

Elements elongated_orbit(Random& random) {
  const double perigee = random.uniform(250, 1000);
  const double apogee = random.uniform(perigee, 20000);
  const double inclination = random.uniform(0, 70) * degree;
  return random.orbit(perigee, apogee, inclination);
}

Elements high_orbit(Random& random, std::size_t i) {
  const double height = i % 2 == 0 ? 35786 + 200 * random.peaked() : random.uniform(8000, 24000);
  const double inclination = (i % 2 == 0 ? std::abs(15 * random.peaked()) : random.uniform(50, 65)) * degree;
  return random.orbit(height, height, inclination);
}

}  // namespace

std::vector<Elements> made_up_catalogue(std::size_t objects, std::uint64_t seed) {
  Random random(seed);
  std::vector<Elements> catalogue;
  catalogue.reserve(objects);
  for (std::size_t i = 0; i < objects; ++i) {
    const std::size_t kind = i % 10, number = i / 10;
    catalogue.push_back(kind < 6    ? low_orbit(random, 6 * number + kind)
                        : kind < 8  ? constellation_orbit(random, 2 * number + kind)
                        : kind == 8 ? elongated_orbit(random)
                                    : high_orbit(random, number));
  }
  return catalogue;
}

std::vector<Elements> dense_shell(std::size_t objects, std::uint64_t seed) {
  Random random(seed);
  std::vector<Elements> catalogue;
  catalogue.reserve(objects);
  for (std::size_t i = 0; i < objects; ++i) {
    const double height = random.uniform(795, 805);
    const double inclination = random.uniform(0, 180) * degree;
    catalogue.push_back(random.orbit(height, height, inclination));
  }
  return catalogue;
}

}  // namespace conjunctions
