// Bodies of a kinetic grid that ignore each other, and what it learns from bodies that are removed.
#include "collision/broad_phase/kinetic_grid.hpp"
#include "collision/degrees.hpp"

#include <algorithm>

namespace kds::collision {

/// Finds the body's filter, or makes it, in the place of one that no body has any more. Precondition: the body is not
/// in the grid.
template <int Degree>
void KineticGrid<Degree>::join_filter(BodySlot id, const PairListener& listener) {
  std::size_t i = 0;
  if (listener.filters()) {
    const std::uint64_t number = listener.filter_of(id);
    const auto begin = filters_.begin() + 1;
    auto place = std::find_if(begin, filters_.end(), [&](const Filter& f) { return f.used && f.number == number; });
    if (place == filters_.end()) {
      place = std::find_if(begin, filters_.end(), [](const Filter& f) { return f.bodies == 0; });
      if (place != filters_.end()) *place = Filter{.number = number, .used = true};
    }
    if (place != filters_.end()) i = static_cast<std::size_t>(place - filters_.begin());
  }
  Filter& filter = filters_[i];
  ++filter.bodies;
  bodies_[id].filter = static_cast<std::uint8_t>(i) & 0x7f;
  fat_boxes_.set_kind(id, filter.kind);
}

/// The body has been removed. Bodies that live for a few boxes only would never find a good travel by themselves, so it
/// is handed on: it adapts as in adapt_travel(), from body to body, but is no longer than twice the way of a life.
template <int Degree>
void KineticGrid<Degree>::leave_filter(BodySlot id, double now) {
  const Body& body = bodies_[id];
  Filter& filter = filters_[body.filter];
  --filter.bodies;
  if (body.expiry == never) return;
  constexpr double part = 0.125;  // of a body in the mean of those before
  constexpr double ways = 2;      // so that few lives need a second box
  const double way = body.way_until(now);
  const double travel = std::min({body.travel * travel_factor(body.begun), ways * way, greatest_travel});
  if (travel > 0) filter.travel += (filter.travel > 0 ? part : 1) * (travel - filter.travel);
}

/// Gives filters whose bodies are found near each other in vain kinds of their own, as long as there are any. All other
/// bodies have kind 0, and meet all.
template <int Degree>
void KineticGrid<Degree>::separate(const PairListener& listener) {
  in_vain_ = false;
  bool changed = false;
  for (Filter& filter : filters_) {
    if (&filter == &filters_[0] || filter.kind != 0 || !much_in_vain(filter)) continue;
    BoxGrid::Kind kind = 1;
    const auto holder = [&] {
      return std::find_if(filters_.begin(), filters_.end(), [&](const Filter& f) { return f.kind == kind; });
    };
    while (kind < BoxGrid::kinds && holder() != filters_.end() && holder()->bodies > 0) ++kind;
    filter.boxes = filter.in_vain = 0;
    if (kind == BoxGrid::kinds) continue;
    if (holder() != filters_.end()) holder()->kind = 0;
    filter.kind = kind;
    changed = true;
  }
  if (!changed) return;
  std::uint8_t used = 1;
  for (const Filter& filter : filters_) used |= static_cast<std::uint8_t>(1u << filter.kind);
  BoxGrid::Meetings meetings{};
  for (BoxGrid::Kind kind = 0; kind < BoxGrid::kinds; ++kind) meetings[kind] = (used >> kind & 1) != 0 ? used : 0;
  for (const Filter& a : filters_) {
    for (const Filter& b : filters_) {
      if (a.kind == 0 || b.kind == 0 || listener.filters_meet(a.number, b.number)) continue;
      meetings[a.kind] &= static_cast<std::uint8_t>(~(1u << b.kind));
    }
  }
  fat_boxes_.change_kinds(meetings, [&](BodySlot id) { return filters_[bodies_[id].filter].kind; });
}

#define KDS_INSTANTIATE(degree) KDS_TEMPLATE_PART class KineticGrid<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
