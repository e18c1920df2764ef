// Modes of the processor under which signs are not exact are refused.
#include "kds/arithmetic/strict.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/pieces.hpp"
#include "kds/simulator.hpp"

#include <catch2/catch.hpp>

#include <cfenv>
#include <string>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace kds::test_strict {
namespace {

/// What is said in some mode; Catch calculates, too, so the mode lasts for this alone.
template <class Enter, class Leave>
std::string said(const Enter& enter, const Leave& leave) {
  std::string result;
  enter();
  try {
    require_strict_arithmetic("Somebody");
  } catch (const std::runtime_error& error) {
    result = error.what();
  }
  leave();
  return result;
}

TEST_CASE("Arithmetic as it is by default is accepted", "[strict]") {
  CHECK_NOTHROW(require_strict_arithmetic("Somebody"));
}

TEST_CASE("Directed rounding is refused", "[strict]") {
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    const std::string text = said([&] { std::fesetround(mode); }, [] { std::fesetround(FE_TONEAREST); });
    CHECK(text.find("Somebody: this thread does not round to nearest") == 0);
  }
  CHECK(said([] {}, [] {}).empty());
}

#ifdef __SSE2__
TEST_CASE("Subnormal numbers that are taken for zero are refused", "[strict]") {
  const unsigned before = _mm_getcsr();
  constexpr unsigned flush_to_zero = 1u << 15, denormals_are_zero = 1u << 6;
  for (const unsigned mode : {flush_to_zero, denormals_are_zero, flush_to_zero | denormals_are_zero}) {
    const std::string text = said([&] { _mm_setcsr(before | mode); }, [&] { _mm_setcsr(before); });
    CHECK(text.find("Somebody: this thread takes subnormal numbers for zero") == 0);
  }
}
#endif

TEST_CASE("A simulator is not made where arithmetic is not exact", "[strict]") {
  MovingSet<Motion<1>> values;
  Pieces<Motion<1>> pieces(values);
  bool refused = false;
  std::fesetround(FE_UPWARD);
  try {
    Simulator simulator(0, pieces);
  } catch (const std::runtime_error&) {
    refused = true;
  }
  std::fesetround(FE_TONEAREST);
  CHECK(refused);
  CHECK_NOTHROW(Simulator(0, pieces));
}

}  // namespace
}  // namespace kds::test_strict
