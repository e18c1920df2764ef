// The scripts of bodies: pieces of motion still to come.
#pragma once

#include "certificates/point_motion.hpp"
#include "collision/body_id.hpp"
#include "collision/broad_phase/kinetic_box.hpp"
#include "collision/motions.hpp"
#include "collision/world/image_tools.hpp"
#include "collision/world/world_part.hpp"
#include "kds/events/dary_queue.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace kds::collision {

/// The scripts of a world's bodies: for each body the pieces of motion to come, and the time at which the next piece of
/// any body begins.
///
/// Cost: nothing for bodies without a script; O(log n) a piece.
template <class Motion>
class Scripts {
 public:
  static constexpr Stage stage = Stage::motions;

  /// Gives a body pieces to come, in order of their starts. Precondition: it has none.
  void add(BodySlot slot, std::span<const Motion> pieces);
  /// The same after those that it has. Precondition: they start later.
  void append(BodySlot slot, std::span<const Motion> pieces);
  /// The same as those that a body of another world has there.
  void take_in(BodySlot slot, const Scripts& from, BodySlot of);
  /// The pieces to come of a body, the last first. Valid until some are added, taken or removed.
  std::span<const Motion> to_come(BodySlot slot) const {
    return slot < scripts_.size() ? std::span<const Motion>(scripts_[slot]) : std::span<const Motion>();
  }
  /// When the last piece to come of a body starts; -never if there is none.
  double last_start(BodySlot slot) const {
    return to_come(slot).empty() ? -never : path_of(to_come(slot).front()).start;
  }
  /// Removes the pieces still to come.
  void clear(BodySlot slot);

  /// When the next piece begins.
  double next_time() const { return starts_.empty() ? never : starts_.top().time; }
  static constexpr bool certify() { return false; }
  static void extend_horizon() {}

  /// The motion that a body has from then on.
  struct Piece {
    BodySlot slot;
    Motion motion;
  };
  /// Takes those that begin at next_time(), by slot: all, or so many if `divides(slot)` is true of each of their
  /// bodies.
  template <class Divides>
  std::vector<Piece> take_next(std::size_t most, const Divides& divides);
  std::vector<Piece> take_next() {
    return take_next(0, [](BodySlot) { return false; });
  }

  /// Throws AuditFailure unless the pieces of each body follow each other, and the first, at t or later, is awaited.
  void audit(double t) const;

  /// All of it, as plain data: the pieces of each body, last first.
  struct Image {
    std::vector<std::vector<Motion>> of;

    template <class Archive>
    void archive(Archive& archive) {
      archive(of);
    }
    /// Throws std::runtime_error, naming what is wrong.
    template <class BodiesImage>
    void check(const BodiesImage& bodies, double now, const WorldOptions& = {}) const;
  };
  Image image() const { return {scripts_}; }
  void become(const Image& image);

 private:
  std::vector<std::vector<Motion>> scripts_;  ///< by body, up to the last that has had one; next piece last
  DaryQueue<> starts_;                        ///< slots are bodies
};

#define KDS_DECLARE(motion) extern template class Scripts<motion>;
KDS_FOR_ALL_MOTIONS(KDS_DECLARE)
#undef KDS_DECLARE

template <class Motion>
template <class Divides>
std::vector<typename Scripts<Motion>::Piece> Scripts<Motion>::take_next(std::size_t most, const Divides& divides) {
  std::vector<Piece> pieces;
  const double t = next_time();
  bool divided = true;
  while (!starts_.empty() && starts_.top().time == t && (!divided || pieces.empty() || pieces.size() < most)) {
    const BodySlot slot = starts_.top().slot;
    divided = divided && divides(slot);
    auto& script = scripts_[slot];
    pieces.push_back({slot, script.back()});
    script.pop_back();
    if (script.empty()) {
      starts_.clear(slot);
    } else {
      starts_.set(slot, path_of(script.back()).start);
    }
  }
  return pieces;
}

template <class Motion>
template <class BodiesImage>
void Scripts<Motion>::Image::check(const BodiesImage& bodies, double now, const WorldOptions&) const {
  for (std::size_t slot = 0; slot < of.size(); ++slot) {
    const auto need = [slot](bool right, const char* what) { image::require(right, "scripts", slot, what); };
    need(of[slot].empty() || bodies.alive(static_cast<BodySlot>(slot)), "is of no body");
    double next = never;  // pieces are listed last first
    for (const Motion& piece : of[slot]) {
      need(piece.finite(), "a piece of motion to come is not finite");
      need(image::is_to_come(path_of(piece).start, now) && path_of(piece).start < next,
           "pieces of motion to come are out of order");
      next = path_of(piece).start;
    }
  }
}

}  // namespace kds::collision
