#include "collision/world/scripts.hpp"

#include "collision/degrees.hpp"
#include "collision/world/queue_room.hpp"

namespace kds::collision {

template <int Degree>
void Scripts<Degree>::add(BodySlot slot, std::span<const Motion> pieces) {
  if (pieces.empty()) return;
  make_room(starts_, slot + std::size_t{1});
  if (scripts_.size() <= slot) scripts_.resize(slot + std::size_t{1});
  scripts_[slot].assign(pieces.rbegin(), pieces.rend());
  starts_.set(slot, pieces.front().start);
}

template <int Degree>
void Scripts<Degree>::clear(BodySlot slot) {
  if (slot >= scripts_.size() || scripts_[slot].empty()) return;
  scripts_[slot] = {};
  starts_.clear(slot);
}

template <int Degree>
std::vector<typename Scripts<Degree>::Piece> Scripts<Degree>::take_next() {
  std::vector<Piece> pieces;
  const double t = next_time();
  while (!starts_.empty() && starts_.top().time == t) {
    const BodySlot slot = starts_.top().slot;
    auto& script = scripts_[slot];
    pieces.push_back({slot, script.back()});
    script.pop_back();
    if (script.empty()) {
      starts_.clear(slot);
    } else {
      starts_.set(slot, script.back().start);
    }
  }
  return pieces;
}

template <int Degree>
void Scripts<Degree>::become(const Image& image) {
  scripts_ = image.of;
  starts_.resize(0);
  starts_.resize(scripts_.size());
  for (BodySlot slot = 0; slot < scripts_.size(); ++slot) {
    if (!scripts_[slot].empty()) starts_.set(slot, scripts_[slot].back().start);
  }
}

#define KDS_INSTANTIATE(degree) template class Scripts<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
