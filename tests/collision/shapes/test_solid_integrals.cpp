// Integrals over what a mesh bounds, made when they are first asked for. (Their values: test_mass_properties.cpp.)
#include "collision/shapes/mesh.hpp"
#include "collision/shapes/solid_integrals.hpp"

#include <Eigen/Core>
#include <catch2/catch.hpp>

#include <memory>
#include <set>
#include <thread>
#include <vector>

namespace test_solid_integrals {
namespace {

using namespace kds::collision;
using Eigen::Vector3d;

TEST_CASE("A mesh is integrated once, by the first of several threads, or refused each time", "[mass properties]") {
  const std::vector<Vector3d> vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const auto closed =
      std::make_shared<const Mesh>(vertices, std::vector<Mesh::Triangle>{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
  std::vector<const SolidIntegrals*> seen(4);
  std::vector<std::thread> threads;
  for (const SolidIntegrals*& each : seen) threads.emplace_back([&] { each = &closed->solid(); });
  for (std::thread& thread : threads) thread.join();
  CHECK(std::set(seen.begin(), seen.end()).size() == 1);
  const SolidIntegrals& solid = closed->solid();
  CHECK((solid.volume / 6.0).high * solid.unit * solid.unit * solid.unit == 1.0 / 6);
  const Mesh open(vertices, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}});
  for (int i = 0; i < 3; ++i) CHECK_THROWS_WITH(open.solid(), Catch::Contains("is open: edge 0-2 belongs to one"));
}

}  // namespace
}  // namespace test_solid_integrals
