// The search for contacts of a mesh that turns: a queue of pairs of nodes by proven times.
#pragma once

#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/turning/remembered_signs.hpp"
#include "collision/narrow_phase/turning/turning_touch.hpp"
#include "collision/narrow_phase/turning/ways_apart.hpp"

#include <algorithm>
#include <cmath>
#include <compare>
#include <cstdint>
#include <functional>
#include <queue>
#include <type_traits>
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
      : a_(a), b_(b), motion_a_(motion_a), motion_b_(motion_b), units_a_(a.units()), units_b_(b.units()) {}

  double first_contact(double t0, double horizon, ContactMode mode) const;

  bool in_contact(double t) const {
    return find(view(t), [](Leaves, const Pair&) { return true; });
  }

  /// The pair of triangles that penetrates just after t is followed until it parts, then the next one.
  double first_separation(double t0, double horizon) const {
    for (double t = t0; t <= horizon;) {
      double parts = t;
      const View view = this->view(t);
      const bool penetrate = find(view, [&](Leaves, const Pair& pair) {
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
  /// A node of each.
  struct Leaves {
    std::uint32_t a, b;
    friend auto operator<=>(const Leaves&, const Leaves&) = default;
  };
  enum class Known : std::uint8_t {
    apart_until,  ///< by doubles
    stuck,        ///< doubles do not tell more: exact signs have to
    contact       ///< they penetrate just after that time
  };
  struct Item {
    double time;
    double seen;  ///< the time of the view that has told so
    Leaves nodes;
    Known known;
    int tries = 0;  ///< by exact signs, one after the other
    friend auto operator<=>(const Item&, const Item&) = default;
  };

  /// The search of one first contact.
  class Front {
   public:
    Front(const TurningMeshSearch& search, double t0, double horizon, ContactMode mode)
        : search_(search), horizon_(horizon), mode_(mode), view_(search.view(t0, horizon)) {
      visit({0, 0}, t0);
    }
    double next();

   private:
    void push(double t, Leaves nodes, Known known, int tries = 0) {
      if (t <= horizon_) queue_.push({t, view_.time, nodes, known, tries});
    }
    void look(double t) {
      if (t != view_.time) view_ = search_.view(t, horizon_);
    }
    void visit(Leaves nodes, double from, int tries = 0);
    void visit_exactly(Leaves nodes, int tries);
    bool counts(Leaves nodes) const;

    const TurningMeshSearch& search_;
    double horizon_;  ///< in mode `transparent` no later than a contact that is known
    ContactMode mode_;
    View view_;  ///< at the time that is looked at, or not long before
    std::priority_queue<Item, std::vector<Item>, std::greater<>> queue_;
  };

  View view(double t, double horizon) const { return {motion_a_, motion_b_, units_a_, units_b_, t, horizon}; }
  View view(double t) const { return view(t, t); }

  Pair pair(Leaves leaves) const { return b_.pair(a_, leaves.a, motion_a_, leaves.b, motion_b_); }
  /// As seen at the time of the view.
  WaysApart<Pair, RememberedSigns&> ways(const Pair& pair, const View& view) const {
    using Ways = WaysApart<Pair, RememberedSigns&>;
    if constexpr (std::is_base_of_v<typename Ways::Frame, View>) {
      return Ways(pair, signs_, view);
    } else {
      return Ways(pair, signs_);
    }
  }
  bool are_leaves(Leaves nodes) const { return a_.is_leaf(nodes.a) && b_.is_leaf(nodes.b); }

  /// Calls ask(child pair) for the halves of the larger node until it returns true.
  template <class Ask>
  bool of_halves(Leaves nodes, const Ask& ask) const {
    if (b_.is_leaf(nodes.b) || (!a_.is_leaf(nodes.a) && a_.radius(nodes.a) >= b_.radius(nodes.b))) {
      const std::uint32_t child = a_.first_child(nodes.a);
      return ask(Leaves{child, nodes.b}) || ask(Leaves{child + 1, nodes.b});
    }
    const std::uint32_t child = b_.first_child(nodes.b);
    return ask(Leaves{nodes.a, child}) || ask(Leaves{nodes.a, child + 1});
  }

  /// Calls ask(leaves, pair) for the pairs that are not surely farther apart than twice a margin, until it returns
  /// true.
  template <class Ask>
  bool every_near(const View& view, double margin, Leaves nodes, const Ask& ask) const {
    if (nodes_apart_by(margin, view, a_.node(nodes.a), b_.node(nodes.b))) return false;
    if (!are_leaves(nodes)) {
      return of_halves(nodes, [&](Leaves halves) { return every_near(view, margin, halves, ask); });
    }
    const Pair pair = this->pair(nodes);
    if (pair.quick_gap(view) > 2 * (pair.error(view) + margin)) return false;
    return ask(nodes, pair);
  }
  /// The same of those that penetrate just after the time of the view.
  template <class Ask>
  bool find(const View& view, const Ask& ask) const {
    return every_near(view, 0, {0, 0}, [&](Leaves leaves, const Pair& pair) {
      return ways(pair, view).penetrate(view.time) && ask(leaves, pair);
    });
  }

  TurningTouch touch(Leaves leaves, const Pair& pair, const View& view) const {
    const PointRates<Degree> rates(motion_a_, motion_b_, view.time);
    return touch_of(pair, a_, leaves.a, b_, leaves.b, view, rates, motion_a_.path.position(view.time));
  }
  double passed_over(const Pair& pair, const View& view, double horizon) const;

  const MeshOfPair& a_;
  const Side& b_;
  const RigidMotion& motion_a_;
  const RigidMotion& motion_b_;
  NodeUnits units_a_, units_b_;
  mutable RememberedSigns signs_;
};

// ---------------------------------------------------------------------------------------------------------------------

template <int Degree, class Side>
double TurningMeshSearch<Degree, Side>::first_contact(double t0, double horizon, ContactMode mode) const {
  return Front(*this, t0, horizon, mode).next();
}

/// A view costs as much as some pairs of nodes, so that one is looked through for a part of the time that the last one
/// was good for.
template <int Degree, class Side>
double TurningMeshSearch<Degree, Side>::Front::next() {
  constexpr double part = 0.25;
  while (!queue_.empty()) {
    const Item item = queue_.top();
    queue_.pop();
    switch (item.known) {
      case Known::apart_until:
        if (item.time > horizon_) return never;
        if (!(item.time - view_.time <= part * (item.time - item.seen))) look(item.time);
        visit(item.nodes, item.time, item.tries);
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

/// By doubles, of two that are known to be apart up to a time not before that of the view.
template <int Degree, class Side>
void TurningMeshSearch<Degree, Side>::Front::visit(Leaves nodes, double from, int tries) {
  const NodeWait apart = nodes_apart(view_, search_.a_.node(nodes.a), search_.b_.node(nodes.b));
  if (apart.wait > horizon_ - view_.time) return;
  if (apart.worth_it) {
    if (const double until = next_down(view_.time + apart.wait); until > from) {
      return push(until, nodes, Known::apart_until);
    }
  }
  if (!search_.are_leaves(nodes)) {
    search_.of_halves(nodes, [&](Leaves halves) { return visit(halves, from), false; });
    return;
  }
  const Pair pair = search_.pair(nodes);
  double until = pair.apart_until(view_, horizon_);
  if (until <= from && view_.time < from) {
    look(from);
    until = pair.apart_until(view_, horizon_);
  }
  until > from ? push(until, nodes, Known::apart_until) : push(from, nodes, Known::stuck, tries);
}

/// By exact signs: for a while, or to where other pairs may come first. What slides on each other has nothing else: the
/// while grows from try to try.
template <int Degree, class Side>
void TurningMeshSearch<Degree, Side>::Front::visit_exactly(Leaves nodes, int tries) {
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
bool TurningMeshSearch<Degree, Side>::Front::counts(Leaves nodes) const {
  return search_.touch(nodes, search_.pair(nodes), view_).approach > 0;
}

/// When a pair that penetrates and does not approach is to be looked at again: just after it has parted, or when it is
/// deeper by more than what roundings of coordinates can feign.
template <int Degree, class Side>
double TurningMeshSearch<Degree, Side>::passed_over(const Pair& pair, const View& view, double horizon) const {
  const double t = view.time;
  const auto ways = this->ways(pair, view);
  // In so short a time they do not get deeper by more than 2^-40 of their distances, as they do not approach. Mostly
  // they have parted by then.
  constexpr double short_time = 0x1p-20;
  const double sizes = a_.radius(0) + norm(view.way.value);
  const double soon = std::max(next_up(t), t + short_time * view.stretch(sizes, horizon - t));
  if (const double parts = ways.first_parting(t, std::min(soon, horizon)); parts != never) return parts;
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
  return std::min(deeper, ways.first_parting(t, std::min(deeper, horizon)));
}

template <int Degree, class Side>
TurningTouch TurningMeshSearch<Degree, Side>::touch_at(double t) const {
  TurningTouch best;
  Leaves of_best{};
  const View view = this->view(t);
  for (const double when : {t, next_down(t)}) {
    bool any = false;
    find(this->view(when), [&](Leaves leaves, const Pair& pair) {
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
    every_near(view, margin, {0, 0}, [&](Leaves leaves, const Pair& pair) {
      if (const double gap = pair.gap(view); gap < least && gap <= pair.error(view) + margin) {
        least = gap;
        best = touch(leaves, pair, view);
      }
      return false;
    });
    if (least < never) return best;
  }
}

}  // namespace kds::collision
