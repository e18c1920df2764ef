// The search for contacts of a mesh that turns: a queue of pairs of nodes by proven times.
#pragma once

#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/turning/flush_edges.hpp"
#include "collision/narrow_phase/turning/node_pairs.hpp"
#include "collision/narrow_phase/turning/remembered_signs.hpp"
#include "collision/narrow_phase/turning/turning_touch.hpp"
#include "collision/narrow_phase/turning/ways_apart.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
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

  /// `foremost`, unless it is null, gets the leaves of which touch_at() would tell, if that is known.
  double first_contact(double t0, double horizon, ContactMode mode, std::optional<NodePair>* foremost) const {
    Front front(*this, t0, horizon, mode);
    const double t = front.next();
    if (foremost && t != never) *foremost = front.foremost();
    return t;
  }

  bool in_contact(double t) const {
    const View view = this->view(t);
    Entered entered;
    return every_near(view, 0, [&](NodePair leaves, const Pair& pair) {
      return ways(pair, view).penetrate(t) || now_entered(leaves, pair, view, entered);
    });
  }

  /// The pair of triangles that penetrates just after t, or the two that enter, are followed until they part, then the
  /// next ones.
  double first_separation(double t0, double horizon) const {
    for (double t = t0; t <= horizon;) {
      double parts = t;
      const View view = this->view(t);
      Entered entered;
      const bool penetrate = every_near(view, 0, [&](NodePair leaves, const Pair& pair) {
        if (ways(pair, view).penetrate(t)) {
          parts = ways(pair, view).first_parting(t, horizon, true);
          return true;
        }
        if (!now_entered(leaves, pair, view, entered)) return false;
        parts = never;
        for (const auto& entry : entered.into) parts = std::min(parts, ways(*entry).first_parting(t, horizon, true));
        return true;
      });
      if (!penetrate) return t;
      t = parts;
    }
    return never;
  }

  /// Of the pair of triangles that approaches fastest among those that penetrate just after t. `foremost`: what
  /// first_contact() has told, or null.
  TurningTouch touch_at(double t, const NodePair* foremost) const;

 private:
  /// Whether floats tell of pairs of leaves more than their boxes do.
  static constexpr bool tells_triangles = std::is_same_v<Side, MeshOfPair>;

  enum class Known : std::uint8_t {
    apart_until,  ///< by floats or doubles
    stuck,        ///< doubles do not tell more: exact signs have to
    contact,      ///< they penetrate just after that time
    entered       ///< the two solids enter each other at flush edges
  };
  struct Item {
    double time;
    double seen;  ///< the time of the view that has told so
    NodePair nodes;
    Known known;
    int tries = 0;  ///< by exact signs, or at what penetrates or has entered, one after the other
    /// Which one of the same time is first makes no difference.
    friend bool operator>(const Item& x, const Item& y) { return x.time > y.time; }
  };

  /// The search of one first contact.
  class Front {
   public:
    Front(const TurningMeshSearch& search, double t0, double horizon, ContactMode mode)
        : search_(search), horizon_(horizon), mode_(mode), view_(search.view(t0, horizon)) {
      const double from = separated_until(t0);
      if (from > horizon_) return;
      if (view_.ahead < horizon_ - view_.time) horizon_ = near_until(from);
      // What most searches need.
      std::vector<Item> items;
      items.reserve(32), visits_.reserve(32), leaves_.reserve(16);
      queue_ = decltype(queue_)(std::greater<>(), std::move(items));
      search_.nodes_.first([&](NodePair nodes) { visits_.push_back({nodes, from}); });
      visit_all();
    }
    double next();
    /// After next() has told of a contact: the pair of leaves that approaches fastest there, if that alone tells where
    /// the two touch.
    std::optional<NodePair> foremost();

   private:
    void push(double t, NodePair nodes, Known known, int tries = 0) {
      if (t <= horizon_) queue_.push({t, view_.time, nodes, known, tries});
    }
    /// The time until which a part of the time ahead lasts.
    double apart_until(float part) const {
      const double wait = part >= 1 ? view_.ahead : static_cast<double>(part) * view_.ahead * (1 - 0x1p-30);
      return wait > horizon_ - view_.time ? never : next_down(view_.time + wait);
    }
    double separated_until(double t);
    double near_until(double t) const;
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
    void note_entries(NodePair nodes, const Pair& pair, double until);
    TurningTouch touch_now(NodePair leaves) const { return search_.touch(leaves, search_.pair(leaves), view_); }
    void pass_over(const Item& item);
    bool entered_counts(const Item& item);

    const TurningMeshSearch& search_;
    double horizon_;  ///< in mode `transparent` no later than a contact that is known
    ContactMode mode_;
    View view_;  ///< at the time that is looked at, or not long before
    std::priority_queue<Item, std::vector<Item>, std::greater<>> queue_;
    std::vector<Visit> visits_, leaves_;  ///< of visit_all()
    std::vector<NodePair> passed_over_;   ///< leaves, each perhaps more than once
    std::optional<NodePair> met_;         ///< the leaves of the contact that was found
    FlushEntries entries_;
    double last_entered_ = -never;  ///< when it was last looked at what has entered
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
  using Entry = FlushEntry<Degree>;
  using EntryWays = WaysApart<Entry, RememberedSigns&>;
  EntryWays ways(const Entry& entry) const { return EntryWays(entry, signs_); }

  /// Calls visit(place, entry) for the places of two triangles of closed meshes at which one may enter the solid of the
  /// other.
  template <class Visit>
  void every_entry(NodePair leaves, const Pair& pair, const View& view, const Visit& visit) const {
    if constexpr (tells_triangles) {
      const auto [near_a, near_b] = pair.near_planes(view);
      if (std::popcount(near_a) < 2 && std::popcount(near_b) < 2) return;
      if (!a_.is_closed() || !b_.is_closed()) return;
      const typename Entry::Side a{motion_a_, a_.corners(leaves.a)}, b{motion_b_, b_.corners(leaves.b)};
      every_flush_entry<Degree>(
          a, near_b, b, near_a, view.time, signs_, [&](std::size_t i) { return b_.corner_across(leaves.b, i); },
          [&](bool of_face, int number, const Entry& entry) {
            visit({leaves, of_face ? Into::a : Into::b, number}, entry);
          });
      every_flush_entry<Degree>(
          b, near_a, a, near_b, view.time, signs_, [&](std::size_t i) { return a_.corner_across(leaves.a, i); },
          [&](bool of_face, int number, const Entry& entry) {
            visit({leaves, of_face ? Into::b : Into::a, number}, entry);
          });
    }
  }

  /// Where surfaces enter the one and the other solid just after some time.
  struct Entered {
    std::array<std::optional<Entry>, 2> into;
    bool both() const { return into[0] && into[1]; }
  };
  /// Whether they do with those of this pair.
  bool now_entered(NodePair leaves, const Pair& pair, const View& view, Entered& entered) const {
    if (entered.both()) return true;
    every_entry(leaves, pair, view, [&](const FlushEntries::Place& place, const Entry& entry) {
      auto& known = entered.into[place.into == Into::a ? 0 : 1];
      if (!known && ways(entry).penetrate(view.time)) known.emplace(entry);
    });
    return entered.both();
  }

  /// Calls ask(leaves, pair) for the pairs that are not surely farther apart than twice a margin, until it returns
  /// true.
  template <class Ask>
  bool every_near(const View& view, double margin, const Ask& ask) const {
    std::vector<NodePair> list;
    list.reserve(64);
    nodes_.first([&](NodePair nodes) { list.push_back(nodes); });
    return every_near(view, margin, std::move(list), ask);
  }
  /// The same of those in a list of pairs of nodes.
  template <class Ask>
  bool every_near(const View& view, double margin, std::vector<NodePair> list, const Ask& ask) const {
    const auto put = [&](NodePair nodes) { list.push_back(nodes); };
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
  void move_to_middle(TurningTouch& touch, const std::vector<TurningTouch>& flat, double t) const;
  std::optional<TurningTouch> entered_touch(const View& view, const View& then) const;
  struct PassedOver {
    double until;
    bool proven;  ///< by doubles or exact signs, not only for a short time
  };
  PassedOver passed_over(const Pair& pair, const View& view, double horizon, int tries) const;
  /// In so short a time they do not get deeper by more than 2^-40 of their distances, if they do not approach.
  double short_time(const View& view, double horizon) const {
    return 0x1p-20 * view.stretch(a_.radius(0) + norm(view.way.value), horizon - view.time);
  }

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

/// Where solids touch that enter each other at flush edges just after the time of `then`, seen at that of the view: in
/// the middle of the places that approach as fast as the fastest one, along the same direction. None if they do not
/// enter each other, or are deeper in each other than by what they may come to be while they are passed over.
template <int Degree, class Side>
auto TurningMeshSearch<Degree, Side>::entered_touch(const View& view, const View& then) const
    -> std::optional<TurningTouch> {
  std::vector<std::pair<NodePair, TurningTouch>> touches;
  std::array<bool, 2> into{};
  if constexpr (tells_triangles) {
    const double deepest = 0x1p-20 * (a_.radius(0) + norm(view.way.value));
    const PointRates<Degree> rates(motion_a_, motion_b_, view.time);
    const Eigen::Vector3d origin = motion_a_.path.position(view.time);
    every_near(then, 0, [&](NodePair leaves, const Pair& pair) {
      every_entry(leaves, pair, then, [&](const FlushEntries::Place& place, const Entry& entry) {
        if (!ways(entry).penetrate(then.time)) return;
        into[place.into == Into::a ? 0 : 1] = true;
        const bool face_of_a = &entry.of_face() == &motion_a_;
        const Eigen::Vector3d flush = face_of_a ? view.in_world_a(entry.normal()) : view.in_world_b(entry.normal());
        touches.emplace_back(leaves, touch_of(pair, a_, leaves.a, b_, leaves.b, view, rates, origin, flush, deepest));
      });
      return false;
    });
  }
  if (!into[0] || !into[1]) return std::nullopt;
  std::stable_sort(touches.begin(), touches.end(), [](const auto& x, const auto& y) {
    return x.second.approach > y.second.approach || (x.second.approach == y.second.approach && x.first < y.first);
  });
  TurningTouch best = touches[0].second;
  if (best.approach == -never) return std::nullopt;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const auto& [leaves, touch] : touches) {
    if (touch.approach < best.approach - 0x1p-20 * std::abs(best.approach)) break;
    if (dot(touch.normal, best.normal) > 1 - 0x1p-20) sum += touch.point, ++count;
  }
  best.point = sum / count;
  return best;
}

/// A face of several triangles that lies on another face touches it with each, and with those beside it at its edges.
/// If the middle of all that the faces share approaches, the two touch there, as hulls do. `flat`: the touches of faces
/// on faces.
template <int Degree, class Side>
void TurningMeshSearch<Degree, Side>::move_to_middle(TurningTouch& touch, const std::vector<TurningTouch>& flat,
                                                     double t) const {
  constexpr double cosine = 1 - 0x1p-40;  // of directions that are the same up to roundings
  const TurningTouch* first = nullptr;
  int count = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double area = 0;
  for (const TurningTouch& other : flat) {
    if (dot(other.normal, touch.normal) < cosine) continue;
    if (count++ == 0) first = &other;
    sum += other.area * other.middle;
    area += other.area;
  }
  if (count == 0 || (count == 1 && touch.area > 0)) return;
  const Eigen::Vector3d middle = sum / area;
  const PointRates<Degree> rates(motion_a_, motion_b_, t);
  const double approach = detail::approach_at(rates, touch.normal, motion_a_.path.position(t) + middle);
  if (approach > 0) touch = {middle, touch.normal, first->feature_a, first->feature_b, approach};
}

template <int Degree, class Side>
TurningTouch TurningMeshSearch<Degree, Side>::touch_at(double t, const NodePair* foremost) const {
  TurningTouch best;
  NodePair of_best{};
  std::vector<TurningTouch> flat;
  const View view = this->view(t);
  if (foremost) return touch(*foremost, pair(*foremost), view);
  for (const double when : {t, next_down(t)}) {
    bool any = false;
    const View then = this->view(when);
    find(then, [&](NodePair leaves, const Pair& pair) {
      const TurningTouch each = touch(leaves, pair, view);
      if (each.area > 0) flat.push_back(each);
      if (!any || each.approach > best.approach || (each.approach == best.approach && leaves < of_best)) {
        best = each, of_best = leaves;
      }
      any = true;
      return false;
    });
    if (!any || !(best.approach > 0)) {
      if (const auto entered = entered_touch(view, then); entered && (!any || entered->approach > best.approach)) {
        return *entered;
      }
    }
    if (any) {
      move_to_middle(best, flat, t);
      return best;
    }
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
