#include "collision/world/scripts.hpp"

#include "collision/degrees.hpp"
#include "collision/world/queue_room.hpp"

namespace kds::collision {

template <int Degree>
void Scripts<Degree>::add(BodySlot id, std::span<const Motion> pieces) {
  if (pieces.empty()) return;
  make_room(starts_, id + std::size_t{1});
  if (scripts_.size() <= id) scripts_.resize(id + std::size_t{1});
  scripts_[id].assign(pieces.rbegin(), pieces.rend());
  starts_.set(id, pieces.front().start);
}

template <int Degree>
void Scripts<Degree>::clear(BodySlot id) {
  if (id >= scripts_.size() || scripts_[id].empty()) return;
  scripts_[id] = {};
  starts_.clear(id);
}

template <int Degree>
std::vector<typename Scripts<Degree>::Piece> Scripts<Degree>::take_next() {
  std::vector<Piece> pieces;
  const double t = next_time();
  while (!starts_.empty() && starts_.top().time == t) {
    const BodySlot id = starts_.top().slot;
    auto& script = scripts_[id];
    pieces.push_back({id, script.back()});
    script.pop_back();
    if (script.empty()) {
      starts_.clear(id);
    } else {
      starts_.set(id, script.back().start);
    }
  }
  return pieces;
}

template <int Degree>
void Scripts<Degree>::become(const Image& image) {
  scripts_ = image.of;
  starts_.resize(0);
  starts_.resize(scripts_.size());
  for (BodySlot id = 0; id < scripts_.size(); ++id) {
    if (!scripts_[id].empty()) starts_.set(id, scripts_[id].back().start);
  }
}

#define KDS_INSTANTIATE(degree) template class Scripts<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
