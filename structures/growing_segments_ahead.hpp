// How an end of a segment that grows finds the tracks to which it comes next: the tree of tracks.
#pragma once

#include "structures/growing_segments.hpp"
#include "structures/span_ahead.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace kds::structures {

/// Keeps the first of them, in order.
inline void GrowingSegmentsRule::keep_first(std::vector<Next>& found) {
  const auto kept = found.begin() + static_cast<std::ptrdiff_t>(std::min(found.size(), kept_ahead));
  std::partial_sort(found.begin(), kept, found.end(), is_before);
  found.erase(kept, found.end());
}

/// A box that contains the end at all times between two.
inline TreeBox<2> GrowingSegmentsRule::way(const certificates::PlaneMotion<1>& path, double from, double to) {
  const double ahead = std::nextafter(to - from, never);
  const Span x = span_ahead(path.axis(0), from, ahead), y = span_ahead(path.axis(1), from, ahead);
  return {{x.min, y.min}, {x.max, y.max}};
}

/// Calls look(id) for each end whose track may come to a place; for all ends if `place` is null.
template <class Look>
void GrowingSegmentsRule::look_at(const TrackBox::Place* place, Id id, const Look& look) const {
  const auto at = [&](Id other) {
    if (other != id) look(other);
  };
  for (const Id other : borders_) at(other);
  if (place) return tree_.visit(*place, at);
  for (Id other = 0; other < ends_.size(); ++other) {
    if (tree_.contains(other)) at(other);
  }
}

/// To be called when it is there, looks farther ahead, or has stopped.
inline void GrowingSegmentsRule::put_into_tree(Id id, const Element& element) {
  if (element.whole) return;
  tree_.contains(id) ? tree_.change(id, box_of(id, element)) : tree_.insert(id, box_of(id, element));
}
inline TrackBox GrowingSegmentsRule::box_of(Id id, const Element& element) const {
  const End& end = ends_[id];
  const TrackBox box = TrackBox::of(element.path, end.known_until);
  return end.stop ? box.stopped_at(end.time) : box;
}

/// Finds the next tracks that an end comes to after the track `after`, or if that is null after now. It searches up to
/// a time ahead, and up to a later one if it finds too few.
inline void GrowingSegmentsRule::look_ahead(Id id, const Next* after, Pen& repair) {
  const Element& element = repair[id];
  // An event at the double `now` happens between the double before and `now`. So what comes after it may come before
  // `now`.
  const double now = after ? std::nextafter(repair.now(), -never) : repair.now();
  const double begin = std::max(now, element.path.start);
  std::vector<Next> found;
  bool all = true;
  double ahead = std::max(0.5 * enough_, std::nextafter(begin, never) - begin);
  for (bool enough = element.whole; !enough; ahead *= 3) {
    const double until = begin + ahead;
    double last = until;
    std::size_t seen = 0;
    found.clear();
    all = true;
    const auto look = [&](Id other) {
      ++seen;
      if (last < never && surely_later(element, repair[other], now, last)) return;
      const std::optional<Arrival> arrival = arrival_at(element, repair[other]);
      if (!arrival || !may_stop(other, *arrival, repair.elements())) return;
      if (!after && !is_ahead(*arrival, repair.now())) return;
      const Next next(other, *arrival, repair.now());
      if (next.time <= until && (!after || is_before(*after, next))) found.push_back(next);
      if (found.size() < 4 * kept_ahead) return;
      keep_first(found);
      last = found.back().time;
      all = false;
    };
    const TrackBox::Place place{way(element.path, begin, until), until};
    look_at(until < never ? &place : nullptr, id, look);
    enough = until == never || !all || found.size() > kept_ahead;
    if (enough && until < never) enough_ = ahead;
    if (2 * seen > tree_.size()) ahead = never;  // nearly all have been looked at
  }
  End& end = ends_[id];
  end.knows_all = all && found.size() <= kept_ahead;
  keep_first(found);
  end.known_until = end.knows_all ? never : found.back().time;
  const std::size_t kept = found.size();
  end.ahead.clear();
  for (std::size_t i = kept; i-- > 0;) end.ahead.push_back(found[i].at);
  end.arrival = kept > 0 ? std::optional(found[0].arrival) : std::nullopt;
  put_into_tree(id, element);
  repair.certify(id);
}

}  // namespace kds::structures
