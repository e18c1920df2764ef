// One structure on another: how the changes of a rule reach the rules that stand on it.
#pragma once

#include "kds/events/event_queue.hpp"
#include "kds/framework/measures.hpp"
#include "kds/framework/moving_set.hpp"
#include "kds/framework/repair.hpp"
#include "kds/framework/wave.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
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

}  // namespace detail

/// An inner rule that reports changes of several types (Changes<...>), and the one of them of which an outer rule is
/// told. Without it an outer rule is told of the first.
template <class InnerRule, class Change>
struct Telling {};

/// Names one of the inner rules of an outer one: the I-th, from 0.
template <std::size_t I>
struct From {
  explicit From() = default;
};

namespace detail {

/// An inner rule as StandsOn names it: the rule, and the changes that are heard.
template <class InnerRule>
struct Told {
  using Rule = InnerRule;
  using Change = FirstChangeOf<InnerRule>;
};
template <class InnerRule, class Heard>
struct Told<Telling<InnerRule, Heard>> {
  using Rule = InnerRule;
  using Change = Heard;
};

}  // namespace detail

/// The base of an outer rule: one that stands on others, the inner ones, which it reads and does not change.
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
/// reports changes of several types (Changes<...>), Heard is the one that the outer rule names,
/// StandsOn<Telling<Inner, Heard>>, or else the first of them; of others it is not told.
///
/// A rule may stand on several, StandsOn<A, B, Telling<C, Heard>>: Kinetic<Outer> outer({a, b, c}, now). It names them
/// by their places: inner(From<1>()) is B, and
///
///     follow(From<1>, changes, repair) -> Effect
///
/// takes up what B has reported; there is one for each. What depends on several of them is taken up when all have told
/// theirs, by
///
///     followed(repair) -> Effect                  called after the last follow(), if the rule has it
///
/// and the whole is external if any of these calls is. The elements are those of A, if it is given none of its own. Two
/// places may be of one structure (of which it hears changes of two types), and one inner structure may stand on
/// another.
///
/// It needs no insert() and remove(). If it has them, or a change(), they are called after follow(): when an element
/// has come; is to go, and is still there; or has its new motion (without change(): remove() and then insert()). It has
/// no build() and keeps().
///
/// Laws. (1) Whenever insert(), remove(), change() or repair() of the outer rule is called, inner() is valid, and so
/// are all inner rules: all their events up to that time have been processed. Certificates may depend on them; but
/// follow() must mark all slots whose certificates have changed, which the changes must tell. (2) In one event or edit
/// the outer rule is called after all inner ones: then follow() once for each place whose rule has reported something,
/// in the order of the places; followed(); then its own insert(), remove() or change(). So at each call all inner rules
/// have taken up the same event or edit. Certificates are made when follow() has been called for the last place, and
/// followed(). (3) Events of one time are taken up one by one, in the order of the simulator: those of A, then those of
/// B, then those of the outer rule; an event of an inner rule that is due again by then comes before those too. While
/// follow() is called, inner rules may have further events of this time, of which it will be told. (4) The first calls
/// are follow() with inner().changes_from_nothing(), for each place; followed(); and insert() of each element, if there
/// is one. (5) An outer rule changes neither the inner ones nor the elements. (6) Listeners are called when all
/// structures are valid, that of a structure after those of the structures that it stands on.
template <class... Inners>
class StandsOn {
  template <std::size_t I>
  using ToldBy = detail::Told<std::tuple_element_t<I, std::tuple<Inners...>>>;

 public:
  template <std::size_t I>
  using InnerAt = typename ToldBy<I>::Rule;
  template <std::size_t I>
  using HeardAt = typename ToldBy<I>::Change;
  using Inner = InnerAt<0>;
  using Heard = HeardAt<0>;
  using Element = typename Inner::Element;

  /// Precondition: a structure has been made of the rule.
  template <std::size_t I = 0>
  const InnerAt<I>& inner(From<I> /*place*/ = From<I>()) const {
    return *std::get<I>(inners_);
  }

 private:
  template <class, class, EventQueue, class>
  friend class Kinetic;

  std::tuple<const typename detail::Told<Inners>::Rule*...> inners_{};
};

namespace detail {

template <class... Inners>
StandsOn<Inners...> standing(const StandsOn<Inners...>&);

}  // namespace detail

/// A rule that stands on others.
template <class R>
concept OuterRule = requires(const R& rule) {
  detail::standing(rule);
};

/// What a rule is given when it changes something.
template <class R>
using RepairOf = Repair<typename R::Element, typename detail::ChangeOf<R>::type>;

/// A structure made of a rule, whatever its listener, queue and solver: what other structures stand on.
template <class Rule>
class KineticOf : protected detail::Follower {
 public:
  using Element = typename Rule::Element;

  const Rule& rule() const { return rule_; }
  const MovingSet<Element>& elements() const { return elements_; }
  /// Time of the next event within the horizon, `never` if there is none.
  virtual double next_time() const = 0;

 protected:
  KineticOf(MovingSet<Element>& elements, Rule rule) : elements_(elements), rule_(std::move(rule)), repair_(elements) {}
  ~KineticOf() = default;

  /// Whether a listener, its own or of one that it stands on, has not heard of all events yet.
  virtual bool untold() const = 0;
  detail::Wave& wave() { return elements_.wave_; }

  MovingSet<Element>& elements_;
  Rule rule_;
  RepairOf<Rule> repair_;
  std::uint64_t reports_ = 0;  ///< in how many events and edits it has reported changes
  bool reported_ = false;      ///< in that which is on its way
  std::vector<detail::Follower*> followers_;

 private:
  template <class, class, EventQueue, class>
  friend class Kinetic;
};

namespace detail {

/// What a rule stands on: structures made of inner rules, which report changes.
template <class Base>
struct StandingOn {
  static constexpr std::size_t places = 0;
  using Pointers = std::tuple<>;
  struct Structure {};
  struct Structures {};  // of which there are none
};
template <class... Inners>
struct StandingOn<StandsOn<Inners...>> {
  static constexpr std::size_t places = sizeof...(Inners);
  using Pointers = std::tuple<KineticOf<typename Told<Inners>::Rule>*...>;
  using Structures = std::tuple<KineticOf<typename Told<Inners>::Rule>&...>;
};
template <class R>
struct Standing : StandingOn<void> {};
template <OuterRule R>
struct Standing<R> : StandingOn<decltype(standing(std::declval<const R&>()))> {};

/// Of a place of a rule: what it hears from there, and whether more than samples are known of the elements.
template <class R, class Place>
struct TypesAt;
template <class R, std::size_t I>
struct TypesAt<R, From<I>> {
  using Heard = typename R::template HeardAt<I>;
  static constexpr bool moves = !Sampled<typename R::template InnerAt<I>::Element>;
};

/// Calls f(From<0>()), f(From<1>()) ... for each rule that R stands on.
template <class R, class F>
void for_each_place(F&& f) {
  [&]<std::size_t... I>(std::index_sequence<I...>) { (f(From<I>()), ...); }
  (std::make_index_sequence<Standing<R>::places>());
}

/// Calls the rule's follow() for a place.
template <class R, std::size_t I>
Effect follow_at(R& rule, From<I> place, std::span<const typename R::template HeardAt<I>> changes,
                 RepairOf<R>& repair) {
  if constexpr (Standing<R>::places == 1) {
    return rule.follow(changes, repair);
  } else {
    return rule.follow(place, changes, repair);
  }
}

}  // namespace detail

}  // namespace kds
