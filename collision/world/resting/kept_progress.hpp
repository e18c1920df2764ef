// What the ways of bodies at rest from one world to another have in common, of those that turn and of those that do
// not.
#pragma once

#include "collision/body_id.hpp"
#include "kds/framework/snapshot.hpp"

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kds::collision {

/// What rests of one body. Of most bodies nothing does, so it is null then, and copies share it.
///
/// `State` has is_none(), archive(), and compared(): what has to be the same in two worlds in which the same will
/// happen.
template <class State>
class RestingState {
 public:
  RestingState() = default;
  explicit RestingState(State state)
      : state_(state.is_none() ? nullptr : std::make_shared<const State>(std::move(state))) {}

  /// Null if nothing rests.
  const State* get() const { return state_.get(); }

  template <class Archive>
  void archive(Archive& archive) {
    bool any = state_ != nullptr;
    archive(any);
    if constexpr (Archive::loading) state_ = nullptr;
    if (!any) return;
    State state = state_ ? *state_ : State();
    archive(state);
    if constexpr (Archive::loading) state_ = std::make_shared<const State>(std::move(state));
  }

  friend bool same_bits(const RestingState& a, const RestingState& b) {
    if (!a.state_ || !b.state_) return !a.state_ && !b.state_;
    return a.state_ == b.state_ || bytes_of(a.state_->compared()) == bytes_of(b.state_->compared());
  }

 private:
  static std::vector<char> bytes_of(State state) {
    kds::detail::Writer writer;
    writer(state);
    return writer.take();
  }

  std::shared_ptr<const State> state_;
};

/// The progress of the bodies of a world that other worlds run, or that only stores them.
template <class Progress>
class KeptProgress {
 public:
  const Progress& operator[](BodySlot slot) const {
    static const Progress nothing;
    return slot < kept_.size() ? kept_[slot] : nothing;
  }
  void keep(BodySlot slot, const Progress& progress) {
    if (slot >= kept_.size()) {
      if (progress.is_none()) return;
      kept_.resize(slot + std::size_t{1});
    }
    kept_[slot] = progress;
  }
  void forget(BodySlot slot) {
    if (slot < kept_.size()) kept_[slot] = {};
  }
  void clear() { kept_.clear(); }

  /// Keeps what a part of a world has of its bodies, of slots below `slots`.
  template <class Bodies, class Part>
  void take(const Bodies& bodies, const Part& part, std::size_t slots) {
    clear();
    for (BodySlot slot = 0; slot < slots; ++slot) {
      if (bodies.alive(slot)) keep(slot, part.progress(slot));
    }
  }
  /// The part, which has nothing of them any more, goes on from it.
  template <class Bodies, class Part>
  void give_back(const Bodies& bodies, Part& part) {
    const auto slot_of = [&](BodySlot slot) { return bodies.alive(slot) ? slot : no_body; };
    for (BodySlot slot = 0; slot < kept_.size(); ++slot) {
      if (bodies.alive(slot)) part.go_on_from(slot, kept_[slot], slot_of);
    }
    part.require_listed();
    clear();
  }

 private:
  std::vector<Progress> kept_;  ///< by slot, up to the last of which there is any
};

/// Of bodies that go on one by one, the contacts of two that are not fixed: each of the two brings them along.
class ContactsOfBoth {
 public:
  void brought_by_first() { ++half_listed_; }
  void brought_by_second() { --half_listed_; }
  /// To be called when all have gone on.
  void require_listed() {
    if (std::exchange(half_listed_, 0) != 0)
      throw std::runtime_error("World: a body rests on one that does not rest on it");
  }
  /// Of a body that brings along a contact with one that is not known here.
  [[noreturn]] static void refuse(BodySlot number) {
    throw std::runtime_error("World: body " + std::to_string(number) + " rests on one that is not there");
  }

 private:
  std::size_t half_listed_ = 0;  ///< those that one of the two has brought
};

}  // namespace kds::collision
