// What a rule is given when it changes: the time, exact signs, and a pen to mark what it has changed.
#pragma once

#include "kds/events/event_queue.hpp"
#include "kds/framework/moving_set.hpp"
#include "kds/uncertain.hpp"

#include <cstdint>
#include <vector>

namespace kds {

template <class Rule, class Listener, EventQueue Queue, class Solver>
class Kinetic;
template <class Rule>
class KineticOf;

/// A change that a rule is making: its time, the elements, and the slots that have got a new certificate. `Change` is
/// what the rule reports to rules that stand on it; void if it reports nothing.
///
/// Slots that are marked are certified when the rule is done, each once: a rule may mark more slots than it must, in
/// any order, while its state is incomplete. It is passed by reference: there is one for a structure.
template <MovingElement E, class Change = void>
class Repair;

template <MovingElement E>
class Repair<E, void> {
 public:
  Repair(const Repair&) = delete;
  Repair& operator=(const Repair&) = delete;

  double now() const { return now_; }
  const E& operator[](Id id) const { return elements_[id]; }
  const MovingSet<E>& elements() const { return elements_; }

  /// Sign of a certificate at now+, exact; of sampled elements that of their samples.
  template <class C>
  int sign(const C& certificate) const {
    return exact_sign(certificate, now_);
  }

  /// The slot's certificate has changed, or there is none any more: certificate() will be called for it.
  void certify(Slot slot) { mark(slot, Mark::certify); }
  /// The slot is given up: certificate() will not be called for it.
  void retire(Slot slot) { mark(slot, Mark::retire); }

 private:
  template <class, class, EventQueue, class>
  friend class Kinetic;
  template <class>
  friend class KineticOf;
  template <MovingElement, class>
  friend class Repair;
  enum class Mark : std::uint8_t { none, certify, retire };

  explicit Repair(const MovingSet<E>& elements) : elements_(elements) {}

  void mark(Slot slot, Mark what) {
    if (slot >= marks_.size()) marks_.resize(slot + std::size_t{1}, Mark::none);
    if (marks_[slot] == Mark::none) marked_.push_back(slot);
    marks_[slot] = what;
  }

  const MovingSet<E>& elements_;
  std::vector<Slot> marked_;
  std::vector<Mark> marks_;
  double now_ = 0;
};

template <MovingElement E, class Change>
class Repair : public Repair<E> {
 public:
  /// Tells the rules that stand on this one of a change, when this call is over.
  void report(const Change& change) {
    if (followed_) changes_.push_back(change);
  }

 private:
  template <class, class, EventQueue, class>
  friend class Kinetic;
  template <class>
  friend class KineticOf;

  explicit Repair(const MovingSet<E>& elements) : Repair<E>(elements) {}

  std::vector<Change> changes_;
  bool followed_ = false;  ///< whether any rule stands on this one
};

}  // namespace kds
