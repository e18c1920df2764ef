// Bodies of a scene as they are saved in parts.
#pragma once

#include "collision/world/engine.hpp"
#include "collision/world/engine_image.hpp"
#include "collision/world/image_tools.hpp"
#include "collision/world/transfer/parcel.hpp"
#include "kds/framework/snapshot.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace kds::collision {

/// Some bodies, and pairs that overlap: of which one is among these, or of bodies that stand.
template <class Motion>
struct SavedBodies {
  using Overlap = typename Transfer<Motion>::Overlap;

  Parcel<Motion> parcel{};
  std::vector<Overlap> overlaps{};  ///< by numbers

  template <class Archive>
  void archive(Archive& archive) {
    archive.tag("bodies of a scene in parts");
    archive(parcel);
    archive.each(overlaps, [&](Overlap& overlap) { archive(overlap.a, overlap.b, overlap.passes_at); });
  }

  /// Throws std::runtime_error, naming what is wrong, unless they may be bodies of a scene of which this is saved, too.
  void check(const typename Engine<Motion>::Image& rest) const {
    const auto& numbers = parcel.numbers;
    const auto& bodies = parcel.bodies;
    if (bodies.bodies.size() != numbers.size() || parcel.to_come.size() != numbers.size() ||
        parcel.met.size() != numbers.size() || (turns<Motion> && parcel.turning.size() != numbers.size())) {
      image::fail("bodies: lists about them are of different lengths");
    }
    bodies.check(rest.now);
    const auto alive = [&](BodySlot place) { return bodies.alive(place); };
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      image::require(alive(static_cast<BodySlot>(i)) && numbers[i] < rest.bodies.elsewhere.slots, "bodies", i,
                     "is none of the scene");
    }
    check_orientations(bodies, parcel.to_come);
    typename Scripts<Motion>::Image{parcel.to_come}.check(bodies, rest.now);
    if constexpr (turns<Motion>) {
      typename Tumbling<Motion>::Image turning;
      for (const auto& progress : parcel.turning) {
        turning.of.push_back(progress.body() ? std::optional(*progress.body()) : std::nullopt);
      }
      turning.check(bodies, rest.now);
    }
    for (std::size_t i = 0; i < overlaps.size(); ++i) {
      const Overlap& overlap = overlaps[i];
      image::require(
          rest.bodies.before(overlap.a, overlap.b) && std::max(overlap.a, overlap.b) < rest.bodies.elsewhere.slots,
          "overlaps", i, "is not of two bodies");
      image::require(image::is_past(overlap.passes_at, rest.now), "overlaps", i, "passes at a time after now");
    }
  }
};

}  // namespace kds::collision
