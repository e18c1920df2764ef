// The cells into which segments that grow have divided the plane by a time.
#pragma once

#include "certificates/arrival.hpp"
#include "kds/framework/moving_set.hpp"
#include "structures/growing_segments.hpp"
#include "structures/plane_cells.hpp"
#include "structures/track_box.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace kds::structures {

namespace detail {

inline DirectedLine line_of(const certificates::PlaneMotion<1>& path) {
  return {{path.coordinate[0].c[0], path.coordinate[1].c[0]}, {path.coordinate[0].c[1], path.coordinate[1].c[1]}};
}
/// The path at its start plus elapsed / w, for any number type.
template <class Number>
RatioPoint<Number> point_of(const DirectedLine& line, const Number& elapsed, const Number& w) {
  return {Number(line.point[0]) * w + Number(line.direction[0]) * elapsed,
          Number(line.point[1]) * w + Number(line.direction[1]) * elapsed, w};
}
inline LinePoint beginning_of(const certificates::PlaneMotion<1>& path) {
  return LinePoint([&]<class Number>() { return point_of(line_of(path), Number(0.0), Number(1.0)); });
}
inline LinePoint place_of(const certificates::PlaneMotion<1>& path, double t) {
  return LinePoint(
      [&]<class Number>() { return point_of(line_of(path), Number(t) - Number(path.start), Number(1.0)); });
}
/// Where an end has come to a track.
inline LinePoint place_of(const certificates::Arrival& arrival) {
  using At = certificates::Arrival::At;
  const DirectedLine end = line_of(arrival.end), track = line_of(arrival.track);
  if (arrival.at == At::line) return LinePoint::crossing(end, track);
  if (arrival.at == At::beginning) return beginning_of(arrival.track);
  // Both are in one place: p + v s = q + u (s + start of the end - start of the track), s the time since the former.
  const auto d = static_cast<std::size_t>(certificates::Arrival::axis(arrival.end));
  return LinePoint([&]<class Number>() {
    const Number apart = Number(track.point[d]) - Number(end.point[d]);
    const Number later = Number(arrival.end.start) - Number(arrival.track.start);
    return point_of(end, apart + Number(track.direction[d]) * later,
                    Number(end.direction[d]) - Number(track.direction[d]));
  });
}

}  // namespace detail

/// The subdivision of the plane by the tracks of all ends, as far as these have come at `now`, and by the whole lines;
/// the dividers have the ids of the ends. An end that has not begun, or that rests, divides nothing. Two ends that
/// begin at one point make a segment with a vertex there.
///
/// Precondition: `segments` is the state at `now`, so all events up to then are over. Throws nothing of its own. Cost:
/// PlaneCells.
inline PlaneCells cells_of(const GrowingSegmentsRule& segments, const MovingSet<GrowingEnd>& ends, double now) {
  std::vector<Divider> dividers;
  for (const Id id : ends.ids()) {
    const auto& [path, whole] = ends[id];
    const DirectedLine line = detail::line_of(path);
    if (whole) {
      dividers.push_back({id, line});
      continue;
    }
    if (path.start >= now) continue;
    const bool stopped = segments.stopped_by(id) != nobody;
    const double until = std::min(now, segments.stop_time(id));
    const std::array<LinePoint, 2> points{
        detail::beginning_of(path), stopped ? detail::place_of(segments.stopped_at(id)) : detail::place_of(path, now)};
    dividers.push_back({id, line, points, TrackBox::of(path, until).at(until)});
  }
  return PlaneCells(std::move(dividers));
}

}  // namespace kds::structures
