// Islands of which a world has some bodies as copies.
#pragma once

#include "collision/body_id.hpp"

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace kds::collision {

/// In a world whose bodies belong to another one (transfer.cpp), and which may have some of them as copies: the islands
/// that have own bodies and copies. All bodies of these are *shared*, from when they become one until begin() is called
/// again. So of an island either all bodies are shared, or all are own ones, or all are copies.
class SharedIslands {
 public:
  /// Which bodies are the world's own.
  void set_owned(std::function<bool(BodySlot)> owned) { owned_ = std::move(owned); }
  /// Whether there may be copies.
  bool any_copies() const { return owned_ != nullptr; }

  void begin() { shared_.clear(), newly_shared_.clear(), concerned_.clear(); }
  bool is_shared(BodySlot slot) const { return slot < shared_.size() && shared_[slot]; }
  /// Two bodies that are not fixed belong to one island, or what the one does depends on the island of the other.
  /// `island_of`: gives the bodies of the island of a body. Precondition: any_copies().
  template <class IslandOf>
  void link(BodySlot a, BodySlot b, const IslandOf& island_of) {
    if (!is_shared(a) && !is_shared(b) && owned_(a) == owned_(b)) return;
    share(a, island_of), share(b, island_of);
  }
  /// Something happens to an island of shared bodies.
  void concern(std::vector<BodySlot> island) { concerned_.push_back(std::move(island)); }

  /// The copies that have come to be shared since this was called last.
  std::vector<BodySlot> take_shared() { return std::exchange(newly_shared_, {}); }
  /// The islands that something has happened to since this was called last, some several times.
  std::vector<std::vector<BodySlot>> take_concerned() { return std::exchange(concerned_, {}); }

 private:
  template <class IslandOf>
  void share(BodySlot slot, const IslandOf& island_of) {
    if (is_shared(slot)) return;
    for (const BodySlot each : island_of(slot)) {
      if (shared_.size() <= each) shared_.resize(each + std::size_t{1});
      if (std::exchange(shared_[each], char{1}) == 0 && !owned_(each)) newly_shared_.push_back(each);
    }
  }

  std::function<bool(BodySlot)> owned_;  ///< null: all are
  std::vector<char> shared_;             ///< by body
  std::vector<BodySlot> newly_shared_;
  std::vector<std::vector<BodySlot>> concerned_;
};

}  // namespace kds::collision
