// Runs a scenario in one way and writes down what happens.
#pragma once

#include "collision/world.hpp"
#include "tests/fuzz/random_worlds/log.hpp"
#include "tests/fuzz/random_worlds/reactor.hpp"
#include "tests/fuzz/random_worlds/scenario.hpp"
#include "tests/fuzz/random_worlds/way.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

namespace kds::fuzz {

template <int Degree>
class Player final : public collision::WorldListener<Degree> {
 public:
  Player(const Scenario& scenario, const Way& way, Reactor& reactor);

  std::vector<Line> run();

 private:
  using World = collision::World<Degree>;
  using Motion = certificates::PointMotion<Degree>;
  using PairEvent = collision::PairEvent;
  using WallEvent = collision::WallEvent;

  void contact(World&, const PairEvent& e) override { note(Line::Kind::contact, e.a, e.b, e.contact); }
  void separation(World&, const PairEvent& e) override { note(Line::Kind::separation, e.a, e.b, e.contact); }
  void overlap(World&, const PairEvent& e) override { note(Line::Kind::overlap, e.a, e.b, e.contact); }
  void rebound_suppressed(World&, const PairEvent& e) override {
    note(Line::Kind::rebound_suppressed, e.a, e.b, e.contact);
  }
  void wall(World&, const WallEvent& e) override { note_wall(Line::Kind::wall, e); }
  void rebound_suppressed_at_wall(World&, const WallEvent& e) override {
    note_wall(Line::Kind::rebound_suppressed_at_wall, e);
  }
  void rests(World&, const PairEvent& e) override { note(Line::Kind::rests, e.a, e.b, e.contact); }
  void rests_at_wall(World&, const WallEvent& e) override { note_wall(Line::Kind::rests_at_wall, e); }
  void wakes(World&, const PairEvent& e) override { note(Line::Kind::wakes, e.a, e.b, e.contact); }
  void wakes_at_wall(World&, const WallEvent& e) override { note_wall(Line::Kind::wakes_at_wall, e); }
  void passes(World&, const PairEvent& e) override { note(Line::Kind::passes, e.a, e.b, e.contact); }
  void pair_began(World&, BodyId a, BodyId b, double t) override { note(Line::Kind::pair_began, a, b, {.time = t}); }
  void pair_ended(World&, BodyId a, BodyId b, double t) override { note(Line::Kind::pair_ended, a, b, {.time = t}); }
  void moved(World& world, BodyId a) override { note(Line::Kind::moved, a, 0, {.time = world.now()}); }

  void piece(World& world, BodyId a) override { note(Line::Kind::piece, a, 0, {.time = world.now()}); }
  void timer(World& world, collision::TimerId timer) override {
    note(Line::Kind::timer, timer, 0, {.time = world.now()});
  }

  void note(Line::Kind kind, BodyId a, BodyId b, const Contact& contact);
  void note_wall(Line::Kind kind, const WallEvent& e) { note(kind, e.body, e.wall, e.contact); }
  void note_thrown(const char* what);
  void note_accepted();
  void note_state();

  collision::WorldOptions options(BroadPhaseKind broad_phase) const;
  collision::BodyDescription<Degree> description(const BodyPlan& plan);
  void edit_in_box_function();
  Motion motion(const Path& path) const;

  void call_from_outside(const Call& call);
  void call(const Call& call, const Contact* contact);
  void add(std::size_t body, std::optional<std::size_t> owner = std::nullopt);
  void append(BodyId id, const Call& call);
  void push_off(std::size_t body, const Vector3d& normal);
  void must_be_refused(const Call& call);
  void advance(double seconds);
  bool step_up_to(double limit);
  void save_and_load();
  void run_ahead();

  static constexpr BodyId gone = ~BodyId{0};
  BodyId id_of(std::size_t body) const { return body < ids_.size() ? ids_[body] : gone; }
  /// Whether it is there, and calls may change its motion.
  bool moves(std::size_t body) const {
    const BodyId id = id_of(body);
    return id != gone && !world_->attached_to(id) && (scenario_.fixed_bodies_move || !world_->fixed(id));
  }
  std::size_t number_of(BodyId id) const {
    const auto found = numbers_.find(id);
    return found != numbers_.end() ? found->second : 0;
  }
  bool given_up() const { return stopped_ || log_.size() > scenario_.most_events; }

  const Scenario& scenario_;
  Way way_;
  Reactor& reactor_;
  std::vector<BodyPlan> bodies_;
  std::vector<BodyId> ids_;  // by number of the body
  std::unordered_map<BodyId, std::size_t> numbers_;
  std::vector<Line> log_;
  std::unique_ptr<World> world_;
  std::size_t steps_ = 0;
  bool loaded_before_ = false;
  bool stopped_ = false;
};

extern template class Player<1>;
extern template class Player<2>;

/// Runs a scenario of either degree.
std::vector<Line> play(const Scenario& scenario, const Way& way, Reactor& reactor);

}  // namespace kds::fuzz
