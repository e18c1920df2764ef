// What callbacks do to the world: decided by the event alone, so that it is the same in every run with the same log.
#pragma once

#include "tests/fuzz/random_worlds/draw.hpp"
#include "tests/fuzz/random_worlds/log.hpp"
#include "tests/fuzz/random_worlds/scenario.hpp"

#include <cstddef>
#include <map>
#include <vector>

namespace kds::fuzz {

class Reactor {
 public:
  virtual ~Reactor() = default;
  /// The calls to make at an event. `event` names its bodies by their numbers in `bodies`; those that calls add are
  /// appended to it.
  virtual std::vector<Call> react(const Line& line, const EventKey& event, std::vector<BodyPlan>& bodies) = 0;
  /// What comes now will be undone, or (false) has been.
  virtual void go_ahead(bool /*ahead*/) {}
};

/// Random calls, from the seed of the scenario and the bits of the event.
class RandomReactor final : public Reactor {
 public:
  RandomReactor(const Scenario& scenario, const Style& style) : scenario_(scenario), style_(style) {}
  std::vector<Call> react(const Line& line, const EventKey& event, std::vector<BodyPlan>& bodies) override;

 private:
  const Scenario& scenario_;
  const Style& style_;
};

/// The calls that are written down in the scenario.
class WrittenReactor final : public Reactor {
 public:
  explicit WrittenReactor(const Scenario& scenario);
  std::vector<Call> react(const Line& line, const EventKey& event, std::vector<BodyPlan>& bodies) override;
  void go_ahead(bool ahead) override;

 private:
  std::map<EventKey, const std::vector<Call>*> calls_;
  std::map<EventKey, std::size_t> counts_;
  std::map<EventKey, std::size_t> kept_;
};

/// Asks another one, and writes down what it says.
class WritingReactor final : public Reactor {
 public:
  explicit WritingReactor(Reactor& other) : other_(other) {}
  std::vector<Call> react(const Line& line, const EventKey& event, std::vector<BodyPlan>& bodies) override;
  void go_ahead(bool ahead) override { ahead_ = ahead, other_.go_ahead(ahead); }

  /// The scenario with what has been written down, in place of random reactions.
  Scenario written(Scenario scenario) const;

 private:
  Reactor& other_;
  bool ahead_ = false;
  std::map<EventKey, std::size_t> counts_;
  std::vector<Reaction> reactions_;
  std::vector<BodyPlan> bodies_;
};

}  // namespace kds::fuzz
