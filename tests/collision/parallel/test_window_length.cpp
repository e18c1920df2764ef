#include "collision/parallel/window_length.hpp"

#include <catch2/catch.hpp>

namespace kds::collision::test_window_length {

TEST_CASE("Windows end before the halo is used up, and grow while it is not", "[parallel]") {
  // What is unknown comes nearer at a speed that uses the halo up in 3 s.
  WindowLength length(0.1);
  double t = 0;
  int windows = 0;
  for (; windows < 20; ++windows) {
    double elapsed = 0;
    do {
      CHECK(length.step() > 0);
      elapsed += length.step();
      REQUIRE(elapsed < 3);
    } while (length.goes_on(elapsed, elapsed / 3));
    CHECK(elapsed > (windows == 0 ? 0.1 : 1));
    length.held(elapsed, elapsed / 3);
    t += elapsed;
  }
  CHECK(t > 2 * windows);
}

TEST_CASE("A window in which nothing comes nearer goes on in longer and longer steps", "[parallel]") {
  WindowLength length(1e-6);
  double elapsed = 0;
  int steps = 0;
  do {
    elapsed += length.step();
  } while (++steps < 100 && length.goes_on(elapsed, 0));
  CHECK(steps == 100);
  CHECK(elapsed > 1e6);
}

TEST_CASE("After windows that fail shorter ones are tried", "[parallel]") {
  WindowLength length(1);
  length.failed();
  length.failed();
  CHECK(length.seconds() == 0.25);
  CHECK(length.failures() == 2);
  length.held(0.25, 0.5);
  CHECK(length.failures() == 0);
}

}  // namespace kds::collision::test_window_length
