// One structure on another: how the changes of a rule reach the rules that stand on it.
#pragma once

#include "kds/events/event_queue.hpp"
#include "kds/framework/moving_set.hpp"
#include "kds/framework/repair.hpp"

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace kds {

/// A rule that reports its changes to rules that stand on it: it has a `using Change`, gives them to
/// Repair<Element, Change>::report() in the calls that make them, and tells by `std::vector<Change>
/// changes_from_nothing() const` which would lead to its present state from that of no elements (with Changes<...>, a
/// std::tuple of such vectors). A change may be reported twice, or be undone by a later one of the same call.
template <class R>
concept ReportsChanges = requires {
  typename R::Change;
}
&&!std::is_void_v<typename R::Change>;

namespace detail {

/// The types of the changes that a rule reports, the first of them, and lists of each.
template <class R>
struct ChangeOf {
  using type = void;
  using first = void;
};
template <class Change>
struct ChangeTypes {
  using type = Change;
  using first = Change;
  using Lists = std::vector<Change>;
};
template <class First, class... Others>
struct ChangeTypes<Changes<First, Others...>> {
  using type = Changes<First, Others...>;
  using first = First;
  using Lists = std::tuple<std::vector<First>, std::vector<Others>...>;
};
template <ReportsChanges R>
struct ChangeOf<R> : ChangeTypes<typename R::Change> {};

/// Of a rule that may not have been instantiated yet: its size is asked for first, since in its own definition a rule
/// asks for its ChangeOf too.
template <class R, std::size_t = sizeof(R)>
using FirstChangeOf = typename ChangeOf<R>::first;

/// A structure that stands on another one, as that sees it.
class Follower {
 public:
  virtual void follow(double now, bool in_event) = 0;  ///< take up what the other reports now
  virtual void listen() = 0;                           ///< call the listener for the events that have been followed
  virtual void process_due(double now) = 0;
  virtual double next_time() const = 0;

 protected:
  ~Follower() = default;
};

}  // namespace detail

/// The base of an outer rule: one that stands on another, the inner one, which it reads and does not change.
///
///     template <class Path>
///     class ClosestPairRule : public StandsOn<DelaunayRule<Path>> { ... };
///
/// The outer structure is made on the inner one, Kinetic<Outer> outer(inner, now), and must not outlive it; several may
/// stand on one, and others on them. In a Simulator the inner one stands before the outer ones.
///
/// The inner rule reports what it changes (Repair::report), in a type of its own, `Change`. In the same event or edit,
/// when the inner rule is done and before any listener hears of it, the outer one gets
///
///     follow(changes, repair) -> Effect           take up what the inner rule has reported, in its order
///
/// and marks the slots whose certificates that changes. `changes` is a std::span<const Heard>. If the inner rule
/// reports changes of several types (Changes<...>), Heard is the one that the outer rule names, StandsOn<Inner, Heard>,
/// or else the first of them; of others it is not told.
///
/// It needs no insert() and remove(). If it has them, or a change(), they are called after follow(): when an element
/// has come; is to go, and is still there; or has its new motion (without change(): remove() and then insert()). It has
/// no build() and keeps().
///
/// Laws. (1) Whenever a function of the outer rule is called, inner() is valid: all its events up to that time have
/// been processed. So its state may be read at any time, and certificates may depend on it; but follow() must mark all
/// slots whose certificates have changed, which the changes must tell. (2) The first call is follow() with
/// inner().changes_from_nothing(); then insert() of each element, if there is one. (3) An outer rule changes neither
/// the inner one nor the elements. (4) At one time come the events of the inner structure first, then those of the
/// outer ones, each in the order of the simulator; an event of the inner one that is due again by then comes before
/// those too. (5) Listeners are called when all structures are valid: that of the inner structure first, then those of
/// the outer ones in the order in which they were made.
template <class InnerRule, class Told = detail::FirstChangeOf<InnerRule>>
class StandsOn {
 public:
  using Inner = InnerRule;
  using Heard = Told;
  using Element = typename Inner::Element;

  /// Precondition: a structure has been made of the rule.
  const Inner& inner() const { return *inner_; }

 private:
  template <class, class, EventQueue, class>
  friend class Kinetic;

  const Inner* inner_ = nullptr;
};

/// A rule that stands on another one.
template <class R>
concept OuterRule = requires {
  typename R::Inner;
  typename R::Heard;
}
&&std::derived_from<R, StandsOn<typename R::Inner, typename R::Heard>>;

/// What a rule is given when it changes something.
template <class R>
using RepairOf = Repair<typename R::Element, typename detail::ChangeOf<R>::type>;

/// A structure made of a rule, whatever its listener, queue and solver: what other structures stand on.
template <class Rule>
class KineticOf {
 public:
  using Element = typename Rule::Element;

  KineticOf(const KineticOf&) = delete;
  KineticOf& operator=(const KineticOf&) = delete;

  const Rule& rule() const { return rule_; }
  const MovingSet<Element>& elements() const { return elements_; }
  /// Time of the next event within the horizon, `never` if there is none.
  virtual double next_time() const = 0;

 protected:
  KineticOf(MovingSet<Element>& elements, Rule rule)
      : elements_(elements), rule_(std::move(rule)), repair_(elements) {}
  ~KineticOf() = default;

  MovingSet<Element>& elements_;
  Rule rule_;
  RepairOf<Rule> repair_;
  std::uint64_t reports_ = 0;  ///< how often it has told its followers of changes
  std::vector<detail::Follower*> followers_;

 private:
  template <class, class, EventQueue, class>
  friend class Kinetic;
};

namespace detail {

/// What a rule stands on: a structure made of the rule `Inner`, which reports changes; and whether it has elements of
/// which more than samples are known.
template <class R>
struct Standing {
  struct Change {};
  struct Inner {};
  struct Structure {  // of which there is none
    MovingSet<typename R::Element>& elements_;
  };
  static constexpr bool on_motions = false;
};
template <OuterRule R>
struct Standing<R> {
  using Inner = typename R::Inner;
  using Structure = KineticOf<Inner>;
  using Change = typename R::Heard;
  static constexpr bool on_motions = !Sampled<typename Inner::Element>;
};

}  // namespace detail

}  // namespace kds
