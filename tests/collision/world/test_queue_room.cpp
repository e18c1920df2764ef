// Queues that grow with a scene, up to what they can have.
#include "collision/world/queue_room.hpp"
#include "kds/events/calendar_queue.hpp"

#include <catch2/catch.hpp>

#include <cstddef>

namespace kds::collision::test_queue_room {
namespace {

struct SmallQueue {
  static constexpr std::size_t most_slots = 100;
  std::size_t size = 0;
  std::size_t slots() const { return size; }
  void resize(std::size_t slots) { size = slots; }
};
struct EndlessQueue {
  std::size_t size = 0;
  std::size_t slots() const { return size; }
  void resize(std::size_t slots) { size = slots; }
};

TEST_CASE("Room for slots doubles, up to the most there can be", "[queue_room]") {
  SmallQueue small;
  make_room(small, 1);
  CHECK(small.size == first_slots);
  make_room(small, first_slots + 1);
  CHECK(small.size == 2 * first_slots);
  make_room(small, 2 * first_slots + 1);
  CHECK(small.size == 100);
  make_room(small, 101);  // for the queue to refuse
  CHECK(small.size == 101);
  EndlessQueue endless;
  make_room(endless, 1000);
  CHECK(endless.size == 1000);
  make_room(endless, 1001);
  CHECK(endless.size == 2000);
}

TEST_CASE("A calendar queue names the most slots it can have", "[queue_room]") {
  CHECK(CalendarQueue<>::most_slots == (std::size_t{1} << 27) - 1);
}

}  // namespace
}  // namespace kds::collision::test_queue_room
