// Contacts that last, of bodies that turn: there are none.
#pragma once

#include "collision/body_motion.hpp"
#include "collision/world/bodies.hpp"
#include "collision/world/clock.hpp"
#include "collision/world/resting_contact.hpp"
#include "collision/world_options.hpp"
#include "kds/arithmetic/lattice.hpp"

#include <cstdint>
#include <optional>

namespace kds::collision {

template <class Motion>
class RestingContacts;
template <class Motion>
class RestingListener;

/// In place of RestingContacts in worlds of bodies that turn: what would come to rest there goes on bouncing, in
/// flights that are no shorter than WorldOptions::shortest_flight. It answers as a world in which nothing rests.
template <class Motion>
requires(turns<Motion>) class RestingContacts<Motion> {
 public:
  using Slot = std::uint32_t;
  using Contact = detail::RestingContact;
  static constexpr Slot none = ~Slot{0};

  using Listener = RestingListener<Motion>;  ///< told nothing

  RestingContacts(const Bodies<Motion>&, const std::optional<Walls>&, const Clock&, const Listener&) {}

  bool empty() const { return true; }
  Slot find(BodySlot, BodySlot, int = -1) const { return none; }
  bool holds(BodySlot, BodySlot, int = -1) const { return false; }
  bool carries(BodySlot) const { return false; }
  bool keeps_apart(Slot) const { return false; }
  double next_contact(BodySlot, BodySlot) const { return never; }

  void drop_all(BodySlot) {}
  void forget(BodySlot) {}
  void leave(BodySlot) {}
  void disturb(BodySlot) {}
  bool solved() const { return true; }
  void solve() {}

  double next_time() const { return never; }
  void process() {}
  void extend_horizon() {}
  void audit(double, bool) const {}

  struct Image {
    template <class Archive>
    void archive(Archive&) {}
    void check(const typename Bodies<Motion>::Image&, double, const WorldOptions&) const {}
  };
  Image image() const { return {}; }
  void become(const Image&) {}
};

}  // namespace kds::collision
