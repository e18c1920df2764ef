// The part that the author of a kinetic structure writes: how to certify a slot, and how to repair when it fails.
#pragma once

#include "kds/bounded.hpp"
#include "kds/events/event_queue.hpp"
#include "kds/framework/archived_by.hpp"
#include "kds/framework/certificate_choice.hpp"
#include "kds/framework/measures.hpp"
#include "kds/framework/moving_set.hpp"
#include "kds/framework/standing_on.hpp"
#include "kds/member_named.hpp"

#include <concepts>
#include <cstddef>
#include <iterator>
#include <span>
#include <type_traits>
#include <utility>

namespace kds {

namespace detail {

// One concept a part of a rule, so that Kinetic can name the part that is missing.
template <class R>
concept NamesElement = requires {
  typename R::Element;
}
&&MovingElement<typename R::Element>;
template <class R>
concept HasName = requires {
  { R::name } -> std::convertible_to<const char*>;
};
template <class R>
concept Certifies = requires(const R& rule, Slot slot, const MovingSet<typename R::Element>& elements) {
  {rule.certificate(slot, elements)};
  requires IsCertificateChoice<std::remove_cvref_t<decltype(rule.certificate(slot, elements))>>::value;
};
template <class R>
concept NamesMembers = requires(const R& rule, Slot slot) {
  { *std::begin(rule.members(slot)) } -> std::convertible_to<Id>;
};
template <class R>
concept Repairs = requires(R& rule, Slot slot, RepairOf<R>& repair) {
  { rule.repair(slot, repair) } -> std::same_as<Effect>;
};
template <class R>
concept Inserts = requires(R& rule, Id id, RepairOf<R>& repair) {
  rule.insert(id, repair);
};
template <class R>
concept Removes = requires(R& rule, Id id, RepairOf<R>& repair) {
  rule.remove(id, repair);
};
template <class R, std::size_t I>
concept IsTold = ReportsChanges<typename R::template InnerAt<I>>;
template <class R, std::size_t I>
concept HearsWhatIsReported =
    std::derived_from<RepairOf<typename R::template InnerAt<I>>, Reports<typename R::template HeardAt<I>>>;
template <class R, std::size_t I>
concept FollowsAt = requires(R& rule, std::span<const typename R::template HeardAt<I>> changes, RepairOf<R>& repair) {
  { rule.follow(From<I>(), changes, repair) } -> std::same_as<Effect>;
};
template <class R>
concept FollowsOne = requires(R& rule, std::span<const typename R::Heard> changes, RepairOf<R>& repair) {
  { rule.follow(changes, repair) } -> std::same_as<Effect>;
};

/// Whether all inner rules of R report something; report what it is to hear; and R follows each.
template <class R, class Places = std::make_index_sequence<Standing<R>::places>>
struct OfAllPlaces;
template <class R, std::size_t... I>
struct OfAllPlaces<R, std::index_sequence<I...>> {
  static constexpr bool told = (IsTold<R, I> && ...);
  static constexpr bool hears = (HearsWhatIsReported<R, I> && ...);
  static constexpr bool follows = (FollowsAt<R, I> && ...);
};
template <class R>
struct OfAllPlaces<R, std::index_sequence<0>> {
  static constexpr bool told = IsTold<R, 0>;
  static constexpr bool hears = HearsWhatIsReported<R, 0>;
  static constexpr bool follows = FollowsOne<R>;
};
template <class R>
concept Follows = OuterRule<R> && OfAllPlaces<R>::told && OfAllPlaces<R>::follows;
template <class R>
concept TakesElements = Follows<R> ||(Inserts<R>&& Removes<R>);
template <class R>
concept TellsItsState = requires(const R& rule) {
  { rule.changes_from_nothing() } -> std::same_as<typename ChangeOf<R>::Lists>;
};

template <class R>
struct CertificateOf {
  using type = std::monostate;
};
template <class R>
requires requires(const R& rule, Slot slot, const MovingSet<typename R::Element>& elements) {
  rule.certificate(slot, elements);
}
struct CertificateOf<R> {
  using type = std::remove_cvref_t<decltype(std::declval<const R&>().certificate(
      Slot{}, std::declval<const MovingSet<typename R::Element>&>()))>;
  static constexpr bool checked = RightCertificate<type>::checked;
};

}  // namespace detail

/// The part of a kinetic structure that its author writes; Kinetic<Rule> makes a structure of it.
///
///     static constexpr const char* name           what messages call it
///     using Element                               what moves
///     certificate(slot, elements) const           the slot's fact: a certificate; std::optional or std::variant of
///                                                 them (with std::monostate) where there may be none, or several kinds
///     members(slot) const                         ids of the elements that the slot's certificate is about, as a range
///     repair(slot, repair) -> Effect              repair the state, and mark the slots whose certificates are new
///     insert(id, repair), remove(id, repair)      take up an element; let one go, which is still there
///
/// and, optionally, what the concepts below describe: change, keeps, build, audit; and archive, so that it can be saved
/// (ArchivedBy). A member with one of these names that does not fit its concept does not compile: it would never be
/// called. A rule on which others stand has a Change (ReportsChanges); one that stands on another has follow() in place
/// of insert and remove (StandsOn).
///
/// Semantic laws: (1) certificates that hold, all of them, prove the state; (2) what a slot's certificate is depends on
/// the rule's state and the motions only; (3) repair() decides by exact signs at now+ (Repair::sign), and is called
/// only for a slot whose certificate has failed there; each call removes a contradiction between state and signs, and
/// makes none again that was removed at the same time (see docs/termination.md), so that there are at most m^2 at one
/// time, for m certificates and elements; (4) every slot whose certificate is
/// changed by a call has been marked in it; (5) insert, remove and change are called with a valid state; (6) none of
/// these functions edits the elements or throws (except audit(), and when memory is exhausted).
template <class R>
concept KineticRule = detail::NamesElement<R> && detail::HasName<R> && detail::Certifies<R> &&
    detail::NamesMembers<R> && detail::Repairs<R> && detail::TakesElements<R>;

/// `void change(Id id, Repair<Element>& repair)`: take up a new motion of an element. Without it: remove and insert.
template <class R>
concept TakesUpMotions = requires(R& rule, Id id, RepairOf<R>& repair) {
  { rule.change(id, repair) } -> std::same_as<void>;
};

/// `bool keeps(Id id, const Element& next, Repair<Element>& repair)`: whether change() can take up this motion; if not,
/// the element is removed and inserted. Called before either, with the old motion still in place. Only for a rule with
/// change(). Without it: change() takes up every motion.
template <class R>
concept ChoosesMotions = TakesUpMotions<R> &&
    requires(R& rule, Id id, const typename R::Element& next, RepairOf<R>& repair) {
  { rule.keeps(id, next, repair) } -> std::same_as<bool>;
};

/// `void build(Repair<Element>& repair)`: take up all of repair.elements() at once. Without it: insert one after
/// another.
template <class R>
concept BuildsAtOnce = requires(R& rule, RepairOf<R>& repair) {
  { rule.build(repair) } -> std::same_as<void>;
};

/// `void audit(const MovingSet<Element>& elements, double now) const`: throw AuditFailure if the rule's own state is
/// incoherent. Certificates and their times are checked without it.
template <class R>
concept AuditsItself = requires(const R& rule, const MovingSet<typename R::Element>& elements, double now) {
  { rule.audit(elements, now) } -> std::same_as<void>;
};

/// `Effect followed(Repair<Element>& repair)`: called after the last follow() of an event or edit, when all inner rules
/// have told what they had to tell, and in the beginning. Only for a rule that stands on others. Without it: each
/// follow() takes up its changes at once.
template <class R>
concept ActsWhenFollowed = OuterRule<R> && requires(R& rule, RepairOf<R>& repair) {
  { rule.followed(repair) } -> std::same_as<Effect>;
};

namespace detail {

KDS_MEMBER_NAMED(NamesChange, change);
KDS_MEMBER_NAMED(NamesFollowed, followed);
KDS_MEMBER_NAMED(NamesKeeps, keeps);
KDS_MEMBER_NAMED(NamesBuild, build);
KDS_MEMBER_NAMED(NamesAudit, audit);

/// To be named wherever a structure is made of a rule: compiles only for rules, and says what is wrong with a class
/// that is none, or which part of a rule would never be called.
template <class Rule>
struct RightRule {
  static_assert(NamesElement<Rule>, "kinetic rule: `using Element = ...;` must name what moves");
  static_assert(HasName<Rule>, "kinetic rule: `static constexpr const char* name = ...;` is missing");
  static_assert(CertificateOf<Rule>::checked);
  static_assert(Certifies<Rule>,
                "kinetic rule: `certificate(Slot, const MovingSet<Element>&) const` must give a certificate, or a "
                "std::optional or std::variant of certificates");
  static_assert(NamesMembers<Rule>, "kinetic rule: `members(Slot) const` must give a range of ids");
  static_assert(
      Repairs<Rule>,
      "kinetic rule: `Effect repair(Slot, Repair<Element>&)` is missing, or takes its argument by value or of another "
      "type: RepairOf<Rule>& is right");
  static_assert(
      OuterRule<Rule> || (Inserts<Rule> && Removes<Rule>),
      "kinetic rule: `insert(Id, Repair<Element>&)` and `remove(Id, Repair<Element>&)` are missing, or take another "
      "argument than RepairOf<Rule>&");
  static_assert(!OuterRule<Rule> || OfAllPlaces<Rule>::told,
                "kinetic rule: a rule that it stands on has no `Change`, and so tells nothing");
  static_assert(!OuterRule<Rule> || !OfAllPlaces<Rule>::told || OfAllPlaces<Rule>::hears,
                "kinetic rule: a rule that it stands on does not report the change that `Telling` names");
  static_assert(
      !OuterRule<Rule> || Follows<Rule>,
      "kinetic rule: `Effect follow(std::span<const Inner::Change>, Repair<Element>&)` is missing (if it stands "
      "on several rules, `Effect follow(From<I>, std::span<const Change>, Repair<Element>&)` for each)");
  static_assert(
      ActsWhenFollowed<Rule> || !NamesFollowed<Rule>,
      "kinetic rule: `followed` must be `Effect followed(Repair<Element>&)`, of a rule that stands on others");
  static_assert(!ReportsChanges<Rule> || TellsItsState<Rule>,
                "kinetic rule: `std::vector<Change> changes_from_nothing() const` is missing");
  static_assert(TakesUpMotions<Rule> || !NamesChange<Rule>,
                "kinetic rule: `change` must be `void change(Id, Repair<Element>&)`");
  static_assert(TakesUpMotions<Rule> || !NamesKeeps<Rule>,
                "kinetic rule: `change(Id, Repair<Element>&)` is missing, which a rule with `keeps` must have");
  static_assert(ChoosesMotions<Rule> || !NamesKeeps<Rule>,
                "kinetic rule: `keeps` must be `bool keeps(Id, const Element& next, Repair<Element>&)`");
  static_assert(BuildsAtOnce<Rule> || !NamesBuild<Rule>,
                "kinetic rule: `build` must be `void build(Repair<Element>&)`");
  static_assert(AuditsItself<Rule> || !NamesAudit<Rule>,
                "kinetic rule: `audit` must be `void audit(const MovingSet<Element>&, double now) const`");
  static constexpr bool checked = true;
};

}  // namespace detail

}  // namespace kds
