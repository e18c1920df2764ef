#include "collision/parallel/world_events.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

namespace kds::collision::test_world_events {
namespace {

using Kind = DomainEvent::Kind;
using kds::tests::Random;

DomainEvent event(double t, BodySlot a, BodySlot b, Kind kind = Kind::contact) {
  return {kind, DomainEvent::nobody, a, b, Contact{.time = t}};
}

/// A log of one world, given to domains: body n is of domain n % domains.
std::vector<std::vector<DomainEvent>> divided(const std::vector<DomainEvent>& log, std::size_t domains) {
  std::vector<std::vector<DomainEvent>> logs(domains);
  for (DomainEvent one : log) {
    const std::size_t of_a = one.a % domains, of_b = one.kind == Kind::wall ? of_a : one.b % domains;
    one.other_owner = of_a == of_b ? DomainEvent::nobody : static_cast<DomainIndex>(of_b);
    logs[of_a].push_back(one);
    if (of_a == of_b) continue;
    one.other_owner = static_cast<DomainIndex>(of_a);
    logs[of_b].push_back(one);
  }
  return logs;
}

}  // namespace

TEST_CASE("Events of domains are merged into the order of one world, cascades at one time included", "[parallel]") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    // A queue of pairs: an event may put pairs of its bodies into it again, at the same time, before or after others.
    struct Due {
      double t;
      BodySlot a, b;
      bool operator<(const Due& other) const { return std::tuple(t, a, b) < std::tuple(other.t, other.a, other.b); }
    };
    std::vector<Due> queue;
    const auto bodies = static_cast<std::uint32_t>(3 + random.below(12));
    const auto put = [&](double t, BodySlot a, BodySlot b) {
      if (a != b) queue.push_back({t, std::min(a, b), std::max(a, b)});
    };
    const auto any = [&] { return static_cast<BodySlot>(random.below(bodies)); };
    for (int i = 0; i < 20; ++i) put(random.integer(0, 3), any(), any());
    std::vector<DomainEvent> log;
    while (!queue.empty() && log.size() < 200) {
      const auto first = std::min_element(queue.begin(), queue.end());
      const Due due = *first;
      queue.erase(first);
      log.push_back(event(due.t, due.a, due.b));
      // What either of the two was to meet is found anew; an event depends on nothing but those of its bodies.
      std::erase_if(queue, [&](const Due& d) {
        const bool shares = d.a == due.a || d.a == due.b || d.b == due.a || d.b == due.b;
        return shares && random.one_in(3);
      });
      if (random.one_in(2)) put(due.t + (random.one_in(2) ? 0 : 1), due.a, any());
    }
    INFO("seed " << seed);
    for (const std::size_t domains : {1u, 2u, 3u, 5u, 700u}) {
      EventMerge merge(divided(log, domains));
      for (const DomainEvent& right : log) {
        REQUIRE(!merge.empty());
        REQUIRE(merge.take_next().order() == right.order());
      }
      REQUIRE(merge.empty());
    }
  }
}

TEST_CASE("Of events of one time overlaps are told first, then walls, contacts, and those of meshes with themselves",
          "[parallel]") {
  const std::vector<DomainEvent> log{event(1, 2, 3, Kind::overlap),
                                     event(1, 5, 5, Kind::wall),
                                     event(1, 0, 1),
                                     event(1, 6, 7),
                                     event(1, 2, 2),
                                     event(1, 3, 3)};
  EventMerge merge(divided(log, 2));
  for (const DomainEvent& right : log) CHECK(merge.take_next().order() == right.order());
  CHECK(merge.empty());
}

TEST_CASE("What follows from an event is told right after it, whichever domains record it", "[parallel]") {
  using Phase = DomainEvent::Cause::Phase;
  const auto following = [](Kind kind, BodyId a, BodyId b, Phase phase, BodyId cause_a, BodyId cause_b) {
    DomainEvent one = event(1, static_cast<BodySlot>(a), static_cast<BodySlot>(b), kind);
    one.cause = {phase, cause_a, cause_b};
    return one;
  };
  // Body 9 is a lift, whose wall domain 0 tells of; domain 1 records alone what that does to a body on it.
  std::vector<std::vector<DomainEvent>> logs(2);
  logs[0] = {following(Kind::wakes, 4, 9, Phase::pieces, 0, 0), event(1, 9, 5, Kind::wall),
             following(Kind::wakes, 6, 9, Phase::walls, 9, 5), following(Kind::wakes, 2, 9, Phase::spans, 2, 0),
             event(1, 4, 8)};
  logs[1] = {following(Kind::rests, 1, 9, Phase::pieces, 0, 0),
             following(Kind::wakes, 3, 9, Phase::walls, 9, 5),
             following(Kind::rests_at_wall, 3, 2, Phase::walls, 9, 5),
             event(1, 10, 0, Kind::wall),
             following(Kind::wakes, 7, 9, Phase::ends_of_rest, 7, 9),
             event(1, 0, 1),
             following(Kind::rebound_suppressed, 0, 9, Phase::contacts, 0, 1),
             following(Kind::passes, 1, 9, Phase::contacts, 0, 1),
             following(Kind::rests, 0, 9, Phase::contacts, 0, 1)};
  std::vector<std::pair<Kind, BodyId>> right{{Kind::wakes, 4},
                                             {Kind::rests, 1},
                                             {Kind::wall, 9},
                                             {Kind::wakes, 3},
                                             {Kind::wakes, 6},
                                             {Kind::rests_at_wall, 3},
                                             {Kind::wall, 10},
                                             {Kind::wakes, 7},
                                             {Kind::wakes, 2},
                                             {Kind::contact, 0},
                                             {Kind::rebound_suppressed, 0},
                                             {Kind::passes, 1},
                                             {Kind::rests, 0},
                                             {Kind::contact, 4}};
  // A contact of two domains, from which something follows in both, and in one of them a contact that comes before it.
  for (auto& log : logs) log.push_back(event(2, 4, 5));
  logs[0].back().other_owner = 1, logs[1].back().other_owner = 0;
  for (auto& log : logs) {
    const BodyId body = &log == &logs[0] ? 4 : 5;
    log.push_back(following(Kind::wakes, body, 9, Phase::contacts, 4, 5));
    log.back().contact.time = 2;
  }
  logs[0].push_back(event(2, 0, 4));
  right.insert(right.end(), {{Kind::contact, 4}, {Kind::wakes, 4}, {Kind::wakes, 5}, {Kind::contact, 0}});
  EventMerge merge(std::move(logs));
  for (const auto& [kind, a] : right) {
    const DomainEvent told = merge.take_next();
    CHECK(told.kind == kind);
    CHECK(told.a == a);
  }
  CHECK(merge.empty());
}

TEST_CASE("What one domain records of an island comes after what another one tells of it", "[parallel]") {
  using Phase = DomainEvent::Cause::Phase;
  // Bodies 1 and 5 lean on each other. Domain 0 owns 1, which 2 strikes, after 7 has struck 8 and 8 has struck 2.
  const auto following = [](Kind kind, BodySlot a, DomainIndex other, DomainEvent::Cause cause) {
    DomainEvent one = event(1, a, a, kind);
    one.other_owner = other, one.cause = cause;
    return one;
  };
  const DomainEvent::Cause struck{Phase::contacts, 1, 2}, later{Phase::ends_of_rest, 5, 9};
  std::vector<std::vector<DomainEvent>> logs(2);
  logs[0] = {event(1, 7, 8),
             event(1, 2, 8),
             event(1, 1, 2),
             following(Kind::mark, 1, 1, struck),
             following(Kind::wakes, 1, DomainEvent::nobody, struck),
             following(Kind::mark, 1, 1, later)};
  logs[1] = {following(Kind::mark, 1, 0, struck), following(Kind::wakes, 5, DomainEvent::nobody, struck),
             following(Kind::mark, 1, 0, later), following(Kind::rests, 5, DomainEvent::nobody, later), event(1, 0, 6)};
  EventMerge merge(std::move(logs));
  const std::vector<std::pair<Kind, BodyId>> right{{Kind::contact, 7}, {Kind::contact, 2}, {Kind::contact, 1},
                                                   {Kind::wakes, 1},   {Kind::wakes, 5},   {Kind::rests, 5},
                                                   {Kind::contact, 0}};
  for (const auto& [kind, a] : right) {
    const DomainEvent told = merge.take_next();
    CHECK(told.kind == kind);
    CHECK(told.a == a);
  }
  CHECK(merge.empty());
}

TEST_CASE("What follows for an island of three domains comes after what one of them tells", "[parallel]") {
  using Phase = DomainEvent::Cause::Phase;
  // Bodies 1, 4 and 5 of domains 0, 1 and 2 lean on each other; domain 1 tells alone what 4 is struck by, after others.
  const DomainEvent::Cause struck{Phase::contacts, 4, 9};
  const auto following = [&](Kind kind, BodySlot a, DomainIndex other) {
    DomainEvent one = event(1, a, a, kind);
    one.other_owner = other, one.cause = struck;
    return one;
  };
  const auto nobody = DomainEvent::nobody;
  std::vector<std::vector<DomainEvent>> logs(3);
  logs[0] = {following(Kind::mark, 1, 1), following(Kind::mark, 1, 2), following(Kind::wakes, 1, nobody)};
  logs[1] = {event(1, 3, 7), event(1, 4, 9), following(Kind::mark, 1, 0), following(Kind::mark, 1, 2),
             following(Kind::wakes, 4, nobody)};
  logs[2] = {event(1, 2, 8), following(Kind::mark, 1, 0), following(Kind::mark, 1, 1),
             following(Kind::wakes, 5, nobody), event(1, 0, 6)};
  EventMerge merge(std::move(logs));
  for (const BodySlot a : {2u, 3u, 4u, 1u, 4u, 5u, 0u}) CHECK(merge.take_next().a == a);
  CHECK(merge.empty());
}

TEST_CASE("Logs that are not of one history are refused", "[parallel]") {
  auto logs = divided({event(1, 0, 1), event(2, 2, 3)}, 2);
  logs[1].erase(logs[1].begin());
  EventMerge merge(std::move(logs));
  CHECK_THROWS_AS((merge.take_next(), merge.take_next(), merge.take_next()), std::logic_error);
}

}  // namespace kds::collision::test_world_events
