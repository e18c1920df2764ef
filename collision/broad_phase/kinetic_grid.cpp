#include "collision/broad_phase/kinetic_grid.hpp"

#include "collision/degrees.hpp"
#include "kds/audit.hpp"

#include <algorithm>
#include <string>

namespace kds::collision {
namespace {

constexpr double much_slower = 0.25;

}  // namespace

/// `a`: the body whose fat box is new. The pair does not count for the travel of the other one if that is far slower:
/// it would begin whatever that is.
template <int Degree>
inline void KineticGrid<Degree>::report_pair(BodySlot a, BodySlot b, double now, PairListener& listener) {
  Body& first = bodies_[a];
  Body& second = bodies_[b];
  first.add_partner();
  second.add_partner();
  count_one(first.begun);
  count_one(second.speed >= much_slower * first.speed ? second.begun : second.in_vain);
  listener.pair_began(std::min(a, b), std::max(a, b), now);
}

/// Sorts changes in the order of bodies, independent of the cells in which they were found.
template <int Degree>
void KineticGrid<Degree>::report(BodySlot id, BoxGrid::Changes& changes, double now, PairListener& listener) {
  if (changes.empty()) return;
  if (changes.ended.size() > 1) std::sort(changes.ended.begin(), changes.ended.end());
  if (changes.began.size() > 1) std::sort(changes.began.begin(), changes.began.end());
  const bool filters = listener.filters();
  for (const BodySlot other : changes.ended) {
    if (filters && !listener.may_collide(id, other)) continue;
    bodies_[id].drop_partner();
    bodies_[other].drop_partner();
    listener.pair_ended(std::min(id, other), std::max(id, other), now);
  }
  for (const BodySlot other : changes.began) {
    if (filters && !listener.may_collide(id, other)) {
      count_one(bodies_[id].in_vain);
      Filter& filter = filters_[bodies_[id].filter];
      if (bodies_[other].filter != bodies_[id].filter || filter.kind != 0) continue;
      ++filter.in_vain;
      in_vain_ = in_vain_ || much_in_vain(filter);
    } else {
      report_pair(id, other, now, listener);
    }
  }
}

/// An earlier entry stays in the queue: most boxes are replaced again before it is due.
template <int Degree>
void KineticGrid<Degree>::set_expiry(BodySlot id, double expiry, double now) {
  if (expiry_.contains(id) && expiry_.time(id) > now && expiry_.time(id) <= expiry) return;
  expiry_.set(id, expiry <= horizon_ ? expiry : never);
}

template <int Degree>
void KineticGrid<Degree>::extend_horizon(double now, double horizon) {
  horizon_ = horizon;
  visit([&](BodySlot id) { set_expiry(id, bodies_[id].expiry, now); });
}

/// The part of its fat box that a body uses, if it is small: the box is long, and nothing has changed the motion of the
/// body for some time.
template <int Degree>
inline std::optional<BoxSlant> KineticGrid<Degree>::slant(const Body& body, const KineticBox<Degree>& kinetic,
                                                          const StaticBox& present) const {
  if constexpr (Degree == 1) {
    // (The second condition follows from the next, and costs less.)
    if (body.jostled == 0 && body.travel > tuning_.slanted_at * 2 * kinetic.rounding &&
        body.travel > tuning_.slanted_at * present.extent() && corners_move_alike(kinetic) &&
        BoxSlant::pays(present, kinetic.min.coefficients[1])) {
      return BoxSlant(present, kinetic.min.coefficients[1]);
    }
  }
  return std::nullopt;
}

/// Appends the partners of a body, if the listener knows them.
template <int Degree>
bool KineticGrid<Degree>::ended_pairs(BodySlot id, BoxGrid::Ids& ended, const PairListener& listener) {
  const auto append = [&](BodySlot other) { ended.push_back(other); };
  return listener.visit_pairs(id, append);
}

/// True if its fat box has begun or ceased to overlap others.
template <int Degree>
bool KineticGrid<Degree>::renew(BodySlot id, const KineticBox<Degree>& kinetic, const BoxSweep<Degree>& sweep,
                                const StaticBox& present, double now, PairListener& listener) {
  ++counters_.box_updates;
  Body& body = bodies_[id];
  ++filters_[body.filter].boxes;
  const FatBox fat = fat_box(id, kinetic, sweep, present, now);
  body.begin_life(fat.expiry, now);
  set_expiry(id, fat.expiry, now);
  BoxGrid::Changes changes;
  const std::optional<BoxSlant> part = slant(body, kinetic, present);
  // Long boxes are far apart, so one search does not find what overlaps either; and boxes near long ones have to be
  // compared with many of them, so it pays to do it once.
  const bool alone =
      body.partners == 0 || ((part || fat_boxes_.any_slanted()) && ended_pairs(id, changes.ended, listener));
  fat_boxes_.put(id, fat.box, changes, kinetic.rounding, alone, part ? &*part : nullptr);
  if (alone && body.partners > 0) changes.leave_out_common();
  report(id, changes, now, listener);
  if (in_vain_) separate(listener);
  return !changes.empty();
}

template <int Degree>
void KineticGrid<Degree>::remove(BodySlot id, double now, PairListener& listener) {
  BoxGrid::Changes changes;
  const bool alone = bodies_[id].partners == 0 || ended_pairs(id, changes.ended, listener);
  fat_boxes_.remove(id, changes, alone);
  expiry_.clear(id);
  report(id, changes, now, listener);
  leave_filter(id, now);
}

template <int Degree>
void KineticGrid<Degree>::update(BodySlot id, const KineticBox<Degree>& box, double now, PairListener& listener) {
  Body& body = bodies_[id];
  const bool less_rounded = kept_rounding(box.rounding) < fat_boxes_.rounding(id);  // than the old fat box
  body.changed = true;
  add_up_to_most(body.tests, body.partners);
  // The old fat box often remains valid for a while.
  const BoxSweep<Degree> sweep(box, now);
  const StaticBox present = sweep.begin();
  if (!less_rounded) {
    const double expiry = kept_until(id, box, sweep, present, now);
    if (expiry > now) {
      body.begin_life(expiry, now - body.age(now));
      return set_expiry(id, expiry, now);
    }
  }
  adapt_travel(id, now);
  renew(id, box, sweep, present, now, listener);
}

/// What the renewals of the day after the next need.
template <int Degree>
void KineticGrid<Degree>::prefetch_coming(const PairListener& listener) const {
  const auto of_next_day = [](BodySlot) {};
  expiry_.look_ahead(of_next_day, [this, &listener](BodySlot id) {
    prefetch(id);
    listener.prefetch(id);
  });
}

template <int Degree>
bool KineticGrid<Degree>::advance(double limit, PairListener& listener) {
  while (!expiry_.empty()) {
    const auto [time, id] = expiry_.top();
    if (time > limit) return false;
    if (size() > more_than_caches) prefetch_coming(listener);
    if (bodies_[id].expiry > time) {
      set_expiry(id, bodies_[id].expiry, time);
      continue;
    }
    adapt_travel(id, time);
    const KineticBox<Degree> box = box_of_(id);
    const BoxSweep<Degree> sweep(box, time);
    if (renew(id, box, sweep, sweep.begin(), time, listener)) return true;
  }
  return false;
}

template <int Degree>
void KineticGrid<Degree>::visit_overlapping(const StaticBox& box, double, SlotVisitor visit) const {
  BoxGrid::Ids found;
  fat_boxes_.find_overlapping(box, found);
  for (const BodySlot id : found) visit(id);
}

/// If a fat box is valid until then it bounds its body; for the others their motions are swept.
template <int Degree>
void KineticGrid<Degree>::visit_swept(const KineticBox<Degree>& box, double from, double until,
                                      SlotVisitor visit) const {
  const StaticBox swept = bounded_swept_box(box, from, until);
  BoxGrid::Ids found;
  fat_boxes_.find_overlapping(swept, found);
  for (const BodySlot id : found) {
    if (bodies_[id].expiry >= until) visit(id);
  }
  const auto look = [&](BodySlot id) {
    if (bodies_[id].expiry < until && bounded_swept_box(box_of_(id), from, until).overlaps(swept)) visit(id);
  };
  if (until <= horizon_) return expiry_.visit_until(until, look);
  this->visit(look);
}

template <int Degree>
void KineticGrid<Degree>::audit(double now) const {
  for (BodySlot id = 0; id < fat_boxes_.end(); ++id) {
    if (!fat_boxes_.contains(id)) continue;
    if (bodies_[id].expiry <= now) continue;  // due
    const StaticBox present = box_at(box_of_(id), now);
    // The rounding margins differ from those of the whole span.
    const double slack = 0x1p-45 * std::max(present.min.abs().maxCoeff(), present.max.abs().maxCoeff());
    StaticBox inner = present;
    inner.min += slack;
    inner.max -= slack;
    if (!fat_boxes_.box(id).contains(inner)) {
      throw AuditFailure("KineticGrid: body " + std::to_string(id) + " is outside its fat box");
    }
  }
}

#define KDS_INSTANTIATE(degree) template class KineticGrid<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
