// Signs of turning certificates of random scenes against the truth.
#pragma once

#include "tests/certificates/turning/check_turning.hpp"
#include "tests/certificates/turning/turning_scenes.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <string>

namespace kds::tests {

/// `make(random, coarse, scene)` returns a certificate of the two bodies of a scene.
template <int Degree, class Make>
void check_random_signs(const std::string& what, std::uint64_t seed, const Make& make) {
  CAPTURE(Degree, seed);
  Random random(seed);
  for (const bool coarse : {false, true}) {
    LadderTally tally;
    for (int round = 0; round < 850; ++round) {
      const auto scene = turning_scene<Degree>(random, coarse);
      compare(make(random, coarse, scene), scene.time, scene.span, tally);
    }
    tally.print((what + (coarse ? ", coarse" : "")).c_str(), seed);
    CHECK(tally.wrong == 0);
    CHECK(tally.cases >= 8000);
    CHECK(tally.rungs.extended > 1000);
    CHECK(tally.rungs.zeros >= (coarse ? 100u : 0u));
  }
}

}  // namespace kds::tests
