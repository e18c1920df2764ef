// Runs of boxes and balls that bounce, proved in exact arithmetic: so a contact that every broad phase misses alike, or
// a motion that is wrong in all of them, is seen.
#include "tests/collision/elastic_record.hpp"
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>

namespace kds::collision::test_elastic_oracle {
namespace {

using namespace tests;

template <int Degree>
struct Drawn {
  Scene<Degree> scene;
  WorldOptions options;
};

/// Lattices, on which ties are frequent, and random numbers; in walls and without; bodies of unequal mass, some fixed,
/// of which some move. Parabolas: all bodies fall alike, or each is accelerated in its own way.
template <int Degree>
Drawn<Degree> draw(std::uint64_t seed) {
  Random random(seed);
  const bool lattice = random.one_in(2);
  const bool in_walls = !random.one_in(3);
  const int kinds = random.integer(0, 3);  // balls, boxes, and twice both
  const bool fall = random.one_in(2);
  const double side = random.integer(1, 3);
  const auto number = [&](double low, double high) {
    return lattice ? random.integer(static_cast<int>(2 * low), static_cast<int>(2 * high)) * 0.5
                   : random.between(low, high);
  };
  const auto size = [&] { return lattice ? 0.25 * random.integer(1, 3) : random.between(0.2, 0.8); };
  const auto vector = [&](double low, double high) {
    const double x = number(low, high), y = number(low, high), z = number(low, high);
    return Vector3d(x, y, z);
  };
  const double elastic = random.one_in(2) ? 1 : 0.25 * random.integer(2, 4);
  Drawn<Degree> drawn;
  drawn.options.response = Response::elastic;
  drawn.scene.end_time = 4;
  for (int bodies = random.integer(2, 7); bodies > 0; --bodies) {
    const bool box = kinds == 1 || (kinds >= 2 && random.one_in(2));
    Shape shape = Sphere{size()};
    if (box) {
      const double x = size(), y = size(), z = size();
      shape = Box{{x, y, z}};
    }
    const Vector3d place = vector(-side, side);
    Vector3d speed = vector(-3, 3);
    for (int d = 0; d < 3; ++d) {
      if (random.one_in(4)) speed[d] = 0;
    }
    Vector3d acceleration = Vector3d::Zero();
    if (Degree == 2) acceleration = fall ? Vector3d(0, 0, -2) : vector(-1, 1);
    auto description = body<Degree>(shape, motion<Degree>(place, speed, acceleration));
    description.mass = random.one_in(2) ? 1
                       : lattice        ? std::ldexp(1.0, random.integer(-2, 3))
                                        : random.between(0.1, 10);
    description.fixed = random.one_in(5);
    if (description.fixed) {
      if (random.one_in(3)) {
        description.motion = {motion<Degree>(place, speed)};
      } else {
        description.motion = {motion<Degree>(place)};
      }
    }
    description.restitution = random.one_in(3) ? 1 : elastic;
    drawn.scene.bodies.push_back(description);
  }
  if (in_walls) {
    const Vector3d half = Vector3d::Constant(side + 1);
    drawn.options.walls = Walls{-half, half, elastic};
  }
  return drawn;
}

struct Seen {
  std::size_t contacts = 0, walls = 0, overlaps = 0, ties = 0, cut = 0, grazes = 0;

  void count(const oracle::ElasticRun& run) {
    using Kind = oracle::ElasticEvent::Kind;
    double before = -never;
    for (const auto& event : run.events) {
      (event.kind == Kind::contact ? contacts : event.kind == Kind::wall ? walls : overlaps) += 1;
      ties += event.kind != Kind::overlap && event.time == before;
      before = event.time;
    }
    cut += run.cut;
  }
};

TEMPLATE_TEST_CASE_SIG("Bounces of small scenes are proved in exact arithmetic, for every broad phase", "[oracle]",
                       ((int Degree), Degree), 1, 2) {
  // More by hand: KDS_ORACLE_SEEDS="FIRST LAST".
  std::uint64_t first = 1, last = Degree == 1 ? 600 : 40;
  if (const char* seeds = std::getenv("KDS_ORACLE_SEEDS")) {
    char* rest = nullptr;
    first = std::strtoull(seeds, &rest, 10);
    last = std::strtoull(rest, nullptr, 10);
  }
  Seen seen;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    INFO("seed " << seed);
    auto [scene, options] = draw<Degree>(seed);
    const auto run = record(scene, options);
    const oracle::Verdict verdict = oracle::prove(run);
    CHECK(verdict.complaint == "");
    seen.count(run);
    seen.grazes += verdict.grazes;
    for (const auto method : all_methods) {
      INFO("broad phase " << static_cast<int>(method));
      options.broad_phase = method;
      options.rate = method == BroadPhaseKind::sap ? 16 : 0;
      CHECK(record(scene, options).events == run.events);
    }
  }
  const auto runs = static_cast<std::size_t>(last - first + 1);
  INFO(seen.contacts << " contacts, " << seen.walls << " at walls, " << seen.overlaps << " overlaps, " << seen.ties
                     << " ties, " << seen.cut << " runs cut, " << seen.grazes << " grazes");
  CHECK(seen.contacts > 3 * runs);
  CHECK(seen.walls > 3 * runs);
  CHECK(seen.overlaps > runs / 2);
  CHECK(seen.ties > (Degree == 1 ? runs / 2 : runs / 20));
  CHECK(seen.cut < runs / 2);
  CHECK(seen.grazes < runs / 20);
}

/// Where it is among the events of a run, if it has one.
std::optional<std::size_t> last_contact(const oracle::ElasticRun& run) {
  for (std::size_t i = run.events.size(); i-- > 0;) {
    if (run.events[i].kind == oracle::ElasticEvent::Kind::contact) return i;
  }
  return std::nullopt;
}

TEST_CASE("A contact that a log does not have is seen, and one that comes a spacing late", "[oracle]") {
  int left_out = 0, delayed = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    INFO("seed " << seed);
    const auto [scene, options] = draw<1>(seed);
    const auto run = record(scene, options);
    if (oracle::prove(run).grazes > 0) continue;
    for (std::size_t i = 0; i < run.events.size(); ++i) {
      if (run.events[i].kind != oracle::ElasticEvent::Kind::contact) continue;
      if (run.cut && run.events[i].time == run.end) continue;  // it may be among those cut off
      auto other = run;
      other.events.erase(other.events.begin() + static_cast<std::ptrdiff_t>(i));
      CHECK(oracle::prove(other).complaint != "");
      ++left_out;
    }
    if (const auto i = last_contact(run); i && run.events[*i].time > 0) {
      auto other = run;
      auto& event = other.events[*i];
      for (auto& piece : event.motions) {
        if (piece.start == event.time) piece.start = next_up(event.time);
      }
      event.time = next_up(event.time);
      CHECK(oracle::prove(other).complaint != "");
      ++delayed;
    }
  }
  CHECK(left_out > 100);
  CHECK(delayed > 20);
}

TEST_CASE("A pair that a world never tests is seen", "[oracle]") {
  int blinded = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    INFO("seed " << seed);
    auto [scene, options] = draw<1>(seed);
    const auto run = record(scene, options);
    const auto i = last_contact(run);
    if (!i || run.cut || oracle::prove(run).grazes > 0) continue;
    const auto& event = run.events[*i];
    auto& a = scene.bodies[event.a];
    auto& b = scene.bodies[event.b];
    a.category = 2, a.collides_with = ~4u;
    b.category = 4, b.collides_with = ~2u;
    const std::string complaint = oracle::prove(record(scene, options)).complaint;
    const std::string pair =
        std::to_string(event.a) + (complaint.find("overlap") == std::string::npos ? " meets body " : " and ");
    CHECK(complaint.find(pair + std::to_string(event.b)) != std::string::npos);
    ++blinded;
  }
  CHECK(blinded > 20);
}

}  // namespace
}  // namespace kds::collision::test_elastic_oracle
