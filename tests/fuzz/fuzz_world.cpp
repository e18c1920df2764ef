// Worlds under any sequence of calls, made from outside and from callbacks: every broad phase gives the same events in
// the same order, the audit holds after every step, and contact is what a plain test of all pairs says.
#include "collision/narrow_phase/narrow_phase.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/collision/random_scenes.hpp"
#include "tests/fuzz/bytes.hpp"
#include "tests/fuzz/check.hpp"

#include <algorithm>
#include <array>
#include <sstream>
#include <string>
#include <vector>

namespace kds::fuzz {
namespace {

using namespace collision;
using namespace collision::tests;

constexpr int most_operations = 40;
constexpr std::size_t most_bodies = 8;
/// A scenario is given up behind so many events.
constexpr std::size_t most_events = 300;

/// Numbers for a callback, from the input's own seed and what has happened.
Random numbers_for(const Event& e, std::uint64_t seed) {
  std::uint64_t mix = seed ^ std::bit_cast<std::uint64_t>(e.time());
  mix = mix * 0x9e3779b97f4a7c15 ^ (std::rotl(e.a, 40) ^ std::rotl(e.b, 8));
  return Random(mix * 0x9e3779b97f4a7c15 ^ static_cast<std::uint64_t>(e.kind));
}

struct Options {
  Response response;
  bool walls;
  bool meshes;
  bool edits;  ///< callbacks change things
  std::uint64_t seed;

  // What the seed's bits say.
  bool pairs() const { return (seed & 1) != 0; }  ///< of bounding volumes are among the events
  bool fixed_move() const { return (seed & 2) != 0; }
  bool walls_without_response() const { return (seed & 32) != 0; }
  double restitution() const { return (seed & 64) != 0 ? 0.5 : 1; }
  double restitution_of_walls() const { return (seed & 64) != 0 ? std::array{1.0, 0.75, 0.25, 0.0}[seed >> 2 & 3] : 1; }
};

template <int Degree>
class Scenario {
 public:
  Scenario(Bytes bytes, const Options& options, BroadPhaseKind broad_phase)
      : bytes_(bytes), options_(options), world_(world_options(broad_phase), &log_) {
    if (options_.edits) log_.then = [this](World<Degree>& world, const Event& e) { edit(world, e); };
  }

  std::vector<Event> run() {
    for (std::size_t n = 2 + bytes_.below(most_bodies - 1); n > 0; --n) add(description());
    for (int i = 0; i < most_operations && !bytes_.empty() && !too_long(); ++i) operation();
    return log_.events;
  }
  bool too_long() const { return log_.events.size() > most_events; }

 private:
  WorldOptions world_options(BroadPhaseKind broad_phase) const {
    WorldOptions options;
    options.response = options_.response;
    options.broad_phase = broad_phase;
    options.rate = broad_phase == BroadPhaseKind::sap ? 8 : 0;
    options.report_pairs = options_.pairs();
    if (options_.walls) {
      options.walls =
          collision::Walls{Vector3d::Constant(-16), Vector3d::Constant(16), options_.restitution_of_walls()};
    }
    return options;
  }

  Vector3d vector() { return {bytes_.number(), bytes_.number(), bytes_.number()}; }

  certificates::PointMotion<Degree> path() {
    const Vector3d c0 = 0.5 * vector();  // near each other
    const Vector3d c1 = vector();
    return motion<Degree>(c0, c1, bytes_.one_in(2) ? vector() : zero, world_.now());
  }

  Shape shape() {
    const double size = 0.25 * bytes_.integer(1, 8);
    switch (bytes_.below(options_.meshes ? 4 : 2)) {
      case 0:
        return Sphere{size};
      case 1:
        return Box{{size, 0.25 * bytes_.integer(1, 8), 0.25 * bytes_.integer(1, 8)}};
      case 2:
        return MeshShape{tetrahedron(), size};
      default:
        return MeshShape{cube(), size};
    }
  }

  BodyDescription<Degree> description() {
    const Shape chosen = shape();
    auto result = body<Degree>(chosen, path());
    if (bytes_.one_in(2)) {
      const double w = bytes_.integer(1, 4);
      const Vector3d v{double(bytes_.integer(-3, 3)), double(bytes_.integer(-3, 3)), double(bytes_.integer(-3, 3))};
      result.orientation = Eigen::Quaterniond(w, v[0], v[1], v[2]).normalized();
    }
    result.mass = 0.5 * bytes_.integer(1, 8);
    result.fixed = bytes_.one_in(8);
    result.restitution = options_.restitution();
    if (result.fixed && !options_.fixed_move()) {
      result.motion = {motion<Degree>(result.motion[0].coefficients[0], zero, zero, world_.now())};
    }
    if (bytes_.one_in(8)) result.collides_with = static_cast<std::uint32_t>(bytes_.integer(0, 1));
    if (options_.response == Response::none && bytes_.one_in(3)) {  // a script, perhaps one that begins later
      auto next = path();
      next.start += 0.25 * bytes_.integer(1, 8);
      if (bytes_.one_in(4))
        result.motion = {next};
      else
        result.motion.push_back(next);
    }
    return result;
  }

  void add(const BodyDescription<Degree>& description) {
    const BodyId id = world_.add_body(description);
    last_in_[body_slot(id)] = id;
  }
  /// Perhaps of one that was removed, or has never been there.
  BodyId any_body() { return last_in_[bytes_.below(most_bodies)]; }

  void operation() {
    switch (bytes_.below(8)) {
      case 0:
      case 1:
      case 2:
        if (world_.size() < most_bodies) add(description());
        break;
      case 3: {
        const BodyId id = any_body();
        if (world_.contains(id)) world_.remove_body(id);
        break;
      }
      case 4: {
        const BodyId id = any_body();
        const auto to = path();
        if (world_.contains(id) && !world_.fixed(id)) world_.update_motion(id, to);
        break;
      }
      default:
        advance(world_.now() + 0.125 * bytes_.integer(0, 16));
    }
  }

  void advance(double limit) {
    while (!too_long() && world_.step(limit)) world_.audit();
    world_.audit();
    if (!too_long()) check_contacts();
  }

  /// Mode none: bodies are in contact if and only if the world says so.
  void check_contacts() const {
    if (options_.response != Response::none || options_.edits) return;
    for (const BodyId a : last_in_) {
      for (const BodyId b : last_in_) {
        if (body_slot(a) >= body_slot(b) || !world_.contains(a) || !world_.contains(b) || !both_round(a, b) ||
            !both_in(a, b))
          continue;
        const PlacedShape shape_a = world_.shape(a);
        const PlacedShape shape_b = world_.shape(b);
        const bool touch = in_contact(TranslatingShape<Degree>{shape_a, world_.motion(a)},
                                      TranslatingShape<Degree>{shape_b, world_.motion(b)}, world_.now());
        if (world_.touching(a, b) && !touch) throw Failure("bodies are said to touch and do not");
      }
    }
  }
  /// Exact signs are for spheres and boxes alone.
  bool both_round(BodyId a, BodyId b) const {
    return !std::holds_alternative<MeshShape>(world_.shape(a).shape) &&
           !std::holds_alternative<MeshShape>(world_.shape(b).shape);
  }
  bool both_in(BodyId a, BodyId b) const {
    return world_.motion(a).start <= world_.now() && world_.motion(b).start <= world_.now();
  }

  void edit(World<Degree>& world, const Event& e) {
    Random random = numbers_for(e, options_.seed);
    if (options_.response == Response::callback && e.kind == Kind::contact) bounce(world, e);
    if (random.below(8) != 0 || !world.contains(e.a)) return;
    const auto small = [&] { return random.integer(-8, 8) * 0.5; };
    const Vector3d c0{small(), small(), small()};
    const Vector3d c1{small(), small(), small()};
    const auto path = motion<Degree>(c0, c1, zero, world.now());
    switch (random.below(4)) {
      case 0:
        return world.remove_body(e.a);
      case 1:
        if (e.kind != Kind::wall && world.contains(e.b)) world.remove_body(e.b);
        return;
      case 2:
        if (!world.fixed(e.a)) world.update_motion(e.a, path);
        return;
      default:
        if (world.size() < most_bodies) add(body<Degree>(Sphere{0.5}, path));
    }
  }

  static std::array<BodyId, most_bodies> first_ids() {
    std::array<BodyId, most_bodies> ids;
    for (std::size_t i = 0; i < most_bodies; ++i) ids[i] = i;
    return ids;
  }

  /// The first turns round.
  static void bounce(World<Degree>& world, const Event& e) {
    if (world.fixed(e.a)) return;
    const Vector3d place = world.motion(e.a).position(world.now());
    world.update_motion(e.a, motion<Degree>(place, -2 * e.contact.normal, zero, world.now()));
  }

  Bytes bytes_;
  Options options_;
  EventLog<Degree> log_;
  World<Degree> world_;
  std::array<BodyId, most_bodies> last_in_ = first_ids();  ///< by slot
};

std::string shown(const std::vector<Event>& events, std::size_t at) {
  std::ostringstream text;
  if (at < events.size())
    text << events[at];
  else
    text << "nothing";
  return text.str();
}

template <int Degree>
void compare_broad_phases(const Bytes& bytes, const Options& options) {
  Scenario<Degree> reference(bytes, options, BroadPhaseKind::all_pairs);
  const std::vector<Event> expected = reference.run();
  if (reference.too_long()) return;
  for (const auto& [kind, name, what] : broad_phases) {
    if (kind == BroadPhaseKind::all_pairs) continue;
    const std::vector<Event> found = Scenario<Degree>(bytes, options, kind).run();
    const auto [f, e] = std::mismatch(found.begin(), found.end(), expected.begin(), expected.end());
    if (f == found.end() && e == expected.end()) continue;
    const auto at = static_cast<std::size_t>(f - found.begin());
    throw Failure(std::string(name) + " against all-pairs: event " + std::to_string(at) + ": " + shown(found, at) +
                  "\n  instead of " + shown(expected, at));
  }
}

}  // namespace

void run(std::span<const std::uint8_t> input) {
  Bytes bytes(input);
  Options options{};
  const bool quadratic = bytes.one_in(2);
  constexpr std::array responses{Response::none, Response::elastic, Response::callback};
  options.response = responses[bytes.below(responses.size())];
  options.walls = options.response != Response::none && bytes.one_in(2);
  options.meshes = bytes.one_in(4);
  options.edits = options.response == Response::callback || bytes.one_in(2);
  options.seed = bytes.byte();
  if (options.response == Response::none) options.walls = options.walls_without_response();
  quadratic ? compare_broad_phases<2>(bytes, options) : compare_broad_phases<1>(bytes, options);
}

}  // namespace kds::fuzz
