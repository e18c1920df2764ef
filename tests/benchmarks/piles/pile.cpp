#include "tests/benchmarks/piles/pile.hpp"

#include "tests/support/random_numbers.hpp"

#include <algorithm>
#include <cmath>

namespace piles {
namespace {

using Eigen::Vector3d;

constexpr double least_radius = 0.25;
constexpr double greatest_radius = 0.4;

/// Layers of balls in columns a unit of length apart, the lowest at a height.
void add_layers(Pile& pile, kds::tests::Random& random, std::size_t balls, const Vector3d& corner, int wide, int deep) {
  for (std::size_t i = 0; i < balls; ++i) {
    const auto column = static_cast<int>(i % static_cast<std::size_t>(wide * deep));
    Vector3d place = corner;
    place[0] += 0.5 + column % wide + random.between(-0.05, 0.05);
    place[1] += static_cast<double>(i / static_cast<std::size_t>(wide * deep));
    place[2] += 0.5 + column / wide + random.between(-0.05, 0.05);
    const double radius = random.between(least_radius, greatest_radius);
    pile.balls.push_back({radius, place, Vector3d(random.between(-2, 2), 0, 0)});
  }
}

double depth_in_box(const FixedBox& box, const Vector3d& place, double radius) {
  const Vector3d local = box.turn.conjugate() * (place - box.place);
  const Vector3d out = local.cwiseAbs() - box.half_extents;
  return radius - (out.maxCoeff() <= 0 ? out.maxCoeff() : out.cwiseMax(0).norm());
}

}  // namespace

double Pile::energy() const {
  double sum = 0;
  for (const Ball& ball : balls) {
    sum += ball.mass() * (0.5 * ball.velocity.squaredNorm() + gravity * ball.place[1]);
  }
  return sum;
}

Pile make_pile(std::size_t balls, int wide, int deep) {
  Pile pile{std::to_string(balls) + " balls", Vector3d(wide, 0, deep)};
  kds::tests::Random random(1);
  add_layers(pile, random, balls, Vector3d(0, 3, 0), wide, deep);
  return pile;
}

Pile make_hopper(std::size_t balls) {
  constexpr int wide = 10, deep = 4;
  constexpr double angle = 0.7, hole = 1.6, high = 4, length = 6, thick = 0.25;
  Pile pile{"hopper of " + std::to_string(balls), Vector3d(wide, 0, deep)};
  for (const int side : {-1, 1}) {
    const Vector3d lip(wide / 2.0 + side * hole / 2, high, deep / 2.0);
    const Vector3d along(side * std::cos(angle), std::sin(angle), 0);
    const Vector3d up(-side * std::sin(angle), std::cos(angle), 0);
    pile.boxes.push_back({Vector3d(length / 2, thick, deep / 2.0), lip + along * (length / 2) - up * thick,
                          Eigen::Quaterniond(Eigen::AngleAxisd(side * angle, Vector3d::UnitZ())).normalized()});
  }
  kds::tests::Random random(2);
  add_layers(pile, random, balls, Vector3d(2, high + 5, 0), wide - 4, deep);
  return pile;
}

void Gauge::look(double t, double seconds, const std::vector<Vector3d>& places,
                 const std::vector<Vector3d>& velocities) {
  const std::vector<Ball>& balls = pile_.balls;
  double deep = outcome_.overlap;
  double kinetic = 0;
  for (std::size_t a = 0; a < balls.size(); ++a) {
    const double radius = balls[a].radius;
    const Vector3d& x = places[a];
    kinetic += 0.5 * balls[a].mass() * velocities[a].squaredNorm();
    deep = std::max({deep, radius - x[0], radius + x[0] - pile_.space[0], radius - x[1], radius - x[2],
                     radius + x[2] - pile_.space[2]});
    for (const FixedBox& box : pile_.boxes) deep = std::max(deep, depth_in_box(box, x, radius));
    for (std::size_t b = a + 1; b < balls.size(); ++b) {
      const double sum_of_radii = radius + balls[b].radius;
      const double squared = (places[b] - x).squaredNorm();
      if (squared < sum_of_radii * sum_of_radii) deep = std::max(deep, sum_of_radii - std::sqrt(squared));
    }
  }
  outcome_.overlap = deep;
  outcome_.kinetic = kinetic / energy_;
  outcome_.reached = t;
  outcome_.seconds = seconds;
  if (!(outcome_.kinetic < resting_energy)) {
    outcome_.rest = outcome_.seconds_to_rest = std::numeric_limits<double>::infinity();
  } else if (std::isinf(outcome_.rest)) {
    outcome_.rest = t;
    outcome_.seconds_to_rest = seconds;
  }
}

}  // namespace piles
