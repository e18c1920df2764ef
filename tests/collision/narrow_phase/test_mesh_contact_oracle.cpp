// Meshes against meshes, boxes and balls: against brute force over all pairs of triangles, and against static
// distances.
#include "tests/collision/narrow_phase/check_mesh_contact.hpp"

#include <catch2/catch.hpp>

namespace test_mesh_contact_oracle {

using namespace kds::collision::samples;

TEST_CASE("Trees give what all pairs of triangles give, bit for bit") {
  against_brute_force<1>(1, 60);
  against_brute_force<1>(2, 60);
  against_brute_force<2>(3, 40);
}

TEST_CASE("Before a contact surfaces are apart, and at it they are near") {
  against_distances<1>(11, 60);
  against_distances<2>(12, 60);
}

}  // namespace test_mesh_contact_oracle
