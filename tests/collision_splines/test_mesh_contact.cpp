// Meshes on curves: against brute force over all pairs of triangles, and against static distances.
#include "tests/collision/narrow_phase/check_mesh_contact.hpp"

#include <catch2/catch.hpp>

namespace test_mesh_contact {

using namespace kds::collision;
using namespace kds::collision::samples;

TEST_CASE("Curves: trees give what all pairs of triangles give, bit for bit", "[splines]") {
  against_brute_force<3>(21, 10);
  against_brute_force<5>(22, 10);
}

TEST_CASE("Curves: before a contact surfaces are apart, and at it they are near", "[splines]") {
  against_distances<3>(31, 30);
  against_distances<4>(32, 10);
  against_distances<5>(33, 30);
}

}  // namespace test_mesh_contact
