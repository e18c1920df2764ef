#include "tests/fuzz/random_worlds/player.hpp"

#include "collision/shapes/compound.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/fuzz/random_worlds/meshes.hpp"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <exception>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace kds::fuzz {

using collision::BodyDescription;
using collision::WorldOptions;

template <int Degree>
Player<Degree>::Player(const Scenario& scenario, const Way& way, Reactor& reactor)
    : scenario_(scenario),
      way_(way),
      reactor_(reactor),
      bodies_(scenario.bodies),
      world_(std::make_unique<World>(options(way.broad_phase), this)) {}

template <int Degree>
std::vector<Line> Player<Degree>::run() {
  // Of the many calls that fill a large world few can be saved between: to save it takes long.
  const bool large = scenario_.bodies.size() > way_.most_bodies_saved_often;
  for (const Call& call : scenario_.calls) {
    if (given_up()) break;
    if (way_.saves_between_calls && (!large || call.kind == Call::Kind::advance)) save_and_load();
    call_from_outside(call);
  }
  return std::move(log_);
}

template <int Degree>
void Player<Degree>::note(Line::Kind kind, BodyId a, BodyId b, const Contact& contact) {
  log_.push_back({kind, a, b, contact, {}});
  const bool of_a_wall = is_of_a_wall(kind);
  const std::size_t of = kind == Line::Kind::timer ? a : number_of(a);
  const EventKey event{static_cast<std::uint8_t>(kind), of, of_a_wall ? b : number_of(b), 0};
  const Line line = log_.back();  // the log may move
  for (const Call& each : reactor_.react(line, event, bodies_)) call(each, &line.contact);
}

template <int Degree>
void Player<Degree>::note_thrown(const char* what) {
  log_.push_back({Line::Kind::thrown, 0, 0, {.time = world_->now()}, what});
}

/// What should have been refused.
template <int Degree>
void Player<Degree>::note_accepted() {
  log_.push_back({Line::Kind::thrown, 0, 0, {.time = world_->now()}, std::string(not_refused)});
}

/// The clock and the motions as a hash, and who is with whom.
template <int Degree>
void Player<Degree>::note_state() {
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a, word by word
  const auto mix = [&](double x) { hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x100000001b3u; };
  std::string text;
  constexpr std::size_t most_compared = 40;  // each with all others
  std::vector<BodyId> there;
  std::copy_if(ids_.begin(), ids_.end(), std::back_inserter(there), [](BodyId id) { return id != gone; });
  std::sort(there.begin(), there.end());
  for (std::size_t i = 0; i < there.size(); ++i) {
    const BodyId a = there[i];
    const Motion& motion = world_->motion(a);
    mix(motion.start);
    for (const Vector3d& c : motion.coefficients) mix(c[0]), mix(c[1]), mix(c[2]);
    if (there.size() > most_compared) continue;
    for (std::size_t j = i + 1; j < there.size(); ++j) {
      const BodyId b = there[j];
      const char* const how = world_->touching(a, b) ? " touch " : world_->resting(a, b) ? " resting " : nullptr;
      if (how) text += how + std::to_string(a) + '-' + std::to_string(b);
    }
  }
  char letters[32];
  std::snprintf(letters, sizeof letters, "motions %016llx", static_cast<unsigned long long>(hash));
  log_.push_back({Line::Kind::state, 0, 0, {.time = world_->now()}, letters + text});
}

template <int Degree>
WorldOptions Player<Degree>::options(BroadPhaseKind broad_phase) const {
  constexpr std::uint64_t most_edits = 300;  // callbacks that go on for ever are stopped soon
  WorldOptions result;
  result.start_time = scenario_.start_time;
  result.window = way_.window;
  result.response = scenario_.response;
  result.broad_phase = broad_phase;
  result.rate = broad_phase == BroadPhaseKind::sap ? way_.rate : 0;
  result.kdop = broad_phase == BroadPhaseKind::kinetic_sap ? way_.kdop : 6;
  result.report_pairs = scenario_.report_pairs;
  result.report_pieces = scenario_.report_pieces;
  result.threads = way_.threads;
  result.zeno = {scenario_.zeno_contacts, scenario_.zeno_interval};
  result.most_edits = most_edits;
  if (scenario_.walls) {
    const Vector3d corner = Vector3d::Constant(scenario_.wall.half_side * scenario_.unit);
    result.walls = collision::Walls{-corner, corner, scenario_.wall.restitution};
  }
  return result;
}

template <int Degree>
typename Player<Degree>::Motion Player<Degree>::motion(const Path& path) const {
  Motion result;
  result.start = world_->now() + path.start;
  result.coefficients[0] = scenario_.unit * path.place;
  result.coefficients[1] = scenario_.unit * path.velocity;
  if constexpr (Degree == 2) result.coefficients[2] = scenario_.unit * path.half_acceleration;
  return result;
}

template <int Degree>
BodyDescription<Degree> Player<Degree>::description(const BodyPlan& plan) {
  BodyDescription<Degree> result;
  const Vector3d size = way_.growth * scenario_.unit * plan.size;
  switch (plan.shape) {
    case ShapeKind::ball:
      result.shape = collision::Sphere{size[0]};
      break;
    case ShapeKind::box:
      result.shape = collision::Box{size};
      break;
    case ShapeKind::capsule:
      result.shape = collision::Capsule{size[0], size[1]};
      break;
    case ShapeKind::hull:
      result.shape = collision::convex_hull(cut_box(size));
      break;
    case ShapeKind::compound:
      result.shape = collision::compound(angle(size));
      break;
    case ShapeKind::half_space:
      result.shape = collision::HalfSpace{plan.size};
      break;
    case ShapeKind::mesh:
      result.shape = collision::MeshShape{sample_meshes()[plan.mesh], size[0]};
      break;
  }
  result.orientation = plan.orientation;
  for (const Path& piece : plan.pieces) result.motion.push_back(motion(piece));
  result.mass = plan.mass;
  result.restitution = plan.restitution;
  result.fixed = plan.fixed;
  result.category = plan.category;
  result.collides_with = plan.collides_with;
  result.group = plan.group;
  result.sensor = plan.sensor;
  result.volume = plan.volume;
  if (plan.box_function) {
    const collision::PlacedShape placed = place(result.shape, result.orientation);
    const Vector3d margin = Vector3d::Constant(plan.box_margin * scenario_.unit);
    result.box = [this, low = Vector3d(placed.low - margin), high = Vector3d(placed.high + margin),
                  validity = plan.box_validity, edits = plan.box_edits](double t, const Motion& path) {
      if (edits) edit_in_box_function();
      auto box = collision::box_around<Degree>(path, low, high);
      box.valid_until = t + validity;
      return box;
    };
  }
  return result;
}

template <int Degree>
void Player<Degree>::save_and_load() {
  try {
    const kds::Snapshot saved = kds::save(*world_);
    if (way_.runs_ahead) {
      run_ahead();
      return kds::restore(saved, *world_);
    }
    auto other = std::make_unique<World>(options(loaded_before_ ? way_.broad_phase : way_.load_into), this);
    kds::restore(saved, *other);
    world_ = std::move(other);
    loaded_before_ = !loaded_before_;
  } catch (const std::exception& error) {
    stopped_ = true;
    note_thrown(error.what());
  }
}

/// Some steps, of which nothing is left but in the world.
template <int Degree>
void Player<Degree>::run_ahead() {
  constexpr int steps_ahead = 6;
  const auto bodies = bodies_;
  const auto ids = ids_;
  const auto numbers = numbers_;
  const std::size_t lines = log_.size();
  reactor_.go_ahead(true);
  try {
    const double limit = world_->now() + 0.5;
    for (int i = 0; i < steps_ahead && world_->step(limit); ++i) continue;
  } catch (const std::exception&) {  // so it is when these steps are made again
  }
  reactor_.go_ahead(false);
  log_.resize(lines);
  bodies_ = bodies, ids_ = ids, numbers_ = numbers;
}

template class Player<1>;
template class Player<2>;

std::vector<Line> play(const Scenario& scenario, const Way& way, Reactor& reactor) {
  return scenario.degree == 1 ? Player<1>(scenario, way, reactor).run() : Player<2>(scenario, way, reactor).run();
}

}  // namespace kds::fuzz
