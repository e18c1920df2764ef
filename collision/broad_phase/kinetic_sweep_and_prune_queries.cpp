// The queries of kinetic sweep and prune.
#include "collision/broad_phase/kinetic_sweep_and_prune.hpp"
#include "collision/broad_phase/swept_box.hpp"
#include "collision/degrees.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace kds::collision {

/// How many ends of the sweep list are below x just after now. Precondition: no event is due.
template <int Degree>
std::size_t KineticSweepAndPrune<Degree>::ends_below(double x, double now) const {
  const auto ends = sweep_list().entries();
  if (x == -never) return 0;
  if (x == never) return ends.size();
  Motion<Degree> there{};
  there.position.c[0] = x;
  there.start = now;
  const auto below = [&](const typename List::Entry& end) {
    const certificates::Order<Degree> order{end.motion, there};
    const int sign = order.quick_sign(now);
    return (sign != 0 ? sign : sign_after(order, now)) > 0;
  };
  return static_cast<std::size_t>(std::partition_point(ends.begin(), ends.end(), below) - ends.begin());
}

template <int Degree>
void KineticSweepAndPrune<Degree>::visit_overlapping(const StaticBox& box, double now, SlotVisitor visit) const {
  const auto look = [&](BodySlot id) {
    if (box_at(unlisted_.box(id), now).overlaps(box)) visit(id);
  };
  const List& list = sweep_list();
  const auto ends = list.entries();
  if (next_time() <= now) {  // the list may be out of order
    for (const auto& end : ends) {
      if (is_min(end.id)) look(end.id / 2);
    }
    return;
  }
  const auto d = static_cast<Eigen::Index>(sweep_axis_);
  const std::array<double, 2> span =
      sweep_axis_ < 3 ? std::array{box.min[d], box.max[d]} : span_along(kdops_.directions[sweep_axis_ - 3], box);
  // The list is in the order just after now, when intervals that touch now may have parted: so the next doubles
  // outward.
  constexpr double largest = std::numeric_limits<double>::max();
  const std::size_t first = ends_below(next_down(std::clamp(span[0], -largest, largest)), now);
  const std::size_t last = ends_below(next_up(std::clamp(span[1], -largest, largest)), now);
  for (std::size_t i = first; i < last; ++i) {
    const std::uint32_t end = ends[i].id;
    const std::size_t other = list.position(end ^ 1);
    if (is_min(end) || other < first || other >= last) look(end / 2);
  }
  // Those that are open on both sides of the stretch.
  const bool all = inverted_ > 0 || all_listed();  // then their number is not known
  std::int32_t open = first > 0 && !all ? open_[first - 1] : 0;
  for (std::size_t i = first; i-- > 0 && (all || open > 0);) {
    const std::uint32_t end = ends[i].id;
    if (!is_min(end)) continue;
    const std::size_t other = list.position(end ^ 1);
    open -= other >= first;
    if (other >= last) look(end / 2);
  }
}

template <int Degree>
void KineticSweepAndPrune<Degree>::visit_swept(const KineticBox<Degree>& box, double from, double until,
                                               SlotVisitor visit) const {
  const StaticBox swept = bounded_swept_box(box, from, until);
  using Hull = typename UnlistedAxes<Degree>::Hull;
  const bool hulls = !all_listed() && until <= horizon_;  // the hulls of bodies are valid until the horizon
  const Hull hull = hulls ? unlisted_.hull_of(swept) : Hull::everywhere();
  for (const auto& end : sweep_list().entries()) {
    const BodySlot id = end.id / 2;
    if (!is_min(end.id) || (hulls && !hull.meets(unlisted_.hull(id)))) continue;
    if (bounded_swept_box(unlisted_.box(id), from, until).overlaps(swept)) visit(id);
  }
}

#define KDS_INSTANTIATE(degree) KDS_TEMPLATE_PART class KineticSweepAndPrune<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
