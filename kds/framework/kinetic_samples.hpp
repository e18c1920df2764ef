// How a structure made of a rule works when only samples of its elements are known.
#pragma once

#include "kds/framework/kinetic.hpp"

#include <algorithm>
#include <iterator>
#include <type_traits>
#include <vector>

namespace kds {

// A certificate of samples is guaranteed while its middle exceeds its radius (Conservative), whatever the elements have
// done since they were sampled. When that ends, the slot is due, and its members are sampled anew; but no sample is
// replaced before it is a tick old, so that a fact that is close to failing does not ask for samples without end.
// Samples that move on at their velocities (MovingSample) may cross each other in that time: this is a failure
// (OfSamples) like that of polynomials, at which the rule repairs, since the state is that of the samples. Samples at
// rest never fail.

/// Schedules a new certificate for when it is no longer guaranteed, but not before its members may be sampled anew;
/// earlier if the samples cross by then.
template <class Rule, class Listener, EventQueue Queue, class Solver>
template <class C>
void Kinetic<Rule, Listener, Queue, Solver>::certify_samples(Slot slot, const C& certificate) {
  schedule_.certify(slot, Conservative<C>{certificate}, last_);
  double next = soonest_sample(slot);
  if (!schedule_.contains(slot) || schedule_.time(slot) >= next) return;
  if constexpr (MovingSample<Element>) {
    next = std::min(next, failure_time(OfSamples<C>{certificate}, last_, schedule_.horizon()));
  }
  schedule_.set(slot, next <= schedule_.horizon() ? next : never);
}

/// For the audit: the slot must be due by then.
template <class Rule, class Listener, EventQueue Queue, class Solver>
template <class C>
double Kinetic<Rule, Listener, Queue, Solver>::latest_sample(Slot slot, const C& certificate, double now) const {
  const double unsure = failure_time(Conservative<C>{certificate}, now, schedule_.horizon());
  const double latest = std::max(unsure, soonest_sample(slot));
  if constexpr (MovingSample<Element>) {
    return std::min(latest, failure_time(OfSamples<C>{certificate}, now, schedule_.horizon()));
  }
  return latest;
}

/// A listener that hears of one sample may remove another element.
template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::sample_again(Slot slot, double time) {
  if constexpr (Sampled<Element>) {
    const auto members = rule_.members(slot);
    const std::vector<Id> ids(std::begin(members), std::end(members));
    for (const Id id : ids) {
      elements_.process_due(time);
      if (elements_.contains(id)) elements_.resample(id, time);  // else a listener has removed it
    }
  }
}

/// A tick after the oldest sample of the slot's members.
template <class Rule, class Listener, EventQueue Queue, class Solver>
double Kinetic<Rule, Listener, Queue, Solver>::soonest_sample(Slot slot) const {
  double oldest = never;
  for (const Id id : rule_.members(slot)) oldest = std::min(oldest, elements_[id].start);
  return oldest + elements_.tick();
}

}  // namespace kds
