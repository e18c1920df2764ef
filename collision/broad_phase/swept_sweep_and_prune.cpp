#include "collision/broad_phase/swept_sweep_and_prune.hpp"

#include "collision/degrees.hpp"
#include "collision/profile.hpp"
#include "kds/audit.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace kds::collision {

template <int Degree>
SweptSweepAndPrune<Degree>::SweptSweepAndPrune(double start, double rate, Profile* profile)
    : start_(start), rate_(rate), profile_(profile), frame_end_(start) {}

template <int Degree>
bool SweptSweepAndPrune<Degree>::overlap(BodySlot a, BodySlot b) const {
  const StaticBox& x = swept_[a];
  const StaticBox& y = swept_[b];
  return x.min[0] < y.max[0] && y.min[0] < x.max[0] && x.min[1] < y.max[1] && y.min[1] < x.max[1] &&
         x.min[2] < y.max[2] && y.min[2] < x.max[2];
}

template <int Degree>
void SweptSweepAndPrune<Degree>::sweep(BodySlot id, double from) {
  ++counters_.box_updates;
  swept_[id] = swept_box(boxes_[id], from, frame_end_);
}

template <int Degree>
void SweptSweepAndPrune<Degree>::add_pair(BodySlot a, BodySlot b, Reports& reports) {
  if (!pairs_.insert(key(a, b)).second) return;
  reports.any = true;
  reports.listener.pair_began(a, b, reports.now);
}

template <int Degree>
void SweptSweepAndPrune<Degree>::drop_pair(BodySlot a, BodySlot b, Reports& reports) {
  if (pairs_.erase(key(a, b)) == 0) return;
  reports.any = true;
  reports.listener.pair_ended(a, b, reports.now);
}

template <int Degree>
void SweptSweepAndPrune<Degree>::exchange(std::size_t axis, std::size_t left, Reports& reports) {
  auto& ends = ends_[axis];
  std::swap(ends[left], ends[left + 1]);
  ++counters_.swaps;
  const std::uint32_t now_left = ends[left].id;
  const std::uint32_t now_right = ends[left + 1].id;
  places_[axis][now_left] = static_cast<std::uint32_t>(left);
  places_[axis][now_right] = static_cast<std::uint32_t>(left + 1);
  if (((now_left ^ now_right) & 1) == 0 || now_left / 2 == now_right / 2) return;
  const BodySlot a = std::min(now_left, now_right) / 2;
  const BodySlot b = std::max(now_left, now_right) / 2;
  if ((now_left & 1) != 0) {
    drop_pair(a, b, reports);  // a maximum has moved left of a minimum
  } else if (overlap(a, b)) {
    add_pair(a, b, reports);
  }
}

template <int Degree>
void SweptSweepAndPrune<Degree>::sort_axis(std::size_t axis, Reports& reports) {
  auto& ends = ends_[axis];
  for (std::size_t i = 1; i < ends.size(); ++i) {
    for (std::size_t j = i; j > 0 && before(ends[j], ends[j - 1]); --j) exchange(axis, j - 1, reports);
  }
}

template <int Degree>
void SweptSweepAndPrune<Degree>::frame(double now, Reports& reports) {
  ++frames_;
  frame_end_ = start_ + static_cast<double>(frames_) / rate_;
  {
    const Stopwatch watch(profile_, Work::update);
    for (const BodySlot id : bodies_) sweep(id, now);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (End& end : ends_[axis]) end.value = value(end.id, axis);
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) sort_axis(axis, reports);
}

template <int Degree>
bool SweptSweepAndPrune<Degree>::advance(double limit, PairListener& listener) {
  while (frame_end_ <= limit) {
    Reports reports{listener, frame_end_};
    frame(frame_end_, reports);
    if (reports.any) return true;
  }
  return false;
}

template <int Degree>
void SweptSweepAndPrune<Degree>::insert(std::span<const Entry> bodies, double now, PairListener& listener) {
  Reports reports{listener, now};
  if (frame_end_ <= now) {  // the others' boxes are not valid beyond this
    frames_ = static_cast<std::uint64_t>(std::floor((now - start_) * rate_));
    frame(now, reports);
  }
  std::vector<BodySlot> added;
  for (const Entry& body : bodies) {
    if (body.slot >= boxes_.size()) {
      boxes_.resize(body.slot + 1);
      swept_.resize(body.slot + 1);
      for (auto& places : places_) places.resize(2 * (body.slot + 1));
    }
    boxes_[body.slot] = *body.box;
    sweep(body.slot, now);
    added.push_back(body.slot);
    bodies_.push_back(body.slot);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ends_[axis].push_back({swept_[body.slot].min[axis], 2 * body.slot});
      ends_[axis].push_back({swept_[body.slot].max[axis], 2 * body.slot + 1});
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::sort(ends_[axis].begin(), ends_[axis].end(), before);
    for (std::size_t i = 0; i < ends_[axis].size(); ++i) {
      places_[axis][ends_[axis][i].id] = static_cast<std::uint32_t>(i);
    }
  }
  // One sweep along x finds all overlaps; known ones are skipped.
  std::vector<BodySlot> open;
  std::vector<std::pair<BodySlot, BodySlot>> found;
  for (const End& end : ends_[0]) {
    const BodySlot id = end.id / 2;
    if ((end.id & 1) == 0) {
      for (const BodySlot other : open) {
        if (overlap(id, other)) found.emplace_back(std::min(id, other), std::max(id, other));
      }
      open.push_back(id);
    } else if (const auto it = std::find(open.begin(), open.end(), id); it != open.end()) {
      *it = open.back();
      open.pop_back();
    }
  }
  std::sort(found.begin(), found.end());
  for (const auto& [a, b] : found) add_pair(a, b, reports);
}

template <int Degree>
void SweptSweepAndPrune<Degree>::remove(BodySlot id, double now, PairListener& listener) {
  bodies_.erase(std::find(bodies_.begin(), bodies_.end(), id));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::erase_if(ends_[axis], [id](const End& end) { return end.id / 2 == id; });
    for (std::size_t i = 0; i < ends_[axis].size(); ++i) {
      places_[axis][ends_[axis][i].id] = static_cast<std::uint32_t>(i);
    }
  }
  Reports reports{listener, now};
  for (const BodySlot other : bodies_) drop_pair(std::min(id, other), std::max(id, other), reports);
}

template <int Degree>
void SweptSweepAndPrune<Degree>::move_end(std::size_t axis, std::uint32_t id, Reports& reports) {
  auto& ends = ends_[axis];
  std::size_t i = places_[axis][id];
  ends[i].value = value(id, axis);
  for (; i > 0 && before(ends[i], ends[i - 1]); --i) exchange(axis, i - 1, reports);
  for (; i + 1 < ends.size() && before(ends[i + 1], ends[i]); ++i) exchange(axis, i, reports);
}

template <int Degree>
void SweptSweepAndPrune<Degree>::update(BodySlot id, const KineticBox<Degree>& box, double now,
                                        PairListener& listener) {
  boxes_[id] = box;
  sweep(id, now);
  Reports reports{listener, now};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Growing ends first, so that the two never pass each other.
    move_end(axis, 2 * id, reports);
    move_end(axis, 2 * id + 1, reports);
  }
}

template <int Degree>
void SweptSweepAndPrune<Degree>::visit_overlapping(const StaticBox& box, double, SlotVisitor visit) const {
  for (const BodySlot id : bodies_) {
    if (swept_[id].overlaps(box)) visit(id);
  }
}

template <int Degree>
void SweptSweepAndPrune<Degree>::visit_swept(const KineticBox<Degree>& box, double from, double until,
                                             SlotVisitor visit) const {
  const StaticBox swept = bounded_swept_box(box, from, until);
  if (until <= frame_end_) return visit_overlapping(swept, from, visit);
  for (const BodySlot id : bodies_) {
    if (bounded_swept_box(boxes_[id], from, until).overlaps(swept)) visit(id);
  }
}

template <int Degree>
void SweptSweepAndPrune<Degree>::audit(double) const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 1; i < ends_[axis].size(); ++i) {
      if (before(ends_[axis][i], ends_[axis][i - 1])) {
        throw AuditFailure("SweptSweepAndPrune: axis " + std::to_string(axis) + ", place " + std::to_string(i) +
                           ": out of order");
      }
    }
  }
}

#define KDS_INSTANTIATE(degree) template class SweptSweepAndPrune<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
