// Compounds in pictures.
#pragma once

#include "io/scene.hpp"

namespace kds::io {

bool has_compounds(const Scene& scene);

/// The scene with a mesh in the place of each compound: the surfaces of all its parts, also where they are inside of
/// each other. One for all bodies that share a compound. For pictures alone.
Scene with_surfaces(const Scene& scene);

}  // namespace kds::io
