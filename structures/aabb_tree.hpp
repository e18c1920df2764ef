// Kinetic AABB tree: moving points or boxes in fat boxes at rest, and which of these overlap.
#pragma once

#include "certificates/in_order.hpp"
#include "certificates/within_limit.hpp"
#include "kds/audit.hpp"
#include "kds/framework/kinetic.hpp"
#include "structures/box_tree.hpp"
#include "structures/span_ahead.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace kds::structures {

/// A box whose least and greatest corner move on paths of their own. Precondition: as long as it is in a structure, min
/// stays at or below max on each axis. That is not checked.
template <class Path>
struct MovingBox {
  static constexpr int degree = Path::degree;
  Path min;
  Path max;

  bool finite() const { return kds::detail::finite(min) && kds::detail::finite(max); }
  friend bool operator==(const MovingBox&, const MovingBox&) = default;

  template <class Archive>
  void archive(Archive& archive) {
    archive(min, max);
  }
};

/// How much larger a fat box is than its element. More means fewer events and more pairs.
struct AabbTreeOptions {
  double slack = 0;  ///< length, on each side, >= 0
  double ahead = 0;  ///< s, >= 0: the box contains all that the element covers in this time
};

/// A listener that does nothing.
struct NoPairListener {
  /// The fat boxes of a and b, a < b, overlap from t on. Neither the elements nor the structure may be edited from
  /// within this call.
  void pair_began(Id /*a*/, Id /*b*/, double /*t*/) {}
  void pair_ended(Id /*a*/, Id /*b*/, double /*t*/) {}
};

/// Two elements have come to be a pair or are none any more, or one of them has got a new motion.
struct PairChange {
  enum class What : std::uint8_t { came, went, moved };  ///< moved: one of the two has a new motion
  What what;
  Id a, b;  ///< a < b

  friend bool operator==(const PairChange&, const PairChange&) = default;
};

/// Keeps a bounding-volume tree over moving elements, and the pairs whose boxes in it overlap.
///
/// An element, a point or a MovingBox (whose paths have axis(d), or are values where Dimension is 1), is in a *fat box*
/// at rest that is a little larger. Two certificates for each axis state that it is still inside; when one fails the
/// element gets a new fat box around its place at that time. The tree and the pairs are of fat boxes, so nothing else
/// changes. Papers: [Bergen97] for trees of boxes that move, [Weller06] for kinetic ones. Differs from the latter:
/// there the boxes of a tree of constant shape move with their elements, and a certificate states which element is the
/// extreme one of a node. That suits deforming meshes, whose neighbours stay neighbours; fat boxes at rest suit
/// elements that move independently, and an event concerns one of them.
///
/// Cost: an event, an update of one path in the tree and 2 Dimension certificates; with `ahead` > 0 an element has at
/// most one event in that time, whatever its speed, with `slack` one in slack / speed. 2 Dimension n certificates
/// (compact), 2 Dimension an element (local). External events are those that change the pairs.
///
/// Law: the pairs are those whose fat boxes overlap, and so include all whose elements do (`meet()`). Boxes that touch
/// overlap. Reports alternate for each pair, beginning with pair_began, at the times at which fat boxes change; for one
/// change the pairs that end come first, and both lists are in the order of the other element's id. Loading a snapshot
/// reports nothing. Rules that stand on this one are told of the same pairs (PairChange): one of those that really
/// meet, say, which needs certificates for these only.
template <MovingElement E, std::size_t Dimension, class PairListener = NoPairListener>
class AabbTreeRule {
 public:
  using Element = E;
  using Box = TreeBox<Dimension>;
  using Change = PairChange;
  using Pen = Repair<E, Change>;
  static constexpr const char* name = "AabbTree";

  /// Throws std::invalid_argument for options that are negative, not finite or both zero: fat boxes must be fat.
  explicit AabbTreeRule(AabbTreeOptions options, PairListener listener = {})
      : options_(options), listener_(std::move(listener)) {
    const auto fits = [](double x) { return x >= 0 && std::isfinite(x); };
    if (!fits(options.slack) || !fits(options.ahead) || options.slack + options.ahead == 0) {
      throw std::invalid_argument("AabbTree: slack and ahead must be finite, >= 0 and not both 0");
    }
  }

  const AabbTreeOptions& options() const { return options_; }
  const BoxTree<TreeBox<Dimension>>& tree() const { return tree_; }
  /// The fat box. Precondition: the element is there.
  const Box& box(Id id) const { return tree_.box(id); }

  /// Whether the fat boxes of two elements overlap.
  bool paired(Id a, Id b) const {
    return a < partners_.size() && std::binary_search(partners_[a].begin(), partners_[a].end(), b);
  }
  /// Ids of the elements that this one is paired with, ascending. Precondition: the element is there. The reference is
  /// valid until the next insertion, and shows later pairs.
  const std::vector<Id>& partners(Id id) const { return partners_[id]; }
  /// All pairs, ascending, the lower id first. O(n + pairs).
  std::vector<std::array<Id, 2>> pairs() const;

  /// Whether two elements overlap at t+, exactly: on each axis neither begins where the other has ended.
  static bool meet(const E& a, const E& b, double t);
  /// Ids of the elements that overlap at t+ with a box at rest, ascending, exactly. Precondition: `now` is the clock.
  std::vector<Id> query(const Box& box, const MovingSet<E>& elements, double now) const;

  // Slot 2 Dimension id + 2 d: the element's lower end on axis d is not below its fat box; and one more: nor its upper
  // one above it.
  auto certificate(Slot slot, const MovingSet<E>& elements) const {
    const auto [id, axis, upper] = place(slot);
    return side(elements[id], tree_.box(id), axis, upper);
  }
  std::array<Id, 1> members(Slot slot) const { return {place(slot).id}; }

  Effect repair(Slot slot, Pen& repair) {
    const Id id = place(slot).id;
    return renew(id, box_until_renewal(repair[id], repair.now()), repair) ? Effect::external : Effect::internal;
  }
  void insert(Id id, Pen& repair) { renew(id, box_until_renewal(repair[id], repair.now()), repair); }
  void remove(Id id, Pen& repair) {
    tree_.remove(id);
    set_partners(id, {}, repair);
    for (Slot i = 0; i < sides; ++i) repair.retire(id * sides + i);
  }
  /// The element keeps its fat box if that contains it for as long as a new one would have to.
  void change(Id id, Pen& repair) {
    const Box needed = box_until_renewal(repair[id], repair.now());
    if (tree_.box(id).contains(needed)) {
      certify(id, repair);
    } else {
      renew(id, needed, repair);
    }
    for (const Id other : partners_[id]) repair.report(pair(PairChange::What::moved, id, other));
  }

  std::vector<PairChange> changes_from_nothing() const {
    std::vector<PairChange> changes;
    for (const auto& [a, b] : pairs()) changes.push_back({PairChange::What::came, a, b});
    return changes;
  }

  void audit(const MovingSet<E>& elements, double now) const;

  template <class Archive>
  void archive(Archive& archive) {
    archive(options_, tree_, partners_);
  }

 private:
  static constexpr Slot sides = 2 * Dimension;
  struct Place {
    Id id;
    std::size_t axis;
    bool upper;
  };
  static Place place(Slot slot) { return {slot / sides, slot % sides / 2, slot % 2 == 1}; }

  static auto coordinate(const auto& path, std::size_t axis) {
    if constexpr (requires { path.axis(0); }) {
      return path.axis(static_cast<int>(axis));
    } else {
      static_assert(Dimension == 1, "AabbTree: a path in two dimensions and more must have axis(d)");
      return path;
    }
  }
  /// An end of the element on an axis, as a motion.
  static auto end(const E& element, std::size_t axis, bool upper) {
    if constexpr (requires { element.min, element.max; }) {
      return coordinate(upper ? element.max : element.min, axis);
    } else {
      return coordinate(element, axis);
    }
  }

  static auto side(const E& element, const Box& box, std::size_t axis, bool upper) {
    const double limit = upper ? box.max[axis] : box.min[axis];
    using Side = certificates::WithinLimit<decltype(end(element, axis, upper))>;
    return std::isfinite(limit) ? std::optional<Side>({end(element, axis, upper), limit, upper ? 1.0 : -1.0})
                                : std::nullopt;
  }

  /// A box with what the element covers from now until `ahead` later, and strictly around its present place.
  Box box_until_renewal(const E& element, double now) const {
    Box box;
    for (std::size_t d = 0; d < Dimension; ++d) {
      const Span low = span_ahead(end(element, d, false), now, options_.ahead);
      const Span high = span_ahead(end(element, d, true), now, options_.ahead);
      box.min[d] = std::min(low.min, high.min);
      box.max[d] = std::max(low.max, high.max);
    }
    return box;
  }

  static PairChange pair(PairChange::What what, Id a, Id b) { return {what, std::min(a, b), std::max(a, b)}; }
  void certify(Id id, Pen& repair) const {
    for (Slot i = 0; i < sides; ++i) repair.certify(id * sides + i);
  }
  bool renew(Id id, Box box, Pen& repair);
  bool set_partners(Id id, std::vector<Id> partners, Pen& repair);

  AabbTreeOptions options_;
  PairListener listener_;
  BoxTree<TreeBox<Dimension>> tree_;
  std::vector<std::vector<Id>> partners_;  ///< by id, ascending
};

// ---------------------------------------------------------------------------------------------------------------

/// Gives an element a fat box. Returns whether that changes its pairs.
template <MovingElement E, std::size_t Dimension, class PairListener>
bool AabbTreeRule<E, Dimension, PairListener>::renew(Id id, Box box, Pen& repair) {
  for (std::size_t d = 0; d < Dimension; ++d) {
    box.min[d] -= options_.slack;
    box.max[d] += options_.slack;
  }
  if (tree_.contains(id)) {
    tree_.change(id, box);
  } else {
    tree_.insert(id, box);
  }
  if (id >= partners_.size()) partners_.resize(id + std::size_t{1});
  certify(id, repair);
  std::vector<Id> partners;
  tree_.visit(box, [&](Id other) {
    if (other != id) partners.push_back(other);
  });
  std::sort(partners.begin(), partners.end());
  return set_partners(id, std::move(partners), repair);
}

template <MovingElement E, std::size_t Dimension, class PairListener>
bool AabbTreeRule<E, Dimension, PairListener>::set_partners(Id id, std::vector<Id> partners, Pen& repair) {
  const std::vector<Id> before = std::exchange(partners_[id], std::move(partners));
  const std::vector<Id>& after = partners_[id];
  std::vector<Id> ended, began;
  std::set_difference(before.begin(), before.end(), after.begin(), after.end(), std::back_inserter(ended));
  std::set_difference(after.begin(), after.end(), before.begin(), before.end(), std::back_inserter(began));
  const auto place = [&](Id other) { return std::lower_bound(partners_[other].begin(), partners_[other].end(), id); };
  for (const Id other : ended) partners_[other].erase(place(other));
  for (const Id other : began) partners_[other].insert(place(other), id);
  for (const Id other : ended) {
    listener_.pair_ended(std::min(id, other), std::max(id, other), repair.now());
    repair.report(pair(PairChange::What::went, id, other));
  }
  for (const Id other : began) {
    listener_.pair_began(std::min(id, other), std::max(id, other), repair.now());
    repair.report(pair(PairChange::What::came, id, other));
  }
  return !ended.empty() || !began.empty();
}

template <MovingElement E, std::size_t Dimension, class PairListener>
auto AabbTreeRule<E, Dimension, PairListener>::pairs() const -> std::vector<std::array<Id, 2>> {
  std::vector<std::array<Id, 2>> pairs;
  for (Id a = 0; a < partners_.size(); ++a) {
    for (const Id b : partners_[a]) {
      if (a < b) pairs.push_back({a, b});
    }
  }
  return pairs;
}

template <MovingElement E, std::size_t Dimension, class PairListener>
bool AabbTreeRule<E, Dimension, PairListener>::meet(const E& a, const E& b, double t) {
  for (std::size_t d = 0; d < Dimension; ++d) {
    const auto a_min = end(a, d, false), a_max = end(a, d, true), b_min = end(b, d, false), b_max = end(b, d, true);
    using InOrder = certificates::InOrder<std::remove_cv_t<decltype(a_min)>>;
    if (exact_sign(InOrder{a_min, b_max}, t) < 0 || exact_sign(InOrder{b_min, a_max}, t) < 0) return false;
  }
  return true;
}

template <MovingElement E, std::size_t Dimension, class PairListener>
std::vector<Id> AabbTreeRule<E, Dimension, PairListener>::query(const Box& box, const MovingSet<E>& elements,
                                                                double now) const {
  std::vector<Id> found;
  tree_.visit(box, [&](Id id) {
    for (std::size_t d = 0; d < Dimension; ++d) {
      using Side = certificates::WithinLimit<decltype(end(elements[id], d, false))>;
      if (box.max[d] < never && exact_sign(Side{end(elements[id], d, false), box.max[d], 1}, now) < 0) return;
      if (box.min[d] > -never && exact_sign(Side{end(elements[id], d, true), box.min[d], -1}, now) < 0) return;
    }
    found.push_back(id);
  });
  std::sort(found.begin(), found.end());
  return found;
}

template <MovingElement E, std::size_t Dimension, class PairListener>
void AabbTreeRule<E, Dimension, PairListener>::audit(const MovingSet<E>& elements, double /*now*/) const {
  tree_.audit(name);
  for (Id id = 0; id < elements.end_id(); ++id) {
    if (tree_.contains(id) != elements.contains(id)) throw AuditFailure("AabbTree: an element is missing or gone");
    if (!elements.contains(id)) continue;
    std::vector<Id> partners;
    tree_.visit(tree_.box(id), [&](Id other) {
      if (other != id) partners.push_back(other);
    });
    std::sort(partners.begin(), partners.end());
    if (partners != partners_[id]) {
      throw AuditFailure("AabbTree: element " + std::to_string(id) + ": its pairs are others");
    }
  }
}

}  // namespace kds::structures
