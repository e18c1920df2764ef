// The names of bodies.
#include "collision/body_id.hpp"

#include <catch2/catch.hpp>

namespace kds::collision::test_body_id {
namespace {

TEST_CASE("An id is a slot and a generation in one number", "[body_id]") {
  const BodyId id = body_id(3, 7);
  CHECK(id == 0x300000007);
  CHECK(body_slot(id) == 7);
  CHECK(body_generation(id) == 3);
  CHECK(body_id(0, 7) == 7);
  const BodyId greatest = body_id(~0u, no_body);
  CHECK(greatest == ~BodyId{0});
  CHECK(body_slot(greatest) == no_body);
  CHECK(body_generation(greatest) == ~0u);
}

TEST_CASE("Ids are ordered by generation, and of one generation by slot", "[body_id]") {
  CHECK(body_id(0, 1) < body_id(0, 2));
  CHECK(body_id(0, 1) < body_id(1, 1));
  CHECK(body_id(0, 2) < body_id(9, 1));
}

}  // namespace
}  // namespace kds::collision::test_body_id
