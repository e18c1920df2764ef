// The events of several worlds, each of which knows a part of the scene, as those of one.
#pragma once

#include "collision/body_id.hpp"
#include "collision/narrow_phase/contact.hpp"

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

namespace kds::collision {

namespace detail {

/// An event as a domain records it. Bodies by their numbers.
struct DomainEvent {
  /// In the order in which events of one time are told.
  enum class Kind : std::uint8_t { overlap, wall, contact, separation } kind;
  static constexpr std::uint8_t nobody = 0xff;
  std::uint8_t other_owner = nobody;  ///< a domain that has to have this event too; `nobody` if there is none
  BodySlot a;
  BodySlot b;  ///< of a wall its number
  Contact contact;

  template <class Archive>
  void archive(Archive& archive) {
    archive(kind, other_owner, a, b, contact);
  }

  /// Contacts and separations of one time come by their bodies alone.
  auto order() const {
    const int phase = kind == Kind::overlap ? 0 : kind == Kind::wall ? 1 : 2;
    return std::tuple(contact.time, phase, a, b);
  }
};

/// The events of all domains in the order of one world that knows all.
///
/// Each domain has its events in that order. One of two bodies with different owners is in the logs of both, and is
/// possible only when it is the first that is left in both: what comes before it in either may have caused it. Of the
/// events that are possible the least is that which one world would take from its queue: that one is possible in the
/// domains too, and all possible ones are in the queue.
///
/// Cost: O(domains) an event.
class EventMerge {
 public:
  EventMerge() = default;
  explicit EventMerge(std::vector<std::vector<DomainEvent>> logs) : logs_(std::move(logs)), next_(logs_.size(), 0) {}

  bool empty() const {
    for (std::size_t domain = 0; domain < logs_.size(); ++domain) {
      if (next_[domain] < logs_[domain].size()) return false;
    }
    return true;
  }

  /// Precondition: not empty. Throws std::logic_error if no event is possible: then the logs are not of one history.
  const DomainEvent& take_next() {
    const DomainEvent* first = nullptr;
    std::size_t of = 0;
    for (std::size_t domain = 0; domain < logs_.size(); ++domain) {
      const DomainEvent* event = head(domain);
      if (!event || (first && !(event->order() < first->order()))) continue;
      if (event->other_owner != DomainEvent::nobody) {
        const DomainEvent* same = head(event->other_owner);
        if (!same || same->order() != event->order()) continue;
      }
      first = event, of = domain;
    }
    if (!first) throw std::logic_error("ParallelWorld: domains disagree about what has happened");
    if (first->other_owner != DomainEvent::nobody) ++next_[first->other_owner];
    ++next_[of];
    return *first;
  }

 private:
  const DomainEvent* head(std::size_t domain) const {
    return next_[domain] < logs_[domain].size() ? &logs_[domain][next_[domain]] : nullptr;
  }

  std::vector<std::vector<DomainEvent>> logs_;
  std::vector<std::size_t> next_;
};

}  // namespace detail
}  // namespace kds::collision
