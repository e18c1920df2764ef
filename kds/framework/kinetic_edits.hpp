// How a structure made of a rule takes up the edits of its set of elements.
#pragma once

#include "kds/framework/kinetic.hpp"
#include "kds/number_text.hpp"

#include <stdexcept>
#include <string>
#include <vector>

namespace kds {

// The set calls process_due(), with the elements as they were; makes the edit; and reports it: inserted(), removing()
// while the element is still there, or changing() before and changed() after it has its new motion. Law: an edit comes
// after the events of its time. So the rule is called with a valid state, and marks what the edit changes. A new motion
// that the rule does not keep (ChoosesMotions), or any if it cannot (TakesUpMotions), is a removal before the change
// and an insertion after it.

template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::inserted(Id id, double now) {
  this->wave().follow_up_to(*this, now);
  begin(now);
  if constexpr (detail::Inserts<Rule>) rule_.insert(id, repair_);
  finish(false, this->wave());
}

template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::removing(Id id, double now) {
  this->wave().follow_up_to(*this, now);
  begin(now);
  if constexpr (detail::Removes<Rule>) rule_.remove(id, repair_);
  finish(false, this->wave());
}

/// The change is one call of the rule in two parts: it is finished in changed(). A rule that stands on another one is
/// called when that has taken up the new motion, and so only then.
template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::changing(Id id, const Element& next, double now) {
  if constexpr (!is_outer) {
    begin(now);
    keeps_ = TakesUpMotions<Rule>;
    if constexpr (ChoosesMotions<Rule>) keeps_ = rule_.keeps(id, next, repair_);
    if (!keeps_) rule_.remove(id, repair_);
  }
}

template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::changed(Id id, double now) {
  if constexpr (is_outer) {
    this->wave().follow_up_to(*this, now);
    begin(now);
    if constexpr (TakesUpMotions<Rule>) {
      rule_.change(id, repair_);
    } else {
      if constexpr (detail::Removes<Rule>) rule_.remove(id, repair_);
      if constexpr (detail::Inserts<Rule>) rule_.insert(id, repair_);
    }
  } else {
    if constexpr (TakesUpMotions<Rule>) {
      if (keeps_) rule_.change(id, repair_);
    }
    if (!keeps_) rule_.insert(id, repair_);
  }
  finish(false, this->wave());
}

template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::require_ready() const {
  if (this->state_ != State::ready) fail_busy();
  require_idle();
}

template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::require_idle() const {
  if (this->state_ == State::working) fail_busy();
  if (elements_.backwards() != backwards_) fail_use("its elements have been turned round without it");
  detail::for_each_place<Rule>([&](auto place) {
    if (inner_at(place).reports_ != followed_at(place))
      fail_use("a structure that it stands on has changed without it");
  });
}

/// The structures that it stands on first, and in the end those that stand on it: they may have other sets of elements.
/// An edit may reach each of these, so what is due in them, and in what they stand on, is processed before.
template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::process_due(double now) {
  detail::for_each_place<Rule>([&](auto place) {
    auto& inner = inner_at(place);
    if (moves_at(place) && inner.next_time() <= now) inner.process_due(now);
  });
  process_own_due(now);
  if constexpr (ReportsChanges<Rule>) {
    for (std::size_t i = 0; i < this->followers_.size(); ++i) this->followers_[i]->process_due(now);
  }
}

/// Processes the failures that are due up to now. Samples that are due can wait until after the edit.
template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::process_own_due(double now) {
  require_ready();
  if (now < last_) {
    fail_use("an edit at " + number_text(now) + " comes after a change at " + number_text(last_));
  }
  if (next_time() < now) {
    fail_use("an edit at " + number_text(now) + " would pass over an event at " + number_text(next_time()));
  }
  if constexpr (Sampled<Element> && !MovingSample<Element>) return;  // Such samples never fail.
  // Slots that are due for a sample can wait. They are put back also if a listener throws.
  struct Waiting {
    Kinetic& structure;
    double now;
    std::vector<Slot> slots{};
    ~Waiting() {
      for (const Slot slot : slots) {
        if (structure.held_[slot] && !structure.schedule_.contains(slot)) structure.schedule_.set(slot, now);
      }
    }
  } waiting{*this, now};
  while (next_time() <= now) {
    const Slot slot = schedule_.next().slot;
    if constexpr (MovingSample<Element>) {
      if (!failed(slot, rule_.certificate(slot, elements_), now, false)) {
        waiting.slots.push_back(slot);
        schedule_.set(slot, never);
        continue;
      }
    }
    process();
  }
}

}  // namespace kds
