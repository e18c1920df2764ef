// The events of several worlds, each of which knows a part of the scene, as those of one.
#pragma once

#include "collision/body_id.hpp"
#include "collision/narrow_phase/contact.hpp"
#include "collision/parallel/domain_sets.hpp"
#include "kds/certificate.hpp"

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <queue>
#include <stdexcept>
#include <utility>
#include <vector>

namespace kds::collision {

/// An event as a domain records it. Bodies by their ids in the scene.
struct DomainEvent {
  enum class Kind : std::uint8_t {  ///< as WorldListener tells them
    overlap,
    wall,
    contact,
    separation,
    // What follows from an event of the same time.
    rebound_suppressed,
    rebound_suppressed_at_wall,
    wakes,
    wakes_at_wall,
    rests,
    rests_at_wall,
    passes,
    /// Nothing that is told: something has happened to an island with bodies of two domains. What each of them records
    /// of it comes after what this follows from.
    mark
  } kind;
  static constexpr DomainIndex nobody = no_domain;
  DomainIndex other_owner = nobody;  ///< a domain that has to have this event too; `nobody` if there is none
  BodyId a;
  BodyId b;  ///< of a wall its number
  Contact contact;
  std::uint64_t user_data_a = 0;  ///< of the bodies
  std::uint64_t user_data_b = 0;

  /// The event from which another one follows. It need not be told: pieces of motion are not.
  struct Cause {
    /// In the order in which a world processes what is due at one time.
    enum class Phase : std::uint8_t {
      pieces,
      walls,
      ends_of_rest,
      spans,
      contacts,
      self_contacts
    } phase = Phase::pieces;
    BodyId a = 0, b = 0;  ///< by which those of one phase come; of pieces, which begin together, always the same

    friend auto operator<=>(const Cause&, const Cause&) = default;
  };
  Cause cause{};  ///< of what follows

  bool follows() const { return kind > Kind::separation; }
  bool is_at_wall() const {
    return kind == Kind::wall || kind == Kind::rebound_suppressed_at_wall || kind == Kind::wakes_at_wall ||
           kind == Kind::rests_at_wall;
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(kind, other_owner, a, b, contact, user_data_a, user_data_b);
    if (follows()) archive(cause.phase, cause.a, cause.b);
  }

  /// What it follows from, or what follows from it has as its cause.
  Cause origin() const {
    if (follows()) return cause;
    if (kind == Kind::overlap) return {};
    if (kind == Kind::wall) return {Cause::Phase::walls, a, b};
    return {a == b ? Cause::Phase::self_contacts : Cause::Phase::contacts, a, b};
  }

  /// What follows from an event comes right after it, in the order that WorldListener states. Contacts and separations
  /// of one time come by their bodies alone.
  struct Order {
    double time;
    Cause origin;
    int kind;  ///< 0 if nothing comes before it that has the same origin
    BodyId a, b;
    int wall;

    friend auto operator<=>(const Order&, const Order&) = default;
  };
  Order order() const {
    constexpr std::array<int, 12> places{6, 0, 0, 0, 2, 2, 3, 3, 5, 5, 4, 1};  // by kind
    const bool at_wall = is_at_wall();
    return {contact.time,
            origin(),
            places[static_cast<std::size_t>(kind)],
            a,
            at_wall ? a : b,
            at_wall ? static_cast<int>(b) : -1};
  }
};

/// The events of all domains in the order of one world that knows all.
///
/// Each domain has its events in that order. One of two bodies with different owners is in the logs of both, and is
/// possible only when it is the first that is left in both: what comes before it in either may have caused it. What
/// follows from the event that was told last comes first. Of the other events that are possible the least is that which
/// one world would take from its queue: that one is possible in the domains too, and all possible ones are in the
/// queue.
///
/// `Logs`: head(domain) is the first event that is left in a log, or null, until go_on(domain), which leaves it behind;
/// size() is how many domains there are.
///
/// Cost: O(log domains) an event.
template <class Logs>
class BasicEventMerge {
 public:
  explicit BasicEventMerge(Logs logs) : logs_(std::move(logs)) {
    for (std::size_t domain = 0; domain < logs_.size(); ++domain) {
      const DomainEvent* event = logs_.head(domain);
      if (!event) continue;
      ++left_;
      // An event of two domains is found by the later of them.
      if (event->other_owner == DomainEvent::nobody || event->other_owner < domain) add_if_possible(domain);
    }
    pass_marks();
  }

  bool empty() const { return left_ == 0; }

  /// Precondition: not empty. Throws std::logic_error if no event is possible: then the logs are not of one history.
  const DomainEvent& next() const {
    if (next_queue().empty()) throw std::logic_error("ParallelWorld: domains disagree about what has happened");
    return *logs_.head(next_queue().top().domain);
  }
  /// The same, and leaves it behind.
  DomainEvent take_next() {
    const DomainEvent event = take();
    pass_marks();
    return event;
  }

 private:
  struct Possible {
    DomainEvent::Order order;
    std::size_t domain;
    bool operator<(const Possible& other) const {
      return other.order < order || (other.order == order && other.domain < domain);
    }
  };

  using Queue = std::priority_queue<Possible>;  ///< each event once, the first on top

  DomainEvent take() {
    const DomainEvent event = next();
    const std::size_t domain = next_queue().top().domain;
    next_queue().pop();
    told_ = event.order();
    // Of those that could not be told before it, what follows from it is the least now.
    while (!possible_.empty() && follows(possible_.top().order)) {
      following_.push(possible_.top());
      possible_.pop();
    }
    const std::size_t other = event.other_owner;
    go_on(domain);
    if (other != DomainEvent::nobody) go_on(other);
    // In this order: if the next event is of these two again, the second finds it.
    add_if_possible(domain);
    if (other != DomainEvent::nobody && !is_shared_by(domain, other)) add_if_possible(other);
    return event;
  }
  void pass_marks() {
    while (!next_queue().empty() && next().kind == DomainEvent::Kind::mark) take();
  }

  Queue& next_queue() { return following_.empty() ? possible_ : following_; }
  const Queue& next_queue() const { return following_.empty() ? possible_ : following_; }
  /// Whether an event follows from the one that was told last, or from that from which it follows.
  bool follows(const DomainEvent::Order& order) const {
    return order.kind > 0 && order.time == told_.time && order.origin == told_.origin;
  }
  void go_on(std::size_t domain) {
    logs_.go_on(domain);
    if (!logs_.head(domain)) --left_;
  }
  /// Whether the first events that are left in both are one.
  bool is_shared_by(std::size_t domain, std::size_t other) const {
    const DomainEvent *first = logs_.head(domain), *second = logs_.head(other);
    return first && second && first->other_owner == other && second->other_owner == domain &&
           second->order() == first->order();
  }
  void add_if_possible(std::size_t domain) {
    const DomainEvent* event = logs_.head(domain);
    if (!event || (event->other_owner != DomainEvent::nobody && !is_shared_by(domain, event->other_owner))) return;
    const auto order = event->order();
    (follows(order) ? following_ : possible_).push({order, domain});
  }

  Logs logs_;
  std::size_t left_ = 0;                             ///< logs in which events are left
  Queue following_;                                  ///< what follows from the event that was told last
  Queue possible_;                                   ///< the others that are possible
  DomainEvent::Order told_{-never, {}, 0, 0, 0, 0};  ///< the last that was told
};

/// Logs in memory.
class EventLogs {
 public:
  EventLogs() = default;
  explicit EventLogs(std::vector<std::vector<DomainEvent>> logs) : logs_(std::move(logs)), next_(logs_.size(), 0) {}
  std::size_t size() const { return logs_.size(); }
  const DomainEvent* head(std::size_t domain) const {
    return next_[domain] < logs_[domain].size() ? &logs_[domain][next_[domain]] : nullptr;
  }
  void go_on(std::size_t domain) { ++next_[domain]; }

 private:
  std::vector<std::vector<DomainEvent>> logs_;
  std::vector<std::size_t> next_;
};

/// Merges the events of domains that are all in memory.
class EventMerge : public BasicEventMerge<EventLogs> {
 public:
  EventMerge() : EventMerge(std::vector<std::vector<DomainEvent>>()) {}
  explicit EventMerge(std::vector<std::vector<DomainEvent>> logs)
      : BasicEventMerge<EventLogs>(EventLogs(std::move(logs))) {}
};

}  // namespace kds::collision
