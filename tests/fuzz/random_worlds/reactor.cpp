#include "tests/fuzz/random_worlds/reactor.hpp"

#include <array>
#include <bit>
#include <cstdint>

namespace kds::fuzz {
namespace {

constexpr std::size_t most_calls = 3;
/// Reactions that are refused, or throw, end others, so there are few.
constexpr std::size_t one_is_refused_in = 100;

std::uint64_t mixed(std::uint64_t hash, std::uint64_t value) {
  hash = (hash ^ value) * 0xbf58476d1ce4e5b9u;
  return hash ^ (hash >> 29);
}

bool is_of_two_bodies(Line::Kind kind) {
  return !is_of_a_wall(kind) && kind != Line::Kind::moved && kind != Line::Kind::piece && kind != Line::Kind::timer;
}

EventKey counted(const EventKey& event, std::map<EventKey, std::size_t>& counts) {
  EventKey result = event;
  result.count = counts[event]++;
  return result;
}

/// Some are not for one of the bodies that are there.
Call::Kind draw_kind(Random& random, Call::Kind kind) {
  using enum Call::Kind;
  if (random.one_in(one_is_refused_in)) return std::array{advance, save, fail}[random.below(3)];
  return random.one_in(8) ? add : kind;
}

}  // namespace

std::vector<Call> RandomReactor::react(const Line& line, const EventKey& event, std::vector<BodyPlan>& bodies) {
  using enum Call::Kind;
  if (scenario_.reaction_rate == 0) return {};
  std::uint64_t hash = mixed(scenario_.seed, std::bit_cast<std::uint64_t>(line.contact.time));
  hash = mixed(hash, std::uint64_t{body_slot(line.a)} << 32 | body_slot(line.b));
  // Bodies that take turns in a slot, each put there by a callback, must not be treated all alike, without end.
  const std::uint64_t generations = std::uint64_t{body_generation(line.a)} << 32 | body_generation(line.b);
  if (generations != 0) hash = mixed(hash, generations);
  hash = mixed(hash, static_cast<std::uint64_t>(line.kind));
  std::vector<Call> calls;
  const bool responds = scenario_.response == Response::callback && line.kind == Line::Kind::contact;
  if (responds) {  // the first is turned off the other, or both are
    calls.push_back({.kind = push_off, .body = event.a, .other = hash & 1 ? event.b : event.a});
  }
  if ((hash >> 8) % scenario_.reaction_rate != 0) return calls;
  Random random(hash);
  for (std::size_t n = 1 + random.below(most_calls); n > 0; --n) {
    const auto one_of_the_event = [&] { return is_of_two_bodies(line.kind) && random.one_in(2) ? event.b : event.a; };
    Call call = draw_call(random, style_, bodies.size());
    call.kind = draw_kind(random, call.kind);
    if (random.one_in(2)) call.body = one_of_the_event();
    if (random.one_in(2)) call.other = one_of_the_event();
    if (call.kind == add) {
      // In place of another one, whose id it then gets.
      if (random.one_in(2)) calls.push_back({.kind = remove, .body = call.body});
      call.body = bodies.size();
      bodies.push_back(draw_body(random, style_));
      if (style_.sensors && random.one_in(2)) call.kind = attach;
    }
    calls.push_back(call);
  }
  return calls;
}

WrittenReactor::WrittenReactor(const Scenario& scenario) {
  for (const Reaction& reaction : scenario.reactions) calls_[reaction.event] = &reaction.calls;
}

std::vector<Call> WrittenReactor::react(const Line& /*line*/, const EventKey& event, std::vector<BodyPlan>& /*all*/) {
  if (calls_.empty()) return {};
  const auto found = calls_.find(counted(event, counts_));
  return found == calls_.end() ? std::vector<Call>{} : *found->second;
}

void WrittenReactor::go_ahead(bool ahead) {
  if (ahead) {
    kept_ = counts_;
  } else {
    counts_ = kept_;
  }
}

std::vector<Call> WritingReactor::react(const Line& line, const EventKey& event, std::vector<BodyPlan>& bodies) {
  std::vector<Call> calls = other_.react(line, event, bodies);
  if (ahead_) return calls;
  const EventKey key = counted(event, counts_);
  if (!calls.empty()) reactions_.push_back({key, calls});
  bodies_ = bodies;
  return calls;
}

Scenario WritingReactor::written(Scenario scenario) const {
  scenario.reactions_are_written_down = true;
  scenario.reactions = reactions_;
  if (!bodies_.empty()) scenario.bodies = bodies_;
  return scenario;
}

}  // namespace kds::fuzz
