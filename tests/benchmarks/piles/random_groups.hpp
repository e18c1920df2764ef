// Which random scenes can be compared with Bullet, and in which row of the table each is counted.
#pragma once

#include "tests/fuzz/random_piles/scene.hpp"

#include <string>

namespace kds::piles {

/// Whether Bullet has nothing alike: free meshes, which it has as hulls or not at all, and walls around what is no
/// ball, since walls here hold bounding balls.
bool left_out(const Scene& scene);

/// The kind of the scene, or what it is counted as instead: what is left out; and bodies so small, in a gravity that is
/// not scaled with them, that frames are too rare for them whatever the kind.
std::string group_of(const Scene& scene);

}  // namespace kds::piles
