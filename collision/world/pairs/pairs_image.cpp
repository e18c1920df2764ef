// The pairs of a world as plain data: written, read and checked.
#include "collision/motions.hpp"
#include "collision/world/bodies_image.hpp"
#include "collision/world/image_tools.hpp"
#include "collision/world/pairs/pairs.hpp"
#include "kds/framework/snapshot.hpp"

#include <algorithm>
#include <utility>

namespace kds::collision {

template <class Motion>
typename Pairs<Motion>::Image Pairs<Motion>::image() const {
  Image image;
  for (Slot slot = 0; slot < pairs_.size(); ++slot) {
    if (!pairs_[slot].alive) continue;
    const double boxes = slot < boxes_.slots() ? boxes_.time(slot) : never;
    image.pairs.push_back({pairs_[slot], contacts_.time(slot), boxes});
  }
  std::sort(image.pairs.begin(), image.pairs.end(),
            [](const auto& x, const auto& y) { return std::pair(x.pair.a, x.pair.b) < std::pair(y.pair.a, y.pair.b); });
  image.edits = edits_.image(clock_.now);
  return image;
}

template <class Motion>
void Pairs<Motion>::become(const Image& image) {
  pairs_.clear(), free_.clear(), dirty_.clear(), found_.clear(), apart_.clear(), links_.clear();
  of_.assign(bodies_.slots(), {});
  unlisted_ = 0;
  begin_ = Begin::moving;
  edits_.become(image.edits, clock_.now);
  contacts_.resize(0), boxes_.resize(0);
  contacts_.resize(image.pairs.size());
  if (follows_boxes_) boxes_.resize(image.pairs.size());
  for (const auto& from : image.pairs) {
    const auto slot = static_cast<Slot>(pairs_.size());
    Pair& pair = pairs_.emplace_back(from.pair);
    pair.alive = true, pair.dirty = false;
    link(slot);
    contacts_.set(slot, from.contact);
    if (slot < boxes_.slots()) boxes_.set(slot, from.boxes);
    if (from.pair.dirty) mark_dirty(slot);
    unlisted_ += pair.listed ? 0 : 1;
  }
}

template <class Motion>
void Pairs<Motion>::clear() {
  become({});
  of_.clear(), estimates_.clear(), links_ = {};
  pairs_.shrink_to_fit(), found_.shrink_to_fit(), dirty_.shrink_to_fit(), free_.shrink_to_fit();
  of_.shrink_to_fit(), estimates_.shrink_to_fit(), apart_.shrink_to_fit();
}

template <class Motion>
void Pairs<Motion>::fit() {
  const Image all = image();
  clear();
  make_room_for(all.pairs.size());
  become(all);
}

template <class Motion>
template <class Archive>
void Pairs<Motion>::Image::archive(Archive& archive) {
  archive.each(pairs, [&](One& one) {
    Pair& p = one.pair;
    archive(p.a, p.b, p.listed, p.dirty, p.fresh, p.overlapping, p.boxes_overlap, p.estimated, p.passes_at, one.contact,
            one.boxes);
  });
  archive(edits.jumped);
  archive.each(edits.filtered, [&](InstantEdits::Filtered& one) {
    CollisionFilter& filter = one.second;
    archive(one.first, filter.category, filter.collides_with, filter.group);
  });
  archive.each(edits.ignored, [&](InstantEdits::Ignored& one) { archive(one.first, one.second); });
}

template <class Motion>
void Pairs<Motion>::Image::check(const typename Bodies<Motion>::Image& bodies, double now,
                                 const WorldOptions& options) const {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Pair& pair = pairs[i].pair;
    const auto need = [i](bool right, const char* what) { image::require(right, "pairs", i, what); };
    need(bodies.before(pair.a, pair.b) && bodies.entered(pair.a) && bodies.entered(pair.b),
         "is not of two bodies in the world");
    const auto& a = bodies.bodies[pair.a];
    const auto& b = bodies.bodies[pair.b];
    need(bodies.may_collide(pair.a, pair.b), "is of bodies that never meet");
    need(image::is_to_come(pairs[i].contact, now) && image::is_to_come(pairs[i].boxes, now), "is due before now");
    need(image::is_past(pair.passes_at, now), "passes at a time after now");
    const bool resolved = options.response != Response::none && !a.sensor && !b.sensor;
    need(pair.passes_at == -never || resolved, "passes where contacts are not resolved");
    need(pair.listed || pair.overlapping || pair.dirty, "is neither listed nor overlapping");
    if (i == 0) continue;
    const Pair& before = pairs[i - 1].pair;
    need(std::pair(before.a, before.b) < std::pair(pair.a, pair.b), "is out of order, or there twice");
  }
}

#define KDS_INSTANTIATE(motion)                                      \
  KDS_TEMPLATE_PART class Pairs<motion>;                             \
  template void Pairs<motion>::Image::archive(kds::detail::Writer&); \
  template void Pairs<motion>::Image::archive(kds::detail::Reader&);
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
