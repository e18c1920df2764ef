#include "collision/world/scripts.hpp"

#include "collision/motions.hpp"
#include "collision/world/queue_room.hpp"
#include "kds/audit.hpp"

#include <algorithm>
#include <string>

namespace kds::collision {

template <class Motion>
void Scripts<Motion>::add(BodySlot slot, std::span<const Motion> pieces) {
  if (pieces.empty()) return;
  make_room(starts_, slot + std::size_t{1});
  if (scripts_.size() <= slot) scripts_.resize(slot + std::size_t{1});
  scripts_[slot].assign(pieces.rbegin(), pieces.rend());
  starts_.set(slot, path_of(pieces.front()).start);
}

template <class Motion>
void Scripts<Motion>::take_in(BodySlot slot, const Scripts& from, BodySlot of) {
  const auto pieces = from.to_come(of);
  if (pieces.empty()) return;
  add(slot, {&pieces.back(), 1});
  scripts_[slot].assign(pieces.begin(), pieces.end());
}

template <class Motion>
void Scripts<Motion>::append(BodySlot slot, std::span<const Motion> pieces) {
  if (last_start(slot) == -never) return add(slot, pieces);
  scripts_[slot].insert(scripts_[slot].begin(), pieces.rbegin(), pieces.rend());
}

template <class Motion>
void Scripts<Motion>::clear(BodySlot slot) {
  if (slot >= scripts_.size() || scripts_[slot].empty()) return;
  scripts_[slot] = {};
  starts_.clear(slot);
}

template <class Motion>
void Scripts<Motion>::audit(double t) const {
  for (BodySlot slot = 0; slot < scripts_.size(); ++slot) {
    const auto need = [slot](bool right, const char* what) {
      if (!right) throw AuditFailure("World: the script of the body in slot " + std::to_string(slot) + ": " + what);
    };
    const auto& script = scripts_[slot];
    const double next = script.empty() ? never : path_of(script.back()).start;
    need(next >= t, "a piece should have begun");
    need(starts_.time(slot) == next, "the start of its next piece is not in the queue");
    const auto later = [](const Motion& a, const Motion& b) { return path_of(a).start > path_of(b).start; };
    need(std::is_sorted(script.begin(), script.end(), later), "its pieces are out of order");
  }
}

template <class Motion>
void Scripts<Motion>::become(const Image& image) {
  scripts_ = image.of;
  starts_.resize(0);
  starts_.resize(scripts_.size());
  for (BodySlot slot = 0; slot < scripts_.size(); ++slot) {
    if (!scripts_[slot].empty()) starts_.set(slot, path_of(scripts_[slot].back()).start);
  }
}

#define KDS_INSTANTIATE(motion) template class Scripts<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
