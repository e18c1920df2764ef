// A run as an animation in the glTF 2.0 format, for Blender and its like.
#pragma once

#include "io/replay.hpp"
#include "io/scene.hpp"

#include <string>

namespace kds::io {

/// One file with its data inside (JSON). Lengths and times are those of the scene, times from its beginning; its z axis
/// points up, as in scenes. Straight paths have keys where they begin and end, so that positions are those of the run
/// up to the seven digits of a float; accelerated paths and turns have keys `frames_per_second` times a second besides,
/// and are straight in between. Bodies that enter later or are removed have size 0 before and after. Meshes that bend
/// are morph targets, one a keyframe. Throws std::invalid_argument unless frames_per_second is finite and > 0, and
/// std::length_error where that would be more than a hundred million keys.
std::string to_gltf(const Scene& scene, const Record& record, const std::string& title, double frames_per_second = 60);

}  // namespace kds::io
