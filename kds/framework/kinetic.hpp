// A kinetic structure made of a rule: everything but how to certify and how to repair. This file has the class and its
// events; kinetic_edits.hpp has edits, kinetic_standing.hpp structures on structures, kinetic_samples.hpp sampled
// elements, kinetic_audit.hpp audits, measures and snapshots.
#pragma once

#include "kds/audit.hpp"
#include "kds/events/schedule.hpp"
#include "kds/framework/kinetic_rule.hpp"
#include "kds/number_text.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace kds {

/// No certificate of the structure's own.
inline constexpr Slot no_slot = std::numeric_limits<Slot>::max();

/// A certificate that failed and was repaired; or one of sampled elements whose guarantee ended, so that they were
/// sampled anew (internal); or, with no_slot, an event of the structure that this one stands on.
struct KineticEvent {
  double time = 0;  ///< s
  Slot slot = 0;
  Effect effect = Effect::internal;

  friend bool operator==(const KineticEvent&, const KineticEvent&) = default;
};

/// A listener that does nothing. A listener is a function object called as listener(rule, event) after each event, when
/// the structure is valid again: it may look at the rule, and edit the elements, at the time of the event. What it
/// throws comes out of the step or edit that the event was part of; the event has been processed then.
struct NoListener {
  template <class Rule>
  void operator()(const Rule& /*rule*/, const KineticEvent& /*event*/) const {}
};

/// Makes a KineticStructure of a KineticRule: keeps the queue, certifies what the rule marks, takes up the edits of the
/// set of elements that it is attached to, counts, checks itself, and is saved and loaded.
///
/// Several structures may share a set; a Simulator runs them side by side. With sampled elements (Bounded) a failure
/// means that the certificate is no longer guaranteed: the rule is not asked to repair, but the elements are sampled
/// anew (MovingSet::sample_with); the state is that of the samples.
///
/// An exception from the rule leaves the structure invalid, and the one that it stands on: every event and edit after
/// that throws std::logic_error.
///
/// Cost of an event, beyond the rule's own: a pop, and for each certificate it marks a failure time and a push.
template <class Rule, class Listener = NoListener, EventQueue Queue = DefaultEventQueue, class Solver = CertifiedSolver>
class Kinetic final : public KineticOf<Rule>, private MovingSet<typename Rule::Element>::Observer {
  using Standing = detail::Standing<Rule>;
  using Choice = typename detail::CertificateOf<Rule>::type;
  static constexpr bool is_outer = OuterRule<Rule>;
  static_assert(detail::RightRule<Rule>::checked);
  static_assert(FailureTimeSolver<Solver>, "Kinetic: the solver is no FailureTimeSolver");

 public:
  using Element = typename Rule::Element;

  /// Takes up the elements that the set has at the time `now`, which is the clock: finite, and not before the last edit
  /// (neither is checked). The set must outlive the structure.
  explicit Kinetic(MovingSet<Element>& elements, double now, Rule rule = {}, Listener listener = {}) requires(!is_outer)
      : KineticOf<Rule>(elements, std::move(rule)), listener_(std::move(listener)), backwards_(elements.backwards()) {
    build(now);
  }
  /// For a rule that stands on others (StandsOn): takes up the states of structures of these, whose events up to `now`
  /// are processed first, and shares the elements of the first. `inners` is a structure if there is one, {a, b, c} if
  /// there are several; they must outlive it.
  Kinetic(typename Standing::Structures inners, double now, Rule rule = {}, Listener listener = {}) requires is_outer
      : Kinetic(first_of(inners), inners, now, std::move(rule), std::move(listener)) {}
  /// The same with elements of its own, of another type perhaps.
  Kinetic(MovingSet<Element>& elements, typename Standing::Structures inners, double now, Rule rule = {},
          Listener listener = {}) requires is_outer : KineticOf<Rule>(elements, std::move(rule)),
                                                      listener_(std::move(listener)),
                                                      backwards_(elements.backwards()) {
    stand_on(inners, now);
    build(now);
    follow_from_now_on();
  }
  ~Kinetic() {
    elements_.detach(*this);
    detail::for_each_place<Rule>([&](auto place) {
      std::erase(inner_at(place).followers_, static_cast<detail::Follower*>(this));
      --told_at(place).followers_;
    });
  }

  Listener& listener() { return listener_; }

  double next_time() const override { return schedule_.next_time(); }

  /// Processes the event due at next_time(). Precondition: there is one.
  void process();

  /// Calls f(rule, repair) at `now`, the clock: it may change what the rule is asked for (a rank, a border), mark slots
  /// and report changes, as any function of the rule. An edit like one of the elements, so after the events of its
  /// time; the rule's archive() must save what f changes. Throws as MovingSet::update() does for a time; f itself must
  /// not throw.
  template <class F>
  void edit(F&& f, double now) {
    elements_.process_due(now);
    alone(now, [&] { f(rule_, repair_); });
  }

  /// See KineticStructure. Cost: a failure time for each certificate that the change concerns.
  void extend_horizon(double now, double horizon);

  /// Certifies anew after all elements and the clock have been turned round: see reverse() in reverse.hpp. Certificates
  /// that do not hold then fail at once, so that the events of this time undo those that led to the state. Throws
  /// std::logic_error if the elements have not been turned round.
  void turn_round(double now, double horizon) requires Reversible<Element> {
    backwards_ = !backwards_;
    alone(now, [&] {
      schedule_.set_horizon(horizon);
      for (Slot slot = 0; slot < held_.size(); ++slot) {
        if (held_[slot]) certify(slot, false);
      }
    });
  }

  /// Checks every certificate and failure time with exact signs, and calls the rule's own audit(). Throws AuditFailure.
  /// Precondition: `now` is the clock.
  void audit(double now) const;

  Counters counters() const { return schedule_.counters(); }
  /// Counted so far; most_per_element is found now, in time linear in the certificates.
  Measures measures() const;

  /// Saves or loads the whole state of the structure. Needs a rule with archive().
  template <class Archive>
  void archive(Archive& archive);

 private:
  // How edits come in: kinetic_edits.hpp.
  void process_due(double now) override;
  void process_own_due(double now);
  void inserted(Id id, double now) override;
  void removing(Id id, double now) override;
  void changing(Id id, const Element& next, double now) override;
  void changed(Id id, double now) override;
  /// Throws if an event or edit is on its way, or the structure is invalid since a rule has thrown.
  void require_ready() const;
  void require_idle() const;

  // How changes reach structures that stand on this one: kinetic_standing.hpp.
  void stand_on(typename Standing::Structures& inners, double now);
  void build(double now);
  void follow_from_now_on();
  void tell_followers(detail::Wave& wave);
  void call_followers_listeners();
  void follow(double now, bool in_event, detail::Wave& wave) override;
  void forget_reports() override;
  void listen() override;
  bool untold() const override;
  void require_nothing_before(double now) const;
  void require_inner_first(double time) const;
  static MovingSet<Element>& first_of(const typename Standing::Structures& inners) requires is_outer {
    return std::get<0>(inners).elements_;
  }
  // What stands at a place of the rule, what it reports to this one, and how often it has.
  template <std::size_t I>
  auto& inner_at(From<I> /*place*/) const {
    return *std::get<I>(inners_);
  }
  template <std::size_t I>
  auto& told_at(From<I> place) const {
    return static_cast<detail::Reports<typename Rule::template HeardAt<I>>&>(inner_at(place).repair_);
  }
  template <std::size_t I>
  std::uint64_t& followed_at(From<I> /*place*/) {
    return followed_reports_[I];
  }
  template <std::size_t I>
  std::uint64_t followed_at(From<I> /*place*/) const {
    return followed_reports_[I];
  }
  template <class Place>
  static constexpr bool moves_at(Place /*place*/) {
    return detail::TypesAt<Rule, Place>::moves;
  }

  // Each call of a function of the rule stands between these two: marked slots are certified when it is over.
  void begin(double now) {
    require_idle();
    this->state_ = State::working;
    repair_.now_ = last_ = now;
  }
  void finish(bool in_event, detail::Wave& wave);
  /// A call that is not one of an event or of an edit of elements.
  template <class F>
  void alone(double now, F&& f) {
    require_ready();
    detail::Wave::Passage edit(this->wave());
    begin(now);
    f();
    finish(false, this->wave());
    edit.end(now, false);
  }
  void count_repair(Slot slot, double time);
  void count_touched() {
    measures_.touched += repair_.marked_.size();
    measures_.most_touched = std::max<std::uint64_t>(measures_.most_touched, repair_.marked_.size());
  }
  void certify(Slot slot, bool in_event);
  void hold(Slot slot, bool held);

  /// Whether the slot on top, which has this certificate, is due for a failure: not for a sample, and not too early.
  bool failed(Slot slot, const Choice& choice, double time, bool counts = true);
  /// Whether a certificate is the negative of the one that has just failed, and so known to be positive at t+.
  template <class C>
  bool has_turned(const C& certificate) const {
    bool turned = false;
    if constexpr (TellsItsNegative<C>) {
      if (failed_ == nullptr) return false;
      detail::with_certificate(*failed_, [&](const auto& failed) {
        if constexpr (std::same_as<decltype(failed), const C&>) {
          turned = certificate.is_negative_of(failed);
          if (turned) detail::check_is_negative_of(certificate, failed);
        }
      });
    }
    return turned;
  }

  // With sampled elements: kinetic_samples.hpp.
  template <class C>
  void certify_samples(Slot slot, const C& certificate);
  template <class C>
  double latest_sample(Slot slot, const C& certificate, double now) const;
  double soonest_sample(Slot slot) const;
  void sample_again(Slot slot, double time);

  [[noreturn]] static void fail_busy() {
    fail_use("its rule is at work, or has thrown: nothing can be edited from within it, and nothing after that");
  }
  [[noreturn]] static void fail_use(const std::string& what) { throw std::logic_error(Rule::name + (": " + what)); }

  using Mark = typename Repair<Element>::Mark;
  using State = detail::Follower::State;
  using KineticOf<Rule>::elements_;
  using KineticOf<Rule>::rule_;
  using KineticOf<Rule>::repair_;

  Listener listener_;
  Schedule<Queue, Solver> schedule_;
  std::vector<std::uint8_t> held_;  ///< whether a slot has a certificate
  Measures measures_;
  double last_ = -never;            ///< of the last change
  const Choice* failed_ = nullptr;  ///< the certificate that failed in the event that is processed
  bool backwards_ = false;
  bool keeps_ = false;  ///< whether the rule takes up a new motion without letting the element go
  double repaired_at_ = -never;
  std::uint64_t repairs_ = 0;             ///< at that time, since the last edit
  typename Standing::Pointers inners_{};  ///< what it stands on
  std::array<std::uint64_t, Standing::places> followed_reports_{};
  std::vector<KineticEvent> untold_;  ///< events that were followed, of which the listener has not heard
};

// ---------------------------------------------------------------------------------------------------------------

template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::process() {
  require_ready();
  const auto [time, slot] = schedule_.next();
  const Choice certificate = rule_.certificate(slot, elements_);
  KineticEvent event{time, slot, Effect::internal};
  if (!failed(slot, certificate, time)) {
    if constexpr (!Sampled<Element>) return;
    sample_again(slot, time);
  } else {
    require_inner_first(time);
    count_repair(slot, time);
    detail::Wave::Passage passage(this->wave());
    begin(time);
    failed_ = &certificate;
    event.effect = rule_.repair(slot, repair_);
    repair_.certify(slot);
    count_touched();
    finish(true, this->wave());
    passage.end(time, true);
  }
  ++measures_.events;
  measures_.external += event.effect == Effect::external;
  listener_(rule_, event);
  call_followers_listeners();
}

/// A right rule never comes near this limit: each repair removes a contradiction between state and signs, of which a
/// sorted list of n values, with m = 2 n certificates and elements, has n^2 / 2 = m^2 / 8 (its pairs).
template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::count_repair(Slot slot, double time) {
  if (repaired_at_ != time) repairs_ = 0;
  repaired_at_ = time;
  if (++repairs_ <= 1000) return;
  const std::uint64_t m = measures_.held + elements_.size();
  if (repairs_ > 1000 + m * m) {
    fail_use("slot " + std::to_string(slot) + ": repair() does not end: it has been called " +
             std::to_string(repairs_ - 1) + " times at " + number_text(time));
  }
}

template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::finish(bool in_event, detail::Wave& wave) {
  if (!repair_.marks_.empty() && held_.size() < repair_.marks_.size()) {
    held_.resize(repair_.marks_.size(), 0);
    schedule_.resize(repair_.marks_.size());
  }
  for (const Slot slot : repair_.marked_) {
    if (repair_.marks_[slot] == Mark::retire) {
      schedule_.clear(slot);
      hold(slot, false);
    } else {
      certify(slot, in_event);
    }
    repair_.marks_[slot] = Mark::none;
  }
  repair_.marked_.clear();
  if (!in_event) repairs_ = 0;
  failed_ = nullptr;
  measures_.most_held = std::max(measures_.most_held, measures_.held);
  wave.called(*this);
  tell_followers(wave);
  this->state_ = State::done;
}

template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::certify(Slot slot, bool in_event) {
  bool certified = false;
  detail::with_certificate(rule_.certificate(slot, elements_), [&](const auto& certificate) {
    certified = true;
    if constexpr (Sampled<Element>) {
      certify_samples(slot, certificate);
    } else {
      if (in_event) schedule_.look_for_late_events(certificate, last_);
      if (in_event && has_turned(certificate)) {
        assert(sign_after(certificate, last_) > 0);  // else not the negative, or a slot was not marked
        schedule_.certify_turned(slot, certificate, last_);
      } else {
        schedule_.certify(slot, certificate, last_);
      }
    }
  });
  if (!certified) schedule_.clear(slot);
  hold(slot, certified);
}

template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::hold(Slot slot, bool held) {
  measures_.held += held;
  measures_.held -= held_[slot];
  held_[slot] = held;
}

template <class Rule, class Listener, EventQueue Queue, class Solver>
bool Kinetic<Rule, Listener, Queue, Solver>::failed(Slot slot, const Choice& choice, double time, bool counts) {
  if constexpr (Sampled<Element> && !MovingSample<Element>) return false;  // Samples at rest never fail.
  bool failed = false;
  detail::with_certificate(choice, [&](const auto& certificate) {
    if constexpr (MovingSample<Element>) {
      const OfSamples<std::remove_cvref_t<decltype(certificate)>> of_samples{certificate};
      failed = sign_after(of_samples, time) < 0 && (!counts || schedule_.failed(slot, of_samples, time));
    } else if constexpr (!Sampled<Element>) {
      failed = schedule_.failed(slot, certificate, time);
    }
  });
  return failed;
}

template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::extend_horizon(double now, double horizon) {
  if (horizon == schedule_.horizon()) return;
  alone(now, [&] {
    schedule_.set_horizon(horizon);
    for (Slot slot = 0; slot < held_.size(); ++slot) {
      if (held_[slot] && schedule_.concerned(slot)) certify(slot, false);
    }
  });
}

}  // namespace kds

#include "kds/framework/kinetic_audit.hpp"
#include "kds/framework/kinetic_edits.hpp"
#include "kds/framework/kinetic_samples.hpp"
#include "kds/framework/kinetic_standing.hpp"
