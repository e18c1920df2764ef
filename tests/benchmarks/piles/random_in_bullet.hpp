// The scenes of tests/fuzz/random_piles/ in Bullet. Only with KDS_PEER_BULLET.
#pragma once

#include "tests/fuzz/random_piles/measure.hpp"
#include "tests/fuzz/random_piles/scene.hpp"

namespace kds::piles {

/// 240 frames a second, measured every `sample` as a world of this library is, by the same formulas. `seconds` are
/// those of the frames alone; the run stops after so many of them, and where a place is no number any more.
/// Precondition: !left_out(scene) (random_groups.hpp).
Result run_in_bullet(const Scene& scene, double most_seconds);

}  // namespace kds::piles
