// Stands for the part Tumbling in worlds of bodies that keep their orientation, in which none precesses.
#pragma once

#include "collision/body_motion.hpp"
#include "collision/world/bodies.hpp"
#include "collision/world/world_part.hpp"
#include "collision/world_counters.hpp"
#include "collision/world_options.hpp"
#include "kds/arithmetic/lattice.hpp"

namespace kds::collision {

template <class Motion>
class Tumbling;

/// Answers as Tumbling does without bodies.
template <class Motion>
requires(!turns<Motion>) class Tumbling<Motion> {
 public:
  static constexpr Stage stage = Stage::motions;

  Tumbling(const Bodies<Motion>&, const WorldOptions&, const WorldCounters&) {}

  static void remove(BodySlot) {}
  static bool has(BodySlot) { return false; }
  static const Motion& take_up(BodySlot, const Motion& given, double) { return given; }
  static constexpr double next_time() { return never; }
  static constexpr bool certify() { return false; }
  static void extend_horizon() {}
  /// Of Tumbling: the motion that a body has from then on.
  struct Piece {
    BodySlot slot;
    Motion motion;
  };
  static Piece take_next() { return {}; }
  static bool is_alone(BodySlot) { return false; }
  static void set_unheard_until(double) {}
  static void audit(double) {}

  /// Of Tumbling: the state of a body, from which another world goes on. There is none.
  struct Progress {
    template <class Archive>
    void archive(Archive&) {}
    friend bool same_bits(const Progress&, const Progress&) { return true; }
  };
  static Progress progress(BodySlot) { return {}; }
  static void take_in(BodySlot, const Tumbling&, BodySlot) {}
  static void go_on_from(BodySlot, const Progress&) {}
  static void go_on() {}

  /// Of Tumbling: all of it, as plain data. There is none.
  struct Image : NoImage {};
  static Image image() { return {}; }
  static void become(const Image&) {}
};

}  // namespace kds::collision
