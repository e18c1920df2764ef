// What rests of one body, on its way from one world to another.
#pragma once

#include "collision/world/resting/resting_contact.hpp"
#include "kds/certificate.hpp"
#include "kds/framework/snapshot.hpp"

#include <memory>
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
    template <class Archive>
    void archive(Archive& archive) {
      archive(contacts, releases, span_ends, calm_since, looked_at);
    }
  };

  RestingProgress() = default;
  /// `met`: it has met a body that is not fixed.
  RestingProgress(State state, bool met)
      : state_(state.is_none() ? nullptr : std::make_shared<const State>(std::move(state))), met_(met) {}

  /// Null if nothing rests.
  const State* state() const { return state_.get(); }
  bool met() const { return met_; }
  bool is_none() const { return !state_ && !met_; }
  /// Calls take(number) for each body with which this one, by its number, has a contact.
  template <class Take>
  void each_other(BodySlot self, const Take& take) const {
    if (!state_) return;
    for (const auto& contact : state_->contacts) {
      if (contact.b != no_body) take(contact.a == self ? contact.b : contact.a);
    }
  }

  template <class Archive>
  void archive(Archive& archive) {
    bool rests = state_ != nullptr;
    archive(met_, rests);
    if constexpr (Archive::loading) state_ = nullptr;
    if (!rests) return;
    State state = state_ ? *state_ : State();
    archive(state);
    if constexpr (Archive::loading) state_ = std::make_shared<const State>(std::move(state));
  }

  /// Whether they are the same, but for what each world finds by itself: releases, and what is left behind.
  friend bool same_bits(const RestingProgress& a, const RestingProgress& b) {
    if (a.met_ != b.met_) return false;
    if (!a.state_ || !b.state_) return !a.state_ && !b.state_;
    return bytes_of(*a.state_) == bytes_of(*b.state_);
  }

 private:
  static std::vector<char> bytes_of(State state) {
    state.releases.clear();
    for (auto& contact : state.contacts) contact.left_behind = -never, contact.unfinished = false;
    kds::detail::Writer writer;
    writer(state);
    return writer.take();
  }

  std::shared_ptr<const State> state_;
  bool met_ = false;
};

}  // namespace kds::collision
