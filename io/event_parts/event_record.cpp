#include "io/event_parts/event_record.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace kds::io {
namespace {

using kds::collision::DomainEvent;
using kds::collision::Feature;

// The first byte: the kind of the event, and what follows.
constexpr std::uint8_t kinds = 0x0f;
constexpr std::uint8_t kind_of_marks = 0x0f;  // of domains, which are no events of files
constexpr std::uint8_t has_features = 0x10;
constexpr std::uint8_t has_other_owner = 0x20;
constexpr std::uint8_t has_cause = 0x40;

template <class T>
void put(std::string& bytes, T value) {
  static_assert(std::is_arithmetic_v<T>);
  char letters[sizeof(T)];
  std::memcpy(letters, &value, sizeof(T));
  bytes.append(letters, sizeof(T));
}

void require(bool right) {
  if (!right) throw std::runtime_error("has an event that cannot be one of this scene");
}

/// What a domain records, and what the file calls it.
using DomainKind = DomainEvent::Kind;
constexpr std::array<std::pair<DomainKind, EventKind>, 9> kinds_of_domains{
    {{DomainKind::overlap, EventKind::overlap},
     {DomainKind::wall, EventKind::wall},
     {DomainKind::contact, EventKind::contact},
     {DomainKind::separation, EventKind::separation},
     {DomainKind::wakes, EventKind::wake},
     {DomainKind::wakes_at_wall, EventKind::wake_at_wall},
     {DomainKind::rests, EventKind::rest},
     {DomainKind::rests_at_wall, EventKind::rest_at_wall},
     {DomainKind::passes, EventKind::pass}}};

EventKind to_event_kind(DomainKind kind) {
  return std::ranges::find(kinds_of_domains, kind, &std::pair<DomainKind, EventKind>::first)->second;
}

DomainKind to_domain_kind(EventKind kind) {
  const auto* const found = std::ranges::find(kinds_of_domains, kind, &std::pair<DomainKind, EventKind>::second);
  require(found != kinds_of_domains.end());
  return found->first;
}

}  // namespace

bool is_in_files(const DomainEvent& event) {
  return event.kind != DomainKind::rebound_suppressed && event.kind != DomainKind::rebound_suppressed_at_wall &&
         event.kind != DomainKind::mark;
}

Event to_event(const DomainEvent& event) {
  const auto& c = event.contact;
  // In the scene of a file nothing is removed, so ids are places.
  return {c.time,
          to_event_kind(event.kind),
          kds::collision::body_slot(event.a),
          kds::collision::body_slot(event.b),
          c.point,
          c.normal,
          c.feature_a,
          c.feature_b};
}

void append_mark(std::string& bytes, const DomainEvent& mark) {
  put(bytes, static_cast<std::uint8_t>(kind_of_marks | has_other_owner | has_cause));
  put(bytes, static_cast<std::uint32_t>(mark.other_owner));
  put(bytes, static_cast<std::uint8_t>(mark.cause.phase)), put(bytes, mark.cause.a), put(bytes, mark.cause.b);
  put(bytes, mark.contact.time), put(bytes, mark.a);
}

void append_record(std::string& bytes, const Event& event, std::size_t other_owner, const DomainEvent::Cause* cause) {
  const bool shared = other_owner != DomainEvent::nobody;
  const bool features = event.feature_a != Feature{} || event.feature_b != Feature{};
  put(bytes, static_cast<std::uint8_t>(static_cast<unsigned>(event.kind) | (features ? has_features : 0u) |
                                       (shared ? has_other_owner : 0u) | (cause ? has_cause : 0u)));
  if (shared) put(bytes, static_cast<std::uint32_t>(other_owner));
  if (cause) put(bytes, static_cast<std::uint8_t>(cause->phase)), put(bytes, cause->a), put(bytes, cause->b);
  put(bytes, event.time), put(bytes, event.a), put(bytes, event.b);
  for (const Eigen::Vector3d* v : {&event.point, &event.normal}) {
    for (int d = 0; d < 3; ++d) put(bytes, (*v)[d]);
  }
  if (!features) return;
  for (const Feature* feature : {&event.feature_a, &event.feature_b}) {
    put(bytes, static_cast<std::uint8_t>(feature->kind)), put(bytes, feature->first), put(bytes, feature->second);
  }
}

template <class T>
T Records::take() {
  require(rest_.size() >= sizeof(T));
  T value{};
  std::memcpy(&value, rest_.data(), sizeof(T));
  rest_.remove_prefix(sizeof(T));
  return value;
}

std::size_t Records::number() { return take<std::uint64_t>(); }

Records Records::part(std::size_t length) {
  require(length <= rest_.size());
  const Records first(rest_.substr(0, length), bodies_);
  rest_.remove_prefix(length);
  return first;
}

DomainEvent::Cause Records::cause() {
  const auto phase = take<std::uint8_t>();
  require(phase <= static_cast<std::uint8_t>(DomainEvent::Cause::Phase::contacts));
  DomainEvent::Cause cause{.phase = static_cast<DomainEvent::Cause::Phase>(phase)};
  cause.a = take<kds::collision::BodyId>();
  cause.b = take<kds::collision::BodyId>();
  return cause;
}

Records::Record Records::record() {
  const auto first = take<std::uint8_t>();
  require((first & kinds) < event_kind_names.size() &&
          (first & ~(kinds | has_features | has_other_owner | has_cause)) == 0);
  Record record{{}, DomainEvent::nobody, {}};
  Event& event = record.event;
  event.kind = static_cast<EventKind>(first & kinds);
  if ((first & has_other_owner) != 0) record.other_owner = take<std::uint32_t>();
  if ((first & has_cause) != 0) record.cause = cause();
  event.time = take<double>();
  event.a = take<std::uint32_t>();
  event.b = take<std::uint32_t>();
  require(event.a < bodies_ && event.b < (event.is_at_wall() ? wall_names.size() : bodies_));
  for (Eigen::Vector3d* v : {&event.point, &event.normal}) {
    for (int d = 0; d < 3; ++d) (*v)[d] = take<double>();
  }
  if ((first & has_features) == 0) return record;
  for (Feature* feature : {&event.feature_a, &event.feature_b}) {
    const auto kind = take<std::uint8_t>();
    require(kind <= static_cast<std::uint8_t>(Feature::Kind::face));
    feature->kind = static_cast<Feature::Kind>(kind);
    feature->first = take<std::uint32_t>();
    feature->second = take<std::uint32_t>();
  }
  return record;
}

Event Records::event() { return record().event; }

DomainEvent Records::mark() {
  DomainEvent mark{};
  mark.kind = DomainKind::mark;
  require(take<std::uint8_t>() == (kind_of_marks | has_other_owner | has_cause));
  const auto other_owner = take<std::uint32_t>();
  require(other_owner < DomainEvent::nobody);
  mark.other_owner = static_cast<decltype(DomainEvent::other_owner)>(other_owner);
  mark.cause = cause();
  mark.contact.time = take<double>();
  mark.a = mark.b = take<kds::collision::BodyId>();
  return mark;
}

DomainEvent Records::event_of(std::size_t domain, std::size_t domains) {
  const auto of_two = [&](std::size_t other) { return other < domains && other != domain; };
  if (!rest_.empty() && (static_cast<std::uint8_t>(rest_.front()) & kinds) == kind_of_marks) {
    const DomainEvent found = mark();
    require(of_two(found.other_owner));
    return found;
  }
  const auto [event, other_owner, cause] = record();
  require(other_owner == DomainEvent::nobody || of_two(other_owner));
  return {to_domain_kind(event.kind),
          static_cast<decltype(DomainEvent::other_owner)>(other_owner),
          event.a,
          event.b,
          {event.time, event.point, event.normal, event.feature_a, event.feature_b},
          0,
          0,
          cause};
}

}  // namespace kds::io
