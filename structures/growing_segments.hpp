// Segments in the plane that grow until they meet others: a kinetic partition of the plane.
#pragma once

#include "certificates/arrival.hpp"
#include "kds/audit.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/roots/failure_time.hpp"
#include "structures/box_tree.hpp"
#include "structures/track_box.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kds::structures {

/// The end of a segment that begins where its path does, at the path's start, which may be still to come, and grows
/// along it. A segment that grows at both ends is two of these, with opposite velocities. A `whole` one is its whole
/// line at all times: a border.
struct GrowingEnd {
  static constexpr int degree = 1;
  certificates::PlaneMotion<1> path;
  bool whole = false;

  bool finite() const { return path.finite(); }
  friend bool operator==(const GrowingEnd&, const GrowingEnd&) = default;

  template <class Archive>
  void archive(Archive& archive) {
    archive(path, whole);
  }
};

/// An end has come to the track of another, and stays there.
struct GrowingStop {
  Id end, at;

  friend bool operator==(const GrowingStop&, const GrowingStop&) = default;
};

/// Keeps which ends of segments still grow, and where the others have come to the track of another: in the end the
/// segments divide the plane. (The same as a motorcycle graph: [Eppstein99].)
///
/// Law: an end stops at the first point of its line that another has reached before it, or at the same time; the
/// other's track reaches from the start of its path to where it has stopped, that point included. Two ends that come to
/// one point at one time both stop. What comes first is decided exactly, also between times that are equal as doubles.
/// An end that is inserted does not stop those that have passed the point already; a pair that crosses then grows on,
/// both. On one line ends stop where they face each other, or at another's beginning. An end that has stopped stays
/// where it is, also when the segment that stopped it is removed; an end with a new motion begins anew.
///
/// Each growing end has one certificate, that it has not reached the next line that another will have crossed before
/// it. When it has, either the other has stopped short of there, and the next line takes its place (an internal event),
/// or the end stops (external). An end keeps the next four arrivals in order. They are searched in a tree of the boxes
/// of tracks (TrackBox), which grow, up to a time that is far enough ahead. Cost: to insert an end, and for one event
/// in four, the ways through the tree to those near by, O(log n) where tracks are short against the whole; O(n) for an
/// end that comes to fewer than five others; O(1) for other events; O(n) steps without arithmetic to remove an end. n
/// certificates (compact, local). All tracks that an end would cross on its way if none stopped are events, internal
/// ones.
class GrowingSegmentsRule {
 public:
  static constexpr const char* name = "GrowingSegments";
  using Element = GrowingEnd;
  using Change = GrowingStop;
  using Pen = Repair<Element, Change>;

  /// What has stopped an end: nobody while it grows. Precondition: the end is there.
  Id stopped_by(Id end) const { return ends_[end].stop ? ends_[end].ahead.back() : nobody; }
  /// When the end stopped, rounded up to a double; `never` while it grows. Precondition: the end is there.
  double stop_time(Id end) const { return ends_[end].stop ? ends_[end].time : never; }
  /// Where it stopped, exactly: its arrival there, with the paths of both as they were. Precondition: it has stopped.
  const certificates::Arrival& stopped_at(Id end) const { return *ends_[end].arrival; }
  /// Where the tip of the track is at a time, rounded. Preconditions: the end is there, and t >= the start of its path.
  std::array<double, 2> tip(const Element& element, Id end, double t) const {
    return element.path(std::min(t, stop_time(end)));
  }

  // Slot: the number of an end.
  std::optional<certificates::Arrival> certificate(Slot slot, const MovingSet<Element>& /*elements*/) const {
    return ends_[slot].stop ? std::nullopt : ends_[slot].arrival;
  }
  std::array<Id, 1> members(Slot slot) const { return {slot}; }

  Effect repair(Slot slot, Pen& repair);
  void insert(Id id, Pen& repair);
  void remove(Id id, Pen& repair);

  std::vector<GrowingStop> changes_from_nothing() const;
  void audit(const MovingSet<Element>& elements, double now) const;

  template <class Archive>
  void archive(Archive& archive) {
    archive(ends_, tree_, borders_);
  }

 private:
  using Arrival = certificates::Arrival;
  struct End {
    bool there = false, stop = false;
    bool knows_all = true;           ///< nothing is farther ahead than what is kept
    std::vector<Id> ahead{};         ///< whose tracks it comes to next, the next one last: or has stopped at
    double known_until = never;      ///< it comes to all of these up to this time; never if it knows all
    std::optional<Arrival> arrival;  ///< at the next
    double time = never;             ///< of stopping

    template <class Archive>
    void archive(Archive& archive) {
      archive(there, stop, knows_all, ahead, known_until, arrival, time);
    }
  };
  /// An arrival, and when: the first double that is not before it.
  struct Next {
    Id at;
    Arrival arrival;
    double time;

    Next(Id other, const Arrival& a, double now) : at(other), arrival(a), time(failure_time(a, now, never)) {}
  };
  static constexpr std::size_t kept_ahead = 4;

  /// 1 if the first comes before the second, 0 at one time.
  static int order(const Arrival& a, const Arrival& b) {
    return sign_after(certificates::ArrivesFirst{a, b}, a.end.start);
  }
  /// Whether the arrival is still to come; the end itself may still be to begin.
  static bool is_ahead(const Arrival& arrival, double now) {
    return sign_after(arrival, std::max(now, arrival.end.start)) > 0;
  }
  static bool is_before(const Next& a, const Next& b) {
    if (a.time != b.time) return a.time < b.time;
    const int sign = order(a.arrival, b.arrival);
    return sign > 0 || (sign == 0 && a.at < b.at);
  }
  /// Whether an end surely comes to the line of another after a time, or never. Decided with error balls, which suffice
  /// for nearly all lines, since these are far ahead or behind.
  static bool surely_later(const Element& end, const Element& other, double now, double time) {
    const auto f = Arrival{end.path, other.path, Arrival::At::line, 1}.polynomial<Ball<double>>(now);
    const Ball<double> first = f.c[0], last = first + f.c[1] * (Ball<double>(time) - Ball<double>(now));
    const auto is_positive = [](const Ball<double>& x) { return x.middle > x.radius; };
    return (is_positive(first) && is_positive(last)) || (is_positive(-first) && is_positive(-last));
  }
  /// Whether it is before a time.
  static bool is_past(const Arrival& arrival, double time) {
    const Ball<double> there = arrival.polynomial<Ball<double>>(time).c[0];
    if (std::abs(there.middle) > there.radius) return there.middle < 0;
    return arrival.polynomial<Exact>(time).c[0].sign() < 0;
  }
  static TreeBox<2> way(const certificates::PlaneMotion<1>& path, double from, double to);
  static Arrival across(const certificates::PlaneMotion<1>& end, const certificates::PlaneMotion<1>& track);
  static std::optional<Arrival> arrival_at(const Element& end, const Element& other);

  bool is_covered(const Arrival& arrival, Id other, const MovingSet<Element>& elements) const;
  /// False for an element that has not been inserted yet: the set has all elements before the first is inserted here.
  bool is_there(Id id) const { return id < ends_.size() && ends_[id].there; }
  bool may_stop(Id other, const Arrival& arrival, const MovingSet<Element>& elements) const {
    return !ends_[other].stop || is_covered(arrival, other, elements);
  }
  static void keep_first(std::vector<Next>& found);
  template <class Look>
  void look_at(const TrackBox::Place* place, Id id, const Look& look) const;
  void put_into_tree(Id id, const Element& element);
  TrackBox box_of(Id id, const Element& element) const;
  void look_ahead(Id id, const Next* after, Pen& repair);
  void go_on(Id id, const Next& from, Pen& repair);
  void put_ahead(Id id, Id other, Pen& repair);
  void process_arrivals(Id id, const Arrival* until, Pen& repair);

  std::vector<End> ends_;    ///< by id
  BoxTree<TrackBox> tree_;   ///< of all but the borders
  std::vector<Id> borders_;  ///< whole lines
  double enough_ = 1;        ///< s: how far ahead the next ones were found the last time; changes no result
};

// ---------------------------------------------------------------------------------------------------------------

/// The arrival at a line that the path crosses; its side is 0 where it does not.
inline auto GrowingSegmentsRule::across(const certificates::PlaneMotion<1>& end,
                                        const certificates::PlaneMotion<1>& track) -> Arrival {
  return {end, track, Arrival::At::line, static_cast<double>(-sign_after(certificates::TurnsLeft{track, end}, 0))};
}

/// Where an end may come to the track of another; nothing if it never does, or before the other.
inline auto GrowingSegmentsRule::arrival_at(const Element& end, const Element& other) -> std::optional<Arrival> {
  if (end.whole) return std::nullopt;
  const Arrival crossing = across(end.path, other.path);
  if (crossing.side != 0) {
    if (other.whole) return crossing;
    // The line behind the other's beginning is no track.
    if (is_past({other.path, end.path, Arrival::At::line, -crossing.side}, other.path.start)) return std::nullopt;
    const int other_first =
        -static_cast<int>(crossing.side) * sign_after(certificates::CrossesFirst{end.path, other.path}, end.path.start);
    return other_first >= 0 ? std::optional(crossing) : std::nullopt;
  }
  const int d = Arrival::axis(end.path);
  const auto velocity = [d](const Element& element) {
    return element.path.coordinate[static_cast<std::size_t>(d)].c[1];
  };
  const double speed = velocity(end);
  if (other.whole || speed == 0) return std::nullopt;
  const bool on_one_line = sign_after(Arrival{other.path, end.path, Arrival::At::line, 1}, end.path.start) == 0;
  if (!on_one_line) return std::nullopt;
  const bool face = velocity(other) != 0 && (velocity(other) < 0) != (speed < 0);
  const Arrival arrival{end.path, other.path, face ? Arrival::At::tip : Arrival::At::beginning, speed < 0 ? -1.0 : 1.0};
  return is_past(arrival, other.path.start) ? std::nullopt : std::optional(arrival);
}

/// Whether the track of the other, as far as it is known, is where the end arrives.
inline bool GrowingSegmentsRule::is_covered(const Arrival& arrival, Id other,
                                            const MovingSet<Element>& elements) const {
  if (elements[other].whole) return true;
  const Arrival passing = arrival.at == Arrival::At::line ? across(arrival.track, arrival.end) : arrival;
  const End& of_other = ends_[other];
  return arrival.at == Arrival::At::beginning || !of_other.stop || order(passing, *of_other.arrival) >= 0;
}

/// Takes the next track in place of one that the end has passed.
inline void GrowingSegmentsRule::go_on(Id id, const Next& from, Pen& repair) {
  End& end = ends_[id];
  end.ahead.pop_back();
  for (; !end.ahead.empty(); end.ahead.pop_back()) {
    end.arrival = arrival_at(repair[id], repair[end.ahead.back()]);
    if (may_stop(end.ahead.back(), *end.arrival, repair.elements())) return repair.certify(id);
  }
  if (!end.knows_all) return look_ahead(id, &from, repair);
  end.arrival.reset();
  repair.certify(id);
}

/// Puts a new track among those that are ahead of an end.
inline void GrowingSegmentsRule::put_ahead(Id id, Id other, Pen& repair) {
  End& end = ends_[id];
  if (!end.knows_all && surely_later(repair[id], repair[other], repair.now(), end.known_until))
    return;  // of nearly all
  const std::optional<Arrival> arrival = arrival_at(repair[id], repair[other]);
  if (!arrival || !is_ahead(*arrival, repair.now())) return;
  const Next next(other, *arrival, repair.now());
  const auto comes_later = [&](Id known) {
    return is_before(next, {known, *arrival_at(repair[id], repair[known]), repair.now()});
  };
  const auto place = std::partition_point(end.ahead.begin(), end.ahead.end(), comes_later);
  if (place == end.ahead.begin() && !end.knows_all) return;
  if (place == end.ahead.end()) {
    end.arrival = arrival;
    repair.certify(id);
  }
  end.ahead.insert(place, other);
  if (end.ahead.size() <= kept_ahead) return;
  end.ahead.erase(end.ahead.begin());
  end.knows_all = false;
  end.known_until = Next(end.ahead.front(), *arrival_at(repair[id], repair[end.ahead.front()]), repair.now()).time;
  put_into_tree(id, repair[id]);
}

/// Takes an end through all arrivals that are due, or through those before `until`. Whether it stops depends on how far
/// other ends have come, so these are first taken through their earlier arrivals, and so on: the times get ever
/// earlier, so this ends.
inline void GrowingSegmentsRule::process_arrivals(Id id, const Arrival* until, Pen& repair) {
  const auto is_due = [&] {
    const End& end = ends_[id];
    return !end.stop && end.arrival && repair.sign(*end.arrival) < 0 && (!until || order(*end.arrival, *until) > 0);
  };
  while (is_due()) {
    const Next next(ends_[id].ahead.back(), *ends_[id].arrival, repair.now());
    if (!repair[next.at].whole && next.arrival.at != Arrival::At::beginning) {
      const Arrival passing =
          next.arrival.at == Arrival::At::tip ? next.arrival : across(next.arrival.track, next.arrival.end);
      process_arrivals(next.at, &passing, repair);
    }
    if (!is_covered(next.arrival, next.at, repair.elements())) {
      go_on(id, next, repair);
      continue;
    }
    ends_[id].stop = true;
    ends_[id].time = repair.now();
    put_into_tree(id, repair[id]);
    repair.certify(id);
    repair.report({id, next.at});
  }
}

inline Effect GrowingSegmentsRule::repair(Slot slot, Pen& repair) {
  const auto id = static_cast<Id>(slot);
  process_arrivals(id, nullptr, repair);
  return ends_[id].stop ? Effect::external : Effect::internal;
}

inline void GrowingSegmentsRule::insert(Id id, Pen& repair) {
  if (id >= ends_.size()) ends_.resize(id + std::size_t{1});
  ends_[id] = {};
  ends_[id].there = true;
  const Element& element = repair[id];
  if (element.whole) borders_.push_back(id);
  look_ahead(id, nullptr, repair);
  // Ends that may come to this track before the last one that they keep. The tree must not change while it is looked
  // through.
  std::vector<Id> comers;
  const auto comes = [&](Id other) { comers.push_back(other); };
  element.whole ? look_at(nullptr, id, comes) : tree_.visit(TrackBox::of(element.path, never), comes);
  std::sort(comers.begin(), comers.end());
  for (const Id other : comers) {
    if (other != id && !ends_[other].stop) put_ahead(other, id, repair);
  }
}

inline void GrowingSegmentsRule::remove(Id id, Pen& repair) {
  ends_[id] = {};
  if (tree_.contains(id)) tree_.remove(id);
  std::erase(borders_, id);
  repair.retire(id);
  for (const Id other : repair.elements().ids()) {
    if (!is_there(other) || ends_[other].stop) continue;
    End& end = ends_[other];
    const auto place = std::find(end.ahead.begin(), end.ahead.end(), id);
    if (place == end.ahead.end()) continue;
    if (place + 1 == end.ahead.end()) {
      go_on(other, {id, *end.arrival, repair.now()}, repair);
    } else {
      end.ahead.erase(place);
    }
  }
}

inline std::vector<GrowingStop> GrowingSegmentsRule::changes_from_nothing() const {
  std::vector<GrowingStop> changes;
  for (Id id = 0; id < ends_.size(); ++id) {
    if (ends_[id].there && ends_[id].stop) changes.push_back({id, stopped_by(id)});
  }
  return changes;
}

inline void GrowingSegmentsRule::audit(const MovingSet<Element>& elements, double now) const {
  const auto fail = [](Id id, const char* what) {
    throw AuditFailure(std::string(name) + ": end " + std::to_string(id) + ": " + what);
  };
  tree_.audit(name);
  for (Id id = 0; id < ends_.size(); ++id) {
    const End& end = ends_[id];
    if (end.there != elements.contains(id)) fail(id, "is missing or gone");
    if (tree_.contains(id) != (end.there && !elements[id].whole)) fail(id, "is in the tree of tracks, or is not");
    if (tree_.contains(id) && tree_.box(id) != box_of(id, elements[id])) fail(id, "has another track in the tree");
    if (!end.there || end.stop) continue;
    for (const Id other : elements.ids()) {
      const std::optional<Arrival> arrival = other == id ? std::nullopt : arrival_at(elements[id], elements[other]);
      if (!arrival || !is_ahead(*arrival, now) || !may_stop(other, *arrival, elements)) continue;
      if (!end.arrival || is_before({other, *arrival, now}, {end.ahead.back(), *end.arrival, now}))
        fail(id, "comes to another track first");
    }
  }
}

}  // namespace kds::structures

#include "structures/growing_segments_ahead.hpp"
