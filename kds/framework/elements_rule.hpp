// A set of elements as something that rules of other elements can stand on.
#pragma once

#include "kds/framework/kinetic_rule.hpp"

#include <array>
#include <cstdint>
#include <variant>
#include <vector>

namespace kds {

/// What becomes of an element of a set.
struct ElementChange {
  enum class What : std::uint8_t { came, goes, moved };  ///< goes: it is still there; moved: it has its new motion
  What what;
  Id id;
};

/// Proves nothing, and tells what comes, goes and moves otherwise. So a rule may be about elements of two sets, of
/// different types: it has elements of its own and stands on the other set (points, and the rectangles that they are
/// in):
///
///     class InsideRule : public StandsOn<ElementsRule<Rectangle>> { using Element = Point; ... };
///     Kinetic<ElementsRule<Rectangle>> rectangles(rectangle_set, now);
///     Kinetic<InsideRule> inside(points, rectangles, now);
///     Simulator simulator(now, rectangles, inside);
///
/// Both sets are saved, and reversed, together. Elements of the other set must not be samples.
template <MovingElement E>
class ElementsRule {
  static_assert(!Sampled<E>, "ElementsRule: a rule names only elements of its own to be sampled, so these would not be");

 public:
  using Element = E;
  using Change = ElementChange;
  using Pen = Repair<E, Change>;
  static constexpr const char* name = "Elements";

  const MovingSet<E>& elements() const { return *elements_; }
  const E& operator[](Id id) const { return (*elements_)[id]; }

  std::monostate certificate(Slot /*slot*/, const MovingSet<E>& /*elements*/) const { return {}; }
  std::array<Id, 0> members(Slot /*slot*/) const { return {}; }
  Effect repair(Slot /*slot*/, Pen& /*repair*/) { return Effect::internal; }
  void build(Pen& repair) { elements_ = &repair.elements(); }
  void insert(Id id, Pen& repair) { repair.report({Change::What::came, id}); }
  void remove(Id id, Pen& repair) { repair.report({Change::What::goes, id}); }
  void change(Id id, Pen& repair) { repair.report({Change::What::moved, id}); }
  std::vector<Change> changes_from_nothing() const {
    std::vector<Change> changes;
    for (const Id id : elements_->ids()) changes.push_back({Change::What::came, id});
    return changes;
  }
  template <class Archive>
  void archive(Archive& /*archive*/) {}

 private:
  const MovingSet<E>* elements_ = nullptr;
};

}  // namespace kds
