// Bodies on their way from one process to another.
#pragma once

#include "collision/world/bodies_image.hpp"
#include "collision/world/resting/resting_contacts.hpp"
#include "collision/world/turning/tumbling.hpp"

#include <memory>
#include <vector>

namespace kds::collision {

/// The whole state of some bodies without what connects them: attachments and ignored pairs. Meshes are not sent: the
/// reader of a parcel has the same list of meshes as its writer, and puts it into `bodies.meshes` before.
template <class Motion>
struct Parcel {
  std::vector<BodySlot> numbers{};
  typename Bodies<Motion>::Image bodies{};  ///< as image_of()
  // In the same order:
  std::vector<std::vector<Motion>> to_come{};  ///< pieces of motion, the last first
  std::vector<typename Tumbling<Motion>::Progress> turning{};
  std::vector<typename RestingPart<Motion>::Progress> resting{};

  bool empty() const { return numbers.empty(); }
  template <class Archive>
  void archive(Archive& archive) {
    archive(numbers);
    bodies.archive_bodies(archive);
    archive(to_come);
    if constexpr (turns<Motion>) archive(turning);
    archive(resting);
  }
};

}  // namespace kds::collision
