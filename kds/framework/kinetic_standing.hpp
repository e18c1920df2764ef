// How a structure made of a rule tells those that stand on it of its changes, and takes up those of the one that it
// stands on.
#pragma once

#include "kds/framework/kinetic.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace kds {

// An event or edit of an inner structure ends in finish(): its certificates are made, then its followers follow, each
// with its own followers, and only then are listeners called. Reports are counted on both sides, so that a structure
// that has missed one (it was loaded from a snapshot without the other, say) is noticed.

/// The first call of the rule.
template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::build(double now) {
  if constexpr (is_outer) followed_reports_ = inner_->reports_;
  begin(now);
  if constexpr (is_outer) {
    using List = std::vector<typename Standing::Change>;
    const auto changes = inner_->rule().changes_from_nothing();
    if constexpr (std::same_as<decltype(changes), const List>) {
      rule_.follow(std::span(changes), repair_);
    } else {
      rule_.follow(std::span(std::get<List>(changes)), repair_);
    }
  }
  if constexpr (BuildsAtOnce<Rule>) {
    rule_.build(repair_);
  } else if constexpr (detail::Inserts<Rule>) {
    for (const Id id : elements_.ids()) rule_.insert(id, repair_);
  }
  finish(false);
  elements_.attach(*this);
}

template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::tell_followers(bool in_event) {
  if constexpr (ReportsChanges<Rule>) {
    if (!repair_.has_reports()) return;
    ++this->reports_;
    for (auto* follower : this->followers_) follower->follow(last_, in_event);
    repair_.clear_reports();
  }
}

/// A listener may let structures come and go.
template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::call_followers_listeners() {
  if constexpr (ReportsChanges<Rule>) {
    for (std::size_t i = 0; i < this->followers_.size(); ++i) this->followers_[i]->listen();
  }
}

template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::follow(double now, bool in_event) {
  if constexpr (is_outer) {
    if (next_time() < now) {
      fail_use("the structure that it stands on has passed over its event at " + std::to_string(next_time()) +
               ": both must be in one simulator");
    }
    ++followed_reports_;
    const std::span<const typename Standing::Change> changes = told().changes_;
    if (changes.empty()) return;  // It is told of other changes.
    begin(now);
    repairs_ = 0;
    const Effect effect = rule_.follow(changes, repair_);
    if (in_event) {
      ++measures_.followed;
      count_touched();
      measures_.external += effect == Effect::external;
      if constexpr (!std::same_as<Listener, NoListener>) untold_.push_back({now, no_slot, effect});
    }
    finish(in_event);
  }
}

/// An edit by a listener may bring further events, whose own calls then tell of this one too.
template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::listen() {
  const std::vector<KineticEvent> events = std::exchange(untold_, {});
  for (const KineticEvent& event : events) listener_(rule_, event);
  call_followers_listeners();
}

/// Samples of the inner structure that are due can wait.
template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::require_inner_first(double time) const {
  if constexpr (Standing::on_motions) {
    if (inner_->next_time() > time) return;
    fail_use("an event at " + std::to_string(time) + " comes before that at " + std::to_string(inner_->next_time()) +
             " of the structure that it stands on, which must stand before it in the simulator");
  }
}

}  // namespace kds
