// The meshes of a world that bend and may meet themselves.
#pragma once

#include "collision/motions.hpp"
#include "collision/narrow_phase/contact.hpp"
#include "collision/world/bodies.hpp"
#include "collision/world/clock.hpp"
#include "collision/world/image_tools.hpp"
#include "collision/world/world_part.hpp"
#include "kds/events/dary_queue.hpp"

#include <cstddef>
#include <vector>

namespace kds::collision {

/// For each body that asks for it (BodyDescription::self_contacts), whether it touches itself, and when that changes
/// next. Times are functions of the body's script alone (narrow_phase/self_contact.hpp).
///
/// Cost: nothing for other bodies.
template <class Motion>
class SelfContacts {
 public:
  static constexpr Stage stage = Stage::reported;

  SelfContacts(const Bodies<Motion>& bodies, const Clock& clock)
      : bodies_(bodies), clock_(clock), times_(BodyRank{&bodies.keys()}) {}

  /// A body has entered. True if it touches itself.
  bool enter(BodySlot slot);
  /// Its script has changed.
  void changed(BodySlot slot) {
    if (follows(slot)) find_next(slot);
  }
  void remove(BodySlot slot);

  bool touching(BodySlot slot) const { return slot < touching_.size() && touching_[slot]; }

  /// When the next contact begins or ends.
  double next_time() const { return times_.empty() ? never : times_.top().time; }
  static constexpr bool certify() { return false; }
  /// A body begins to touch itself, or ceases to.
  struct Event {
    BodySlot slot;
    bool separates;
  };
  /// Precondition: next_time() is the time of the clock.
  Event take_next();
  /// Where a body touches itself now, in world coordinates.
  Contact contact(BodySlot slot) const;

  void extend_horizon();
  /// Throws AuditFailure if a state is not that of the vertices just after t. Precondition: nothing is due until then.
  void audit(double t) const;

  /// All of it, as plain data: times are functions of the scripts.
  struct Image {
    std::vector<char> touching;  ///< by body, up to the last that has asked for it

    template <class Archive>
    void archive(Archive& archive) {
      archive(touching);
    }
    /// Throws std::runtime_error, naming what is wrong.
    void check(const typename Bodies<Motion>::Image& bodies, double now, const WorldOptions& options) const;
  };
  Image image() const { return {touching_}; }
  /// Precondition: the bodies have been loaded.
  void become(const Image& image);

 private:
  bool follows(BodySlot slot) const { return bodies_.entered(slot) && bodies_[slot].self_contacts; }
  void find_next(BodySlot slot);

  const Bodies<Motion>& bodies_;
  const Clock& clock_;
  std::vector<char> touching_;  ///< by body
  DaryQueue<BodyRank> times_;   ///< slots are bodies
};

#define KDS_DECLARE(motion) extern template class SelfContacts<motion>;
KDS_FOR_ALL_MOTIONS(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
