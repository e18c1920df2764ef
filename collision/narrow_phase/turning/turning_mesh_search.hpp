// The search for contacts of a mesh that turns: a queue of pairs of nodes by proven times.
#pragma once

#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/turning/node_pairs.hpp"
#include "collision/narrow_phase/turning/remembered_signs.hpp"
#include "collision/narrow_phase/turning/turning_touch.hpp"
#include "collision/narrow_phase/turning/ways_apart.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <queue>
#include <type_traits>
#include <utility>
#include <vector>

namespace kds::collision {

/// A mesh (a) and a MeshOfPair, BoxOfPair, BallOfPair or CapsuleOfPair (b), and their motions. See TurningMeshContact
/// for laws and method.
template <int Degree, class Side>
class TurningMeshSearch {
 public:
  using RigidMotion = certificates::RigidMotion<Degree>;
  using Pair = typename Side::template PairWith<Degree>;
  using View = NodesView<Degree>;

  TurningMeshSearch(const MeshOfPair& a, const RigidMotion& motion_a, const Side& b, const RigidMotion& motion_b)
      : a_(a),
        b_(b),
        nodes_(a, b),
        motion_a_(motion_a),
        motion_b_(motion_b),
        rates_(motion_a, motion_b),
        units_a_(a.units()),
        units_b_(b.units()) {}

  double first_contact(double t0, double horizon, ContactMode mode) const;

  bool in_contact(double t) const {
    return find(view(t), [](NodePair, const Pair&) { return true; });
  }

  /// The pair of triangles that penetrates just after t is followed until it parts, then the next one.
  double first_separation(double t0, double horizon) const {
    for (double t = t0; t <= horizon;) {
      double parts = t;
      const View view = this->view(t);
      const bool penetrate = find(view, [&](NodePair, const Pair& pair) {
        parts = ways(pair, view).first_parting(t, horizon);
        return true;
      });
      if (!penetrate) return t;
      t = parts;
    }
    return never;
  }

  TurningTouch touch_at(double t) const;

 private:
  /// Whether floats tell of pairs of leaves more than their boxes do.
  static constexpr bool tells_triangles = std::is_same_v<Side, MeshOfPair>;

  enum class Known : std::uint8_t {
    apart_until,  ///< by floats or doubles
    stuck,        ///< doubles do not tell more: exact signs have to
    contact       ///< they penetrate just after that time
  };
  struct Item {
    double time;
    double seen;  ///< the time of the view that has told so
    NodePair nodes;
    Known known;
    int tries = 0;  ///< by exact signs, one after the other
    /// Which one of the same time is first makes no difference.
    friend bool operator>(const Item& x, const Item& y) { return x.time > y.time; }
  };

  /// The search of one first contact.
  class Front {
   public:
    Front(const TurningMeshSearch& search, double t0, double horizon, ContactMode mode)
        : search_(search), horizon_(horizon), mode_(mode), view_(search.view(t0, horizon)) {
      // What most searches need.
      std::vector<Item> items;
      items.reserve(32), visits_.reserve(32), leaves_.reserve(16);
      queue_ = decltype(queue_)(std::greater<>(), std::move(items));
      search_.nodes_.first([&](NodePair nodes) { visits_.push_back({nodes, t0}); });
      visit_all();
    }
    double next();

   private:
    void push(double t, NodePair nodes, Known known, int tries = 0) {
      if (t <= horizon_) queue_.push({t, view_.time, nodes, known, tries});
    }
    /// The time until which a part of the time ahead lasts.
    double apart_until(float part) const {
      const double wait = part >= 1 ? view_.ahead : static_cast<double>(part) * view_.ahead * (1 - 0x1p-30);
      return wait > horizon_ - view_.time ? never : next_down(view_.time + wait);
    }
    void look(double t) {
      if (t != view_.time) view_ = search_.view(t, horizon_);
    }
    /// What waits to be looked at in the same view.
    struct Visit {
      NodePair nodes;
      double from;  ///< they are known to be apart up to then, which is not before the view
      int tries = 0;
    };
    void visit_all();
    void visit_triangles(const Visit& visit);
    void visit_triangles_together();
    void visit_exactly(NodePair nodes, int tries);
    bool counts(NodePair nodes) const;

    const TurningMeshSearch& search_;
    double horizon_;  ///< in mode `transparent` no later than a contact that is known
    ContactMode mode_;
    View view_;  ///< at the time that is looked at, or not long before
    std::priority_queue<Item, std::vector<Item>, std::greater<>> queue_;
    std::vector<Visit> visits_, leaves_;  ///< of visit_all()
  };

  View view(double t, double horizon) const { return {motion_a_, motion_b_, rates_, units_a_, units_b_, t, horizon}; }
  View view(double t) const { return view(t, t); }

  Pair pair(NodePair leaves) const { return b_.pair(a_, leaves.a, motion_a_, leaves.b, motion_b_); }
  /// As seen at the time of the view.
  WaysApart<Pair, RememberedSigns&> ways(const Pair& pair, const View& view) const {
    using Ways = WaysApart<Pair, RememberedSigns&>;
    if constexpr (std::is_base_of_v<typename Ways::Frame, View>) {
      return Ways(pair, signs_, view);
    } else {
      return Ways(pair, signs_);
    }
  }
  /// Calls ask(leaves, pair) for the pairs that are not surely farther apart than twice a margin, until it returns
  /// true.
  template <class Ask>
  bool every_near(const View& view, double margin, const Ask& ask) const {
    std::vector<NodePair> list;
    list.reserve(64);
    const auto put = [&](NodePair nodes) { list.push_back(nodes); };
    nodes_.first(put);
    while (!list.empty()) {
      const auto together = nodes_.take_together(list, std::identity());
      const unsigned apart = nodes_apart_by(margin, view, together.nodes);
      for (std::size_t i = static_cast<std::size_t>(together.nodes.count); i-- > 0;) {
        if (apart >> i & 1) continue;
        const NodePair nodes = together.items[i];
        if (!nodes_.are_leaves(nodes)) {
          nodes_.open(nodes, put);
          continue;
        }
        const Pair pair = this->pair(nodes);
        if (pair.quick_gap(view) > 2 * (pair.error(view) + margin)) continue;
        if (ask(nodes, pair)) return true;
      }
    }
    return false;
  }
  /// The same of those that penetrate just after the time of the view.
  template <class Ask>
  bool find(const View& view, const Ask& ask) const {
    return every_near(view, 0, [&](NodePair leaves, const Pair& pair) {
      return ways(pair, view).penetrate(view.time) && ask(leaves, pair);
    });
  }

  TurningTouch touch(NodePair leaves, const Pair& pair, const View& view) const {
    const PointRates<Degree> rates(motion_a_, motion_b_, view.time);
    return touch_of(pair, a_, leaves.a, b_, leaves.b, view, rates, motion_a_.path.position(view.time));
  }
  double passed_over(const Pair& pair, const View& view, double horizon) const;

  const MeshOfPair& a_;
  const Side& b_;
  NodePairs<Side> nodes_;
  const RigidMotion& motion_a_;
  const RigidMotion& motion_b_;
  PairRates rates_;
  NodeUnits units_a_, units_b_;
  mutable RememberedSigns signs_;
};

// ---------------------------------------------------------------------------------------------------------------------

template <int Degree, class Side>
double TurningMeshSearch<Degree, Side>::first_contact(double t0, double horizon, ContactMode mode) const {
  return Front(*this, t0, horizon, mode).next();
}

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
        if (mode_ == ContactMode::transparent || counts(item.nodes)) return item.time;
        push(search_.passed_over(search_.pair(item.nodes), view_, horizon_), item.nodes, Known::apart_until);
    }
  }
  return never;
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
  const double until = search_.pair(visit.nodes).apart_until(view_, horizon_);
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
  if (contact != never) {
    push(contact, nodes, Known::contact);
    if (mode_ == ContactMode::transparent) horizon_ = contact;
    return;
  }
  if (until < horizon_) push(until, nodes, Known::apart_until, std::min(tries + 1, most_tries));
}

template <int Degree, class Side>
bool TurningMeshSearch<Degree, Side>::Front::counts(NodePair nodes) const {
  return search_.touch(nodes, search_.pair(nodes), view_).approach > 0;
}

/// When a pair that penetrates and does not approach is to be looked at again: just after it has parted, or when it is
/// deeper by more than roundings of coordinates.
template <int Degree, class Side>
double TurningMeshSearch<Degree, Side>::passed_over(const Pair& pair, const View& view, double horizon) const {
  const double t = view.time;
  const auto ways = this->ways(pair, view);
  // In so short a time they do not get deeper by more than 2^-40 of their distances, as they do not approach. Mostly
  // they have parted by then.
  constexpr double short_time = 0x1p-20;
  const double sizes = a_.radius(0) + norm(view.way.value);
  const double soon = std::max(next_up(t), t + short_time * view.stretch(sizes, horizon - t));
  if (const double parts = ways.first_parting(t, std::min(soon, horizon), true); parts != never) return parts;
  const double depth = std::max(0.0, -pair.gap(view));
  const double slack = (1 + 0x1p-10) * depth + pair.roundings(view);
  const Pair shallow = pair.with_slack(slack);
  double deeper = t;
  for (double proven = t; deeper < never;) {
    const int plane = pair.shallow_plane(deeper, slack);  // faces that lie on each other may do so for long
    proven = plane >= 0 ? pair.holds_until(plane, slack, deeper, horizon) : shallow.apart_until(deeper, horizon);
    if (proven == deeper) break;
    deeper = proven;
  }
  deeper = std::max(deeper, soon);
  return std::min(deeper, ways.first_parting(t, std::min(deeper, horizon), true));
}

template <int Degree, class Side>
TurningTouch TurningMeshSearch<Degree, Side>::touch_at(double t) const {
  TurningTouch best;
  NodePair of_best{};
  const View view = this->view(t);
  for (const double when : {t, next_down(t)}) {
    bool any = false;
    find(this->view(when), [&](NodePair leaves, const Pair& pair) {
      const TurningTouch each = touch(leaves, pair, view);
      if (!any || each.approach > best.approach || (each.approach == best.approach && leaves < of_best)) {
        best = each, of_best = leaves;
      }
      any = true;
      return false;
    });
    if (any) return best;
  }
  for (double margin = 0x1p-40 * (a_.radius(0) + norm(view.way.value));; margin *= 64) {
    double least = never;
    every_near(view, margin, [&](NodePair leaves, const Pair& pair) {
      const double gap = pair.gap(view);
      if (gap <= pair.error(view) + margin && (gap < least || (gap == least && leaves < of_best))) {
        least = gap, of_best = leaves;
        best = touch(leaves, pair, view);
      }
      return false;
    });
    if (least < never) return best;
  }
}

}  // namespace kds::collision
