// What rests of one body, on its way from one world to another.
#pragma once

#include "collision/world/resting/kept_progress.hpp"
#include "collision/world/resting/resting_contact.hpp"
#include "kds/certificate.hpp"

#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

namespace kds::collision {

/// The resting contacts of a body, and what else decides how they go on: another world that has the same bodies can go
/// on from it. That of all bodies that lean on each other is complete, since an island is solved for by itself
/// (resting_islands.cpp). A contact of two bodies that are not fixed is in the progress of both.
class RestingProgress {
 public:
  struct State {                                     ///< of a body of which something rests
    std::vector<detail::RestingContact> contacts{};  ///< bodies by their numbers; in the order in which it lists them
    std::vector<double> releases{};                  ///< s, when each of them ends; `never` if that is not known
    double span_ends = -never;                       ///< s, of the cluster that the body is by itself
    double calm_since = never;                       ///< s
    double looked_at = never;  ///< s, when its span ends, or whether it has come to rest is looked at

    bool is_none() const {
      return contacts.empty() && span_ends == -never && calm_since == never && looked_at == never;
    }
    /// Without what each world finds by itself: releases, and what is left behind.
    State compared() const {
      State state = *this;
      state.releases.clear();
      for (auto& contact : state.contacts) contact.left_behind = -never, contact.unfinished = false;
      return state;
    }
    template <class Archive>
    void archive(Archive& archive) {
      archive(contacts, releases, span_ends, calm_since, looked_at);
    }
  };

  RestingProgress() = default;
  /// `met`: it has met a body that is not fixed.
  RestingProgress(State state, bool met) : state_(std::move(state)), met_(met) {}

  /// Null if nothing rests.
  const State* state() const { return state_.get(); }
  bool met() const { return met_; }
  bool is_none() const { return !state() && !met_; }
  /// Calls take(number) for each body with which this one, by its number, has a contact.
  template <class Take>
  void each_other(BodySlot self, const Take& take) const {
    if (!state()) return;
    for (const auto& contact : state()->contacts) {
      if (contact.b != no_body) take(contact.a == self ? contact.b : contact.a);
    }
  }
  /// Calls take(number, what) for each of these contacts. Of two bodies that are not fixed both have the same, by
  /// `what` too.
  template <class Take>
  void each_contact(BodySlot self, const Take& take) const {
    if (!state()) return;
    for (const auto& contact : state()->contacts) {
      if (contact.b == no_body) continue;
      std::uint64_t what = 0;
      for (const double x : contact.normal) what = 3 * what + std::bit_cast<std::uint64_t>(x);
      take(contact.a == self ? contact.b : contact.a, what);
    }
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(met_, state_);
  }

  friend bool same_bits(const RestingProgress& a, const RestingProgress& b) {
    return a.met_ == b.met_ && same_bits(a.state_, b.state_);
  }

 private:
  RestingState<State> state_;
  bool met_ = false;
};

}  // namespace kds::collision
