// A scene from a seed.
#pragma once

#include "tests/fuzz/random_piles/scene.hpp"

#include <cstdint>

namespace kds::piles {

/// The same with one compiler: in which order numbers are drawn for the arguments of a call is up to it.
Scene make_scene(std::uint64_t seed);

}  // namespace kds::piles
