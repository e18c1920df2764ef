// An event as bytes of a part.
#pragma once

#include "collision/parallel/world_events.hpp"
#include "io/events.hpp"

#include <cstddef>
#include <string>
#include <string_view>

namespace kds::io {

/// Whether files have events of this kind.
bool is_in_files(const kds::collision::DomainEvent& event);

/// As a domain records it, of a kind that files have, and no mark. Its bodies must be those of the scene: nothing was
/// added or removed since.
Event to_event(const kds::collision::DomainEvent& event);

/// An event of the log of a domain, or of a scene that is run as one world, which has no other owner. `cause`: of those
/// that follow from another, in the log of a domain; else null.
void append_record(std::string& bytes, const Event& event, std::size_t other_owner,
                   const kds::collision::DomainEvent::Cause* cause = nullptr);

/// A mark (DomainEvent::Kind) in the log of a domain.
void append_mark(std::string& bytes, const kds::collision::DomainEvent& mark);

/// Reads records, one after another, and checks that they are of a scene of so many bodies.
class Records {
 public:
  /// Refuses with std::runtime_error; the bytes must outlive this.
  Records(std::string_view bytes, std::size_t bodies) : rest_(bytes), bodies_(bodies) {}
  bool at_end() const { return rest_.empty(); }
  std::size_t number();
  /// So many of the bytes.
  Records part(std::size_t length);
  Event event();
  /// Of the log of a domain.
  kds::collision::DomainEvent event_of(std::size_t domain, std::size_t domains);

 private:
  struct Record {
    Event event;
    std::size_t other_owner;
    kds::collision::DomainEvent::Cause cause;
  };
  Record record();
  kds::collision::DomainEvent::Cause cause();
  kds::collision::DomainEvent mark();
  template <class T>
  T take();

  std::string_view rest_;
  std::size_t bodies_;
};

}  // namespace kds::io
