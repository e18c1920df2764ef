// What a rule is given when it changes: the time, exact signs, and a pen to mark what it has changed.
#pragma once

#include "kds/events/event_queue.hpp"
#include "kds/framework/certificate_choice.hpp"
#include "kds/framework/moving_set.hpp"
#include "kds/uncertain.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace kds {

template <class Rule, class Listener, EventQueue Queue, class Solver>
class Kinetic;
template <class Rule>
class KineticOf;

/// Several types of changes in place of one `Change`: a rule that stands on one that reports these says of which it is
/// told (StandsOn).
template <class... Types>
struct Changes {};

/// A change that a rule is making: its time, the elements, and the slots that have got a new certificate. `Change` is
/// what the rule reports to rules that stand on it; Changes<...> if that is of several types; void if it reports
/// nothing.
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

  /// Sign of a certificate at now+, exact; of sampled elements that of their samples. Of a choice (std::optional,
  /// std::variant) that of the certificate that it has, 0 if it has none.
  template <class C>
  int sign(const C& choice) const {
    int sign = 0;
    detail::with_certificate(choice, [&](const auto& certificate) { sign = exact_sign(certificate, now_); });
    return sign;
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

namespace detail {

/// What a rule reports of one type.
template <class Change>
class Reports {
 public:
  /// Tells the rules that stand on this one of a change, when this call is over.
  void report(const Change& change) {
    if (followers_ > 0) changes_.push_back(change);
  }

 private:
  template <class, class, EventQueue, class>
  friend class kds::Kinetic;
  template <MovingElement, class>
  friend class kds::Repair;

  std::vector<Change> changes_;
  std::size_t followers_ = 0;  ///< how many rules are told
};

}  // namespace detail

template <MovingElement E, class... Types>
class Repair<E, Changes<Types...>> : public Repair<E>, public detail::Reports<Types>... {
 public:
  using detail::Reports<Types>::report...;

 protected:
  explicit Repair(const MovingSet<E>& elements) : Repair<E>(elements) {}

 private:
  template <class, class, EventQueue, class>
  friend class Kinetic;
  template <class>
  friend class KineticOf;

  bool has_reports() const { return (!detail::Reports<Types>::changes_.empty() || ...); }
  void clear_reports() { (detail::Reports<Types>::changes_.clear(), ...); }
};

/// The same for a rule that reports changes, of one type here.
template <MovingElement E, class Change>
class Repair : public Repair<E, Changes<Change>> {
  template <class>
  friend class KineticOf;

  explicit Repair(const MovingSet<E>& elements) : Repair<E, Changes<Change>>(elements) {}
};

}  // namespace kds
