// The part that the author of a kinetic structure writes: how to certify a slot, and how to repair when it fails.
#pragma once

#include "kds/bounded.hpp"
#include "kds/events/event_queue.hpp"
#include "kds/framework/archived_by.hpp"
#include "kds/framework/certificate_choice.hpp"
#include "kds/framework/measures.hpp"
#include "kds/framework/moving_set.hpp"
#include "kds/member_named.hpp"

#include <concepts>
#include <cstdint>
#include <iterator>
#include <type_traits>
#include <utility>
#include <vector>

namespace kds {

/// A change that a rule is making: its time, the elements, and the slots that have got a new certificate.
///
/// Slots that are marked are certified when the rule is done, each once: a rule may mark more slots than it must, in
/// any order, while its state is incomplete.
template <MovingElement E>
class Repair {
 public:
  double now() const { return now_; }
  const E& operator[](Id id) const { return elements_[id]; }
  const MovingSet<E>& elements() const { return elements_; }

  /// Sign of a certificate at now+, exact; of sampled elements that of their samples.
  template <class C>
  int sign(const C& certificate) const {
    return exact_sign(certificate, now_);
  }

  /// The slot's certificate has changed, or there is none any more: certificate() will be called for it.
  void certify(Slot slot) { mark(slot, Mark::certify); }
  /// The slot is given up: certificate() will not be called for it.
  void retire(Slot slot) { mark(slot, Mark::retire); }

  /// For rules made of rules: while `part` runs, its slot s is the slot first + stride * s of the whole. Returns what
  /// part() returns, which must not be void.
  template <class Part>
  auto nested(Slot first, Slot stride, Part&& part) {
    const Slot first_before = std::exchange(first_, first_ + stride_ * first);
    const Slot stride_before = std::exchange(stride_, stride_ * stride);
    const auto result = part();
    first_ = first_before;
    stride_ = stride_before;
    return result;
  }
  /// The slots marked so far, in the numbering of the whole.
  const std::vector<Slot>& marked() const { return marked_; }

 private:
  template <class, class, EventQueue, class>
  friend class Kinetic;
  enum class Mark : std::uint8_t { none, certify, retire };

  explicit Repair(const MovingSet<E>& elements) : elements_(elements) {}

  void mark(Slot slot, Mark what) {
    slot = first_ + stride_ * slot;
    if (slot >= marks_.size()) marks_.resize(slot + std::size_t{1}, Mark::none);
    if (marks_[slot] == Mark::none) marked_.push_back(slot);
    marks_[slot] = what;
  }

  const MovingSet<E>& elements_;
  std::vector<Slot> marked_;
  std::vector<Mark> marks_;
  double now_ = 0;
  Slot first_ = 0;
  Slot stride_ = 1;
};

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
concept Repairs = requires(R& rule, Slot slot, Repair<typename R::Element>& repair) {
  { rule.repair(slot, repair) } -> std::same_as<Effect>;
};
template <class R>
concept InsertsAndRemoves = requires(R& rule, Id id, Repair<typename R::Element>& repair) {
  rule.insert(id, repair);
  rule.remove(id, repair);
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
/// called.
///
/// Semantic laws: (1) certificates that hold, all of them, prove the state; (2) what a slot's certificate is depends on
/// the rule's state and the motions only; (3) repair() decides by exact signs at now+ (Repair::sign), and is called
/// only for a slot whose certificate has failed there; each call removes a contradiction between state and signs, and
/// makes none again that was removed at the same time (see docs/termination.md); (4) every slot whose certificate is
/// changed by a call has been marked in it; (5) insert, remove and change are called with a valid state; (6) none of
/// these functions edits the elements or throws (except audit(), and when memory is exhausted).
template <class R>
concept KineticRule = detail::NamesElement<R> && detail::HasName<R> && detail::Certifies<R> &&
    detail::NamesMembers<R> && detail::Repairs<R> && detail::InsertsAndRemoves<R>;

/// `void change(Id id, Repair<Element>& repair)`: take up a new motion of an element. Without it: remove and insert.
template <class R>
concept TakesUpMotions = requires(R& rule, Id id, Repair<typename R::Element>& repair) {
  { rule.change(id, repair) } -> std::same_as<void>;
};

/// `bool keeps(Id id, const Element& next, Repair<Element>& repair)`: whether change() can take up this motion; if not,
/// the element is removed and inserted. Called before either, with the old motion still in place. Only for a rule with
/// change(). Without it: change() takes up every motion.
template <class R>
concept ChoosesMotions = TakesUpMotions<R> &&
    requires(R& rule, Id id, const typename R::Element& next, Repair<typename R::Element>& repair) {
  { rule.keeps(id, next, repair) } -> std::same_as<bool>;
};

/// `void build(Repair<Element>& repair)`: take up all of repair.elements() at once. Without it: insert one after
/// another.
template <class R>
concept BuildsAtOnce = requires(R& rule, Repair<typename R::Element>& repair) {
  { rule.build(repair) } -> std::same_as<void>;
};

/// `void audit(const MovingSet<Element>& elements, double now) const`: throw AuditFailure if the rule's own state is
/// incoherent. Certificates and their times are checked without it.
template <class R>
concept AuditsItself = requires(const R& rule, const MovingSet<typename R::Element>& elements, double now) {
  { rule.audit(elements, now) } -> std::same_as<void>;
};

namespace detail {

KDS_MEMBER_NAMED(NamesChange, change);
KDS_MEMBER_NAMED(NamesKeeps, keeps);
KDS_MEMBER_NAMED(NamesBuild, build);
KDS_MEMBER_NAMED(NamesAudit, audit);

}  // namespace detail

}  // namespace kds
