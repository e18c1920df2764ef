// What the processes that run the domains of a scene tell each other of bodies.
#pragma once

#include "collision/parallel/division.hpp"
#include "collision/parallel/motion_changes.hpp"
#include "collision/world/engine.hpp"
#include "collision/world/transfer/parcel.hpp"

#include <vector>

namespace kds::collision {

/// How near to the cell of a domain bodies of other domains have come, of which it has no copy.
struct NearestStranger {
  DomainIndex domain;
  double distance;

  template <class Archive>
  void archive(Archive& archive) {
    archive(domain, distance);
  }
};

/// What a process tells another after a step.
template <class Motion>
struct StepNews {
  std::vector<NearestStranger> nearest{};
  std::vector<DomainIndex> domains{};                        ///< those whose bodies have changed
  std::vector<std::vector<MotionChange<Motion>>> changes{};  ///< of each of them

  void add(DomainIndex domain, const MotionChange<Motion>& change) {
    if (domains.empty() || domains.back() != domain) domains.push_back(domain), changes.emplace_back();
    changes.back().push_back(change);
  }
  template <class Archive>
  void archive(Archive& archive) {
    archive(nearest, domains, changes);
  }
};

/// A body as its owner has it.
template <class Motion>
struct BodyNews {
  BodySlot number;
  BodyProgress<Motion> progress;
  typename Transfer<Motion>::Resting resting;

  template <class Archive>
  void archive(Archive& archive) {
    archive(number, progress, resting);
  }
};

/// What a process tells another when a window ends, or the scene is divided.
template <class Motion>
struct WindowNews {
  Parcel<Motion> newcomers{};  ///< that the other has not stored, and is to know
  BodyMoves moves{};
  std::vector<BodyNews<Motion>> bodies{};
  std::vector<typename Transfer<Motion>::Overlap> overlaps{};

  template <class Archive>
  void archive(Archive& archive) {
    archive(newcomers, moves, bodies, overlaps);
  }
};

}  // namespace kds::collision
