// Makes a scene that is wrong smaller, and shows it.
#pragma once

#include "tests/fuzz/random_piles/measure.hpp"
#include "tests/fuzz/random_piles/scene.hpp"

#include <optional>

namespace kds::piles {

/// The scene without bodies that are not needed for what the budget seeks; none if it is not found in the whole one.
std::optional<Scene> reduced(Scene scene, const Budget& budget);

/// Prints gravity, walls and bodies, with all bits of their numbers.
void print_scene(const Scene& scene);

}  // namespace kds::piles
