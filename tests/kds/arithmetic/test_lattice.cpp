#include "kds/arithmetic/lattice.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace test_lattice {
namespace {

using namespace kds;
using kds::tests::Random;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double largest = std::numeric_limits<double>::max();
constexpr double least = std::numeric_limits<double>::denorm_min();
constexpr double least_normal = std::numeric_limits<double>::min();

std::vector<double> sample(Random& random) {
  std::vector<double> all{0.0, -0.0, least, -least, least_normal, -least_normal, 1, -1, 1e9, largest, -largest};
  for (int i = 0; i < 500; ++i) all.push_back(random.any());
  return all;
}

}  // namespace

TEST_CASE("neighbours on the lattice are the neighbours of the standard library", "[lattice]") {
  const std::uint64_t seed = 2;
  CAPTURE(seed);
  Random random(seed);
  for (const double x : sample(random)) {
    CAPTURE(x);
    CHECK(next_up(x) == std::nextafter(x, infinity));
    CHECK(next_down(x) == std::nextafter(x, -infinity));
    CHECK(lattice_point(lattice_index(x)) == x);
    CHECK(lattice_index(next_up(x)) == lattice_index(x) + 1);
  }
  CHECK(next_up(largest) == infinity);
  CHECK(next_down(infinity) == largest);
  CHECK(next_up(-least) == 0);
  CHECK(next_down(0.0) == -least);
}

TEST_CASE("the lattice has the order of the numbers, and both zeros stand in one place", "[lattice]") {
  const std::uint64_t seed = 3;
  CAPTURE(seed);
  Random random(seed);
  const std::vector<double> all = sample(random);
  for (const double a : all) {
    for (const double b : {all[random.below(all.size())], all[random.below(all.size())], next_up(a), a}) {
      CAPTURE(a, b);
      CHECK((a < b) == (lattice_index(a) < lattice_index(b)));
      CHECK((a == b) == (lattice_index(a) == lattice_index(b)));
    }
  }
  CHECK(lattice_index(-0.0) == 0);
  CHECK(lattice_index(0.0) == 0);
}

TEST_CASE("distances count the steps", "[lattice]") {
  CHECK(lattice_distance(1, 1) == 0);
  CHECK(lattice_distance(1, next_up(1)) == 1);
  CHECK(lattice_distance(1, 2) == std::uint64_t{1} << 52);
  CHECK(lattice_distance(-0.0, 0.0) == 0);
  CHECK(lattice_distance(-least, least) == 2);
  CHECK(lattice_distance(-largest, largest) == 2 * static_cast<std::uint64_t>(lattice_index(largest)));
  CHECK(lattice_distance(-infinity, infinity) == lattice_distance(-largest, largest) + 2);
}

TEST_CASE("bisection on the lattice reaches any double within 64 halvings", "[lattice]") {
  const std::uint64_t seed = 4;
  CAPTURE(seed);
  Random random(seed);
  for (const double target : sample(random)) {
    CAPTURE(target);
    double below = -infinity;
    double above = infinity;
    int halvings = 0;
    while (next_up(below) < above) {
      const double middle = lattice_middle(below, above);
      REQUIRE(below < middle);
      REQUIRE(middle < above);
      (middle < target ? below : above) = middle;
      REQUIRE(++halvings <= 64);
    }
    CHECK(above == target);
  }
}

}  // namespace test_lattice
