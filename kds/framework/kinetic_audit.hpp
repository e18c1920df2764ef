// How a structure made of a rule checks itself, is measured, and is saved.
#pragma once

#include "kds/framework/kinetic.hpp"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace kds {

/// Checks the proof of the state slot by slot: a slot that is in use has a certificate, which holds just after now,
/// unless its event is due; its event is at its failure time (with sampled elements: at the time at which they are to
/// be sampled, at the latest); no other slot has an event. Then calls the rule's own audit.
template <class Rule, class Listener, EventQueue Queue, class Solver>
void Kinetic<Rule, Listener, Queue, Solver>::audit(double now) const {
  const auto fail = [](Slot slot, const char* what) {
    throw AuditFailure(Rule::name + (": slot " + std::to_string(slot)) + ": " + what);
  };
  detail::for_each_place<Rule>([&](auto place) {
    if (inner_at(place).reports_ != followed_at(place)) {
      throw AuditFailure(Rule::name + std::string(": a structure that it stands on has changed without it"));
    }
  });
  for (Slot slot = 0; slot < held_.size(); ++slot) {
    if (!held_[slot]) {
      if (schedule_.contains(slot)) fail(slot, "an event without certificate");
      continue;
    }
    bool certified = false;
    const double time = schedule_.contains(slot) ? schedule_.time(slot) : never;
    detail::with_certificate(rule_.certificate(slot, elements_), [&](const auto& certificate) {
      certified = true;
      if (exact_sign(certificate, now) < 0 && ((Sampled<Element> && !MovingSample<Element>) || time > now)) {
        fail(slot, "has failed");
      }
      if constexpr (Sampled<Element>) {
        const double latest = latest_sample(slot, certificate, now);
        if (time > latest && latest <= schedule_.horizon()) fail(slot, "is to be sampled too late");
      } else if constexpr (Solver::certified) {
        if (failure_time(certificate, now, schedule_.horizon()) != time) fail(slot, "the event has the wrong time");
      }
    });
    if (!certified) fail(slot, "is held, but there is no certificate");
  }
  if constexpr (AuditsItself<Rule>) rule_.audit(elements_, now);
}

template <class Rule, class Listener, EventQueue Queue, class Solver>
Measures Kinetic<Rule, Listener, Queue, Solver>::measures() const {
  std::vector<std::uint64_t> of_element(elements_.end_id(), 0);
  for (Slot slot = 0; slot < held_.size(); ++slot) {
    if (!held_[slot]) continue;
    for (const Id id : rule_.members(slot)) ++of_element[id];
  }
  Measures result = measures_;
  for (const std::uint64_t count : of_element) result.most_per_element = std::max(result.most_per_element, count);
  return result;
}

/// Failure times are saved, not certificates: these are functions of the rule's state and of the motions.
template <class Rule, class Listener, EventQueue Queue, class Solver>
template <class Archive>
void Kinetic<Rule, Listener, Queue, Solver>::archive(Archive& archive) {
  archive.tag(Rule::name);
  static_assert(ArchivedBy<Rule, Archive>,
                "kinetic rule: to be saved it needs `template <class Archive> void archive(Archive&)`");
  rule_.archive(archive);
  archive(held_, schedule_, measures_, last_, backwards_);
  if constexpr (ReportsChanges<Rule>) archive(this->reports_);
  if constexpr (is_outer) archive(followed_reports_);
  if constexpr (Archive::loading) {
    if (schedule_.queue().slots() != held_.size()) throw std::runtime_error("snapshot: it is damaged");
    untold_.clear();
    repair_.marks_.assign(held_.size(), Mark::none);
  }
}

}  // namespace kds
