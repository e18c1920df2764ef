// The search for the first contact of a mesh that turns: what waits in its queue, and how it is looked at.
#pragma once

#include "certificates/ball_separation.hpp"
#include "collision/narrow_phase/turning/turning_mesh_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>

namespace kds::collision {

/// A view costs as much as some pairs of nodes, so each is used for a part of the time for which the last one could be
/// used.
template <int Degree, class Side>
double TurningMeshSearch<Degree, Side>::Front::next() {
  constexpr double part = 0.375;
  constexpr std::size_t most_visits = 16;
  const auto soon_enough = [&](const Item& item) { return item.time - view_.time <= part * (item.time - item.seen); };
  while (!queue_.empty()) {
    const Item item = queue_.top();
    queue_.pop();
    switch (item.known) {
      case Known::apart_until:
        if (item.time > horizon_) return never;
        if (!soon_enough(item)) look(item.time);
        visits_.push_back({item.nodes, item.time, item.tries});
        // Others that this view is good for, too, so that some are looked at together.
        while (!queue_.empty() && visits_.size() < most_visits) {
          const Item& other = queue_.top();
          if (other.known != Known::apart_until || other.time > horizon_ || !soon_enough(other)) break;
          visits_.push_back({other.nodes, other.time, other.tries});
          queue_.pop();
        }
        visit_all();
        break;
      case Known::stuck:
        look(item.time);
        visit_exactly(item.nodes, item.tries);
        break;
      case Known::contact:
        look(item.time);
        met_ = item.nodes;
        if (mode_ == ContactMode::transparent || touch_now(item.nodes).approach > 0) return item.time;
        pass_over(item);
        break;
      case Known::entered:
        met_.reset();
        if (entered_counts(item)) return item.time;
    }
  }
  return never;
}

/// All that waits for a later time is apart until then, but for pairs that were passed over. Where faces lie on faces,
/// or where what penetrates does not approach, other pairs have a say in where the two touch.
template <int Degree, class Side>
std::optional<NodePair> TurningMeshSearch<Degree, Side>::Front::foremost() {
  if (!met_) return std::nullopt;
  const double t = view_.time;
  TurningTouch best = touch_now(*met_);
  bool alone = best.approach > 0 && best.area == 0;
  const auto compare = [&](NodePair leaves) {
    if (leaves == *met_) return;
    const TurningTouch touch = touch_now(leaves);
    alone = alone && touch.area == 0;
    if (touch.approach > best.approach || (touch.approach == best.approach && leaves < *met_))
      best = touch, met_ = leaves;
  };
  std::vector<NodePair> near = passed_over_;
  for (; alone && !queue_.empty() && queue_.top().time == t; queue_.pop()) {
    const Item& item = queue_.top();
    if (item.known == Known::contact) {
      compare(item.nodes);
    } else if (item.known != Known::entered) {
      near.push_back(item.nodes);
    }
  }
  if (alone && !near.empty()) {
    search_.every_near(view_, 0, std::move(near), [&](NodePair leaves, const Pair& pair) {
      if (search_.ways(pair, view_).penetrate(t)) compare(leaves);
      return !alone;
    });
  }
  return alone ? met_ : std::nullopt;
}

/// When a pair that penetrates and does not approach is to be looked at again: just after it has parted, or when it is
/// deeper by more than roundings of coordinates. Where nothing tells when it is deeper, as of a ball or a capsule whose
/// core goes through the triangle, after a short time, and then after twice the time each: else there would be no end.
template <int Degree, class Side>
auto TurningMeshSearch<Degree, Side>::passed_over(const Pair& pair, const View& view, double horizon, int tries) const
    -> PassedOver {
  const double t = view.time;
  const auto ways = this->ways(pair, view);
  const double soon = std::max(next_up(t), t + short_time(view, horizon));  // mostly they have parted by then
  if (const double parts = ways.first_parting(t, std::min(soon, horizon), true); parts != never) {
    return {parts, true};
  }
  const double depth = std::max(0.0, -pair.gap(view));
  const double slack = (1 + 0x1p-10) * depth + pair.roundings(view);
  const Pair shallow = pair.with_slack(slack);
  double deeper = t;
  while (deeper < never) {
    const int plane = pair.shallow_plane(deeper, slack);  // faces that lie on each other may do so for long
    const double next =
        plane >= 0 ? pair.holds_until(plane, slack, deeper, horizon) : shallow.apart_until(deeper, horizon);
    if (next == deeper) break;
    deeper = next;
  }
  const bool proven = deeper > t;
  deeper = std::max({deeper, soon, proven ? t : t + std::ldexp(short_time(view, horizon), tries)});
  const double parts = ways.first_parting(t, std::min(deeper, horizon), true);
  return {std::min(parts, deeper), proven || parts != never};
}

template <int Degree, class Side>
void TurningMeshSearch<Degree, Side>::Front::pass_over(const Item& item) {
  passed_over_.push_back(item.nodes);
  const auto passed = search_.passed_over(search_.pair(item.nodes), view_, horizon_, item.tries);
  push(passed.until, item.nodes, Known::apart_until, passed.proven ? 0 : item.tries + 1);
}

/// Until when planes, one after the other, are found that separate all of the two bodies. Of those that are near each
/// other most only pass, and then no pair of nodes has to be looked at.
template <int Degree, class Side>
double TurningMeshSearch<Degree, Side>::Front::separated_until(double t) {
  constexpr double worth = 0.125;  // of the time ahead: a plane costs as much as two groups of pairs of nodes
  for (;;) {
    const float part = separated_part(view_, search_.a_.outer_points(), search_.b_.outer_points());
    const double until = part > 0 ? apart_until(part) : t;
    if (!(until > t)) return t;
    t = until;
    if (t > horizon_ || !(static_cast<double>(part) >= worth)) return t;
    look(t);
  }
}

/// A time from which on the balls around the two are apart until the horizon, or this. What only moves would be looked
/// at for as long as it flies, pair by pair, if nothing told that it does not come back.
template <int Degree, class Side>
double TurningMeshSearch<Degree, Side>::Front::near_until(double t) const {
  const certificates::BallSeparation<Degree> balls{search_.motion_a_.path, search_.motion_b_.path,
                                                   search_.units_a_.farthest, search_.units_b_.farthest};
  const double meet = failure_time(balls, t, horizon_);
  if (meet == never) return t;
  const double part = recovery_time(balls, meet, horizon_);
  return part < never && failure_time(balls, part, horizon_) == never ? part : horizon_;
}

/// By floats, and triangles by doubles.
template <int Degree, class Side>
void TurningMeshSearch<Degree, Side>::Front::visit_all() {
  while (!visits_.empty()) {
    const auto together = search_.nodes_.take_together(visits_, &Visit::nodes);
    const NodeWaits apart = nodes_apart(view_, together.nodes);
    for (std::size_t i = 0; i < static_cast<std::size_t>(together.nodes.count); ++i) {
      const Visit& visit = together.items[i];
      const double until = apart_until(apart.part[i]);
      if (until > horizon_) continue;
      if ((apart.worth_it >> i & 1) && until > visit.from) {
        push(until, visit.nodes, Known::apart_until);
      } else if (search_.nodes_.are_leaves(visit.nodes)) {
        leaves_.push_back(visit);
      } else {
        search_.nodes_.open(visit.nodes, [&](NodePair halves) { visits_.push_back({halves, visit.from}); });
      }
    }
  }
  if constexpr (tells_triangles) visit_triangles_together();
  for (const Visit& visit : leaves_) visit_triangles(visit);
  leaves_.clear();
}

/// By floats. Those that need more are left in the list.
template <int Degree, class Side>
void TurningMeshSearch<Degree, Side>::Front::visit_triangles_together() {
  constexpr float worth = 0x1p-8F;
  if (!view_.certain || !(view_.ahead > 0)) return;
  constexpr std::size_t width = most_together;
  TrianglesTogether triangles{};
  std::size_t left = 0;
  for (std::size_t first = 0; first < leaves_.size(); first += width) {
    const std::size_t count = std::min(width, leaves_.size() - first);
    triangles.count = static_cast<int>(count);
    for (std::size_t i = 0; i < count; ++i) {
      const NodePair& leaves = leaves_[first + i].nodes;
      const auto a = search_.a_.corners(leaves.a), b = search_.b_.corners(leaves.b);
      for (std::size_t k = 0; k < 3; ++k) {
        put_corner(triangles.a[k][i], view_, a[k]);
        put_corner(triangles.b[k][i], view_, b[k]);
      }
    }
    std::array<float, width> parts;
    find_triangle_parts(view_.floats, triangles, parts.data());
    for (std::size_t i = 0; i < count; ++i) {
      const Visit visit = leaves_[first + i];
      const double until = apart_until(parts[i]);
      if (until > horizon_) continue;
      if (parts[i] >= worth && until > visit.from) {
        push(until, visit.nodes, Known::apart_until);
      } else {
        leaves_[left++] = visit;
      }
    }
  }
  leaves_.resize(left);
}

/// By doubles. Where they tell nothing new it is looked at again in a view of its own time: the view is never later
/// than what waits in the queue.
template <int Degree, class Side>
void TurningMeshSearch<Degree, Side>::Front::visit_triangles(const Visit& visit) {
  const Pair pair = search_.pair(visit.nodes);
  double until = view_.time;
  if constexpr (tells_triangles) {
    // What parts is passed over in mode `resolved`, so that it need not be told exactly whether it penetrates at first.
    const bool parting_counts = mode_ == ContactMode::transparent || search_.b_.solid();
    until = parting_counts ? pair.apart_until(view_, horizon_) : pair.clear_until(view_, horizon_);
  } else {
    until = pair.apart_until(view_, horizon_);
  }
  if (until > visit.from) {
    push(until, visit.nodes, Known::apart_until);
  } else {
    push(visit.from, visit.nodes, view_.time < visit.from ? Known::apart_until : Known::stuck, visit.tries);
  }
}

/// By exact signs: for a while, or up to the time at which other pairs may come first. For surfaces that slide on each
/// other nothing else decides, so the while grows from try to try.
template <int Degree, class Side>
void TurningMeshSearch<Degree, Side>::Front::visit_exactly(NodePair nodes, int tries) {
  constexpr double part_of_turn = 0x1p-6;
  constexpr int most_tries = 20;
  const double t = view_.time;
  const Pair pair = search_.pair(nodes);
  const double others = queue_.empty() ? never : queue_.top().time;
  const double step = std::max(next_up(t), t + std::ldexp(part_of_turn, 2 * tries) * pair.time_of_turning());
  const double until = std::min(horizon_, std::max(others, step));
  const double contact = search_.ways(pair, view_).first_penetration(t, until, true);
  note_entries(nodes, pair, std::min(contact, until));
  if (contact != never) {
    push(contact, nodes, Known::contact, contact > t ? 0 : tries);
    if (mode_ == ContactMode::transparent) horizon_ = contact;
    return;
  }
  if (until < horizon_) push(until, nodes, Known::apart_until, std::min(tries + 1, most_tries));
}

/// Notes when from now on the pair enters the one or the other solid at flush edges.
template <int Degree, class Side>
void TurningMeshSearch<Degree, Side>::Front::note_entries(NodePair nodes, const Pair& pair, double until) {
  const double t = view_.time;
  search_.every_entry(nodes, pair, view_, [&](const FlushEntries::Place& place, const Entry& entry) {
    const auto ways = search_.ways(entry);
    for (double from = ways.first_penetration(t, until, true); from <= until;) {
      const double parts = ways.first_parting(from, until, true);
      const double to = parts == never ? next_up(until) : parts;
      entries_.note(t, place, from, to, [&](double both) { push(both, nodes, Known::entered); });
      from = parts == never ? never : ways.first_penetration(parts, until, true);
    }
  });
}

/// Whether solids that have entered each other approach. If they do not it is looked at again after a short time, in
/// which they do not get deeper by more than 2^-40 of their distances, and then after twice the time each.
template <int Degree, class Side>
bool TurningMeshSearch<Degree, Side>::Front::entered_counts(const Item& item) {
  const double t = item.time;
  if (t == last_entered_ || !entries_.both_at(t)) return false;
  last_entered_ = t;
  look(t);
  if (mode_ == ContactMode::transparent) return true;
  if (const auto touch = search_.entered_touch(view_, view_); touch && touch->approach > 0) return true;
  push(std::max(next_up(t), t + std::ldexp(search_.short_time(view_, horizon_), item.tries)), item.nodes,
       Known::entered, item.tries + 1);
  return false;
}

}  // namespace kds::collision
