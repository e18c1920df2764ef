// How a structure made of a rule tells those that stand on it of its changes, and takes up those of the one that it
// stands on.
#pragma once

#include "kds/framework/kinetic.hpp"
#include "kds/number_text.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace kds {

// An event or edit of a structure ends in finish(): its certificates are made, and its followers told to wait for their
// turn in the wave (wave.hpp), in which each is called when all that it stands on have been. Listeners are called when
// the wave is over. Events and edits with reports are counted on both sides, so that a structure that has missed one
// (it was loaded from a snapshot without the other, say) is noticed.

template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::stand_on(typename Standing::Structures& inners, double now) {
  detail::for_each_place<Rule>([&]<std::size_t I>(From<I>) {
    auto& inner = std::get<I>(inners);
    inner.elements_.process_due(now);
    std::get<I>(inners_) = &inner;
    std::get<I>(this->rule_.inners_) = &inner.rule();
  });
  // Only then: a listener of one may have changed another.
  detail::for_each_place<Rule>([&](auto place) { followed_at(place) = inner_at(place).reports_; });
}

/// The first call of the rule.
template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::build(double now) {
  alone(now, [&] {
    detail::for_each_place<Rule>([&](auto place) {
      using List = std::vector<typename detail::TypesAt<Rule, decltype(place)>::Heard>;
      const auto changes = inner_at(place).rule().changes_from_nothing();
      if constexpr (std::same_as<decltype(changes), const List>) {
        detail::follow_at(this->rule_, place, changes, this->repair_);
      } else {
        detail::follow_at(this->rule_, place, std::get<List>(changes), this->repair_);
      }
    });
    if constexpr (ActsWhenFollowed<Rule>) rule_.followed(repair_);
    if constexpr (BuildsAtOnce<Rule>) {
      rule_.build(repair_);
    } else if constexpr (detail::Inserts<Rule>) {
      for (const Id id : elements_.ids()) rule_.insert(id, repair_);
    }
  });
  elements_.attach(*this);
}

template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::follow_from_now_on() {
  detail::for_each_place<Rule>([&](auto place) {
    inner_at(place).followers_.push_back(this);
    ++told_at(place).followers_;
  });
}

/// A rule may be called more than once in an edit, by follow() and as one of its elements is edited.
template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::tell_followers(detail::Wave& wave) {
  if constexpr (ReportsChanges<Rule>) {
    if (!repair_.has_reports()) return;
    if (!std::exchange(this->reported_, true)) ++this->reports_;
    for (auto* follower : this->followers_) wave.await(*follower);
  }
}

template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::forget_reports() {
  this->reported_ = false;
  if constexpr (ReportsChanges<Rule>) repair_.clear_reports();
}

/// A listener may let structures come and go.
template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::call_followers_listeners() {
  if constexpr (ReportsChanges<Rule>) {
    for (std::size_t i = 0; i < this->followers_.size(); ++i) this->followers_[i]->listen();
  }
}

template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::follow(double now, bool in_event, detail::Wave& wave) {
  require_nothing_before(now);
  bool told = false;
  detail::for_each_place<Rule>([&](auto place) {
    followed_at(place) += inner_at(place).reported_;
    told = told || !told_at(place).changes_.empty();
  });
  if (!told) return;  // It is told of other changes.
  begin(now);
  repairs_ = 0;
  Effect effect = Effect::internal;
  detail::for_each_place<Rule>([&](auto place) {
    if (told_at(place).changes_.empty()) return;
    if (detail::follow_at(this->rule_, place, told_at(place).changes_, this->repair_) == Effect::external)
      effect = Effect::external;
  });
  if constexpr (ActsWhenFollowed<Rule>) {
    if (rule_.followed(repair_) == Effect::external) effect = Effect::external;
  }
  if (in_event) {
    ++measures_.followed;
    count_touched();
    measures_.external += effect == Effect::external;
    if constexpr (!std::same_as<Listener, NoListener>) untold_.push_back({now, no_slot, effect});
  }
  finish(in_event, wave);
}

/// An edit by a listener may bring further events, whose own calls then tell of this one too. A structure on several is
/// reached through each of them, and waits for the last.
template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::listen() {
  if constexpr (Standing::places > 1) {
    bool early = false;
    detail::for_each_place<Rule>([&](auto place) { early = early || inner_at(place).untold(); });
    if (early) return;
  }
  const std::vector<KineticEvent> events = std::exchange(untold_, {});
  for (const KineticEvent& event : events) listener_(rule_, event);
  call_followers_listeners();
}

template <class Rule, class Listener, EventQueue Queue, class Solver>
bool Kinetic<Rule, Listener, Queue, Solver>::untold() const {
  bool result = !untold_.empty();
  detail::for_each_place<Rule>([&](auto place) { result = result || inner_at(place).untold(); });
  return result;
}

/// An event of its own, or of a structure that it stands on, that has been passed over. Samples of such a structure
/// that are due can wait.
template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::require_nothing_before(double now) const {
  double first = next_time();
  detail::for_each_place<Rule>([&](auto place) {
    if (moves_at(place)) first = std::min(first, inner_at(place).next_time());
  });
  if (first < now) {
    fail_use("what it stands on has passed over the event at " + number_text(first) +
             ": all of them must be in one simulator");
  }
}

template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::require_inner_first(double time) const {
  detail::for_each_place<Rule>([&](auto place) {
    if (!moves_at(place) || inner_at(place).next_time() > time) return;
    fail_use("an event at " + number_text(time) + " comes before that at " + number_text(inner_at(place).next_time()) +
             " of a structure that it stands on, which must stand before it in the simulator");
  });
}

}  // namespace kds
