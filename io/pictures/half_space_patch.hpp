// Half-spaces in pictures.
#pragma once

#include "io/scene.hpp"

namespace kds::io {

bool has_half_spaces(const Scene& scene);

/// The scene with a square mesh in the place of each half-space: the part of its plane nearest to the middle of the
/// other bodies as they begin, a fifth wider than the ball around all of them and the domain. For pictures alone.
Scene with_patches(const Scene& scene);

}  // namespace kds::io
