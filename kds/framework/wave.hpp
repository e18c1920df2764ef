// The order in which structures take up one event or edit: each after those that it stands on.
#pragma once

#include <atomic>
#include <cstdint>
#include <utility>
#include <vector>

namespace kds::detail {

class Wave;

/// A structure made of a rule, as the events and edits see it that it takes part in.
class Follower {
 public:
  Follower(const Follower&) = delete;
  Follower& operator=(const Follower&) = delete;

  /// Takes up what the structures that it stands on have reported in this event or edit.
  virtual void follow(double now, bool in_event, Wave& wave) = 0;
  /// The event or edit is over for all structures.
  virtual void forget_reports() = 0;
  /// Calls the listener for the events that have been followed.
  virtual void listen() = 0;
  virtual void process_due(double now) = 0;

 protected:
  /// What its rule is doing. An exception from a rule leaves it `working`, and those that have been called before it in
  /// the same event or edit `done`, for ever.
  enum class State : std::uint8_t {
    ready,    ///< nothing
    working,  ///< one of its functions is running
    done      ///< it has been called, and the event or edit is not over yet
  };

  Follower() : number_(++made) {}
  ~Follower() = default;

  State state_ = State::ready;

 private:
  friend class Wave;

  static inline std::atomic<std::uint64_t> made = 0;

  std::uint64_t number_;  ///< greater than those of the structures that it stands on, which have been made before
  bool waits_ = false;    ///< to follow
};

/// One event or edit on its way from the structures where it begins to those that stand on them.
///
/// Law: a structure follows when all that it stands on have been called, however many of them report something and by
/// whatever ways; structures follow in the order in which they were made, which is such an order.
class Wave {
 public:
  /// While it exists an event or edit is on its way. If an exception ends it, those that wait are let go, and those
  /// that have been called stay `done`.
  class Passage {
   public:
    explicit Passage(Wave& wave) : wave_(wave) {}
    Passage(const Passage&) = delete;
    Passage& operator=(const Passage&) = delete;
    ~Passage() { wave_.let_go(); }

    /// The rest follows, and then all are ready again.
    void end(double now, bool in_event) {
      wave_.advance(wave_.last, now, in_event);
      for (Follower* structure : wave_.called_) {
        structure->forget_reports();
        structure->state_ = Follower::State::ready;
      }
    }

   private:
    Wave& wave_;
  };

  /// `structure`'s rule has been called.
  void called(Follower& structure) {
    if (called_.empty() || called_.back() != &structure) called_.push_back(&structure);
  }
  /// `structure` is to follow. Precondition: it has been made after all that have been called.
  void await(Follower& structure) {
    if (std::exchange(structure.waits_, true)) return;
    auto at = waiting_.end();
    while (at != waiting_.begin() && (*(at - 1))->number_ < structure.number_) --at;
    waiting_.insert(at, &structure);
  }
  /// The structures follow that have been made before `structure`, and it itself.
  void follow_up_to(const Follower& structure, double now) { advance(structure.number_, now, false); }

 private:
  static constexpr std::uint64_t last = ~std::uint64_t{0};

  void advance(std::uint64_t number, double now, bool in_event) {
    while (!waiting_.empty() && waiting_.back()->number_ <= number) {
      Follower& structure = *waiting_.back();
      waiting_.pop_back();
      structure.waits_ = false;
      structure.follow(now, in_event, *this);
    }
  }
  void let_go() {
    for (Follower* structure : waiting_) structure->waits_ = false;
    waiting_.clear();
    called_.clear();
  }

  std::vector<Follower*> waiting_;  ///< by descending numbers
  std::vector<Follower*> called_;
};

}  // namespace kds::detail
