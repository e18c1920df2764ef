// What is due in a structure made of a rule: a repair, or a sample; and what comes before an edit.
#pragma once

#include "kds/framework/kinetic.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <type_traits>
#include <vector>

namespace kds {

/// Whether it is for a failure that a slot is due, not for a sample, nor too early.
template <class Rule, class Listener, EventQueue Queue, class Solver>
bool Kinetic<Rule, Listener, Queue, Solver>::failed(Slot slot, double time, bool counts) {
  if constexpr (Sampled<Element> && !MovingSample<Element>) return false;  // Samples at rest never fail.
  bool failed = false;
  detail::with_certificate(rule_.certificate(slot, elements_), [&](const auto& certificate) {
    if constexpr (MovingSample<Element>) {
      const OfSamples<std::remove_cvref_t<decltype(certificate)>> of_samples{certificate};
      failed = sign_after(of_samples, time) < 0 && (!counts || schedule_.failed(slot, of_samples, time));
    } else if constexpr (!Sampled<Element>) {
      failed = schedule_.failed(slot, certificate, time);
      if constexpr (Antisymmetric<std::remove_cvref_t<decltype(certificate)>>) {
        if (failed) crossed_ = detail::Ordered::by(certificate);
      }
    }
  });
  return failed;
}

template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::sample_again(Slot slot, double time) {
  if constexpr (Sampled<Element>) {
    const auto members = rule_.members(slot);
    const std::vector<Id> ids(std::begin(members), std::end(members));
    for (const Id id : ids) {
      elements_.settle(time);
      if (elements_.contains(id)) elements_.resample(id, time);  // else a listener has removed it
    }
  }
}

template <class Rule, class Listener, EventQueue Queue, class Solver>
double Kinetic<Rule, Listener, Queue, Solver>::soonest_sample(Slot slot) const {
  double oldest = never;
  for (const Id id : rule_.members(slot)) oldest = std::min(oldest, elements_[id].start);
  return oldest + elements_.tick();
}

template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::settle(double now) {
  require_ready();
  if (now < last_) {
    fail_use("an edit at " + std::to_string(now) + " comes after a change at " + std::to_string(last_));
  }
  if (next_time() < now) {
    fail_use("an edit at " + std::to_string(now) + " would pass over an event at " + std::to_string(next_time()));
  }
  if constexpr (Sampled<Element> && !MovingSample<Element>) return;  // In order at all times.
  // What is due for a sample can wait. It is put back also if a listener throws.
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
      if (!failed(slot, now, false)) {
        waiting.slots.push_back(slot);
        schedule_.set(slot, never);
        continue;
      }
    }
    process();
  }
}

}  // namespace kds
