// The screening against a sampler that shares no code with it: its own propagation, all pairs, small steps.
#include "examples/jobs/conjunctions/catalogue.hpp"
#include "examples/jobs/conjunctions/screening.hpp"
#include "examples/jobs/conjunctions/sieve.hpp"
#include "examples/jobs/conjunctions/trajectory.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace test_conjunctions {

using namespace conjunctions;

constexpr double pi = std::numbers::pi;

/// Place of a satellite, km, by the true anomaly, and Kepler's equation solved by bisection.
std::array<double, 3> place(const Elements& elements, double t) {
  const auto [a, e, i, node, perigee, anomaly] = elements;
  const double mean = std::fmod(anomaly + std::sqrt(398600.4418 / (a * a * a)) * t, 2 * pi);
  double low = mean - 1, high = mean + 1;  // E - M = e sin E
  for (int k = 0; k < 60; ++k) {
    const double middle = (low + high) / 2;
    (middle - e * std::sin(middle) < mean ? low : high) = middle;
  }
  const double half = low / 2;
  const double from_perigee = 2 * std::atan2(std::sqrt(1 + e) * std::sin(half), std::sqrt(1 - e) * std::cos(half));
  const double r = a * (1 - e * e) / (1 + e * std::cos(from_perigee));
  const double u = perigee + from_perigee;
  return {r * (std::cos(node) * std::cos(u) - std::sin(node) * std::sin(u) * std::cos(i)),
          r * (std::sin(node) * std::cos(u) + std::cos(node) * std::sin(u) * std::cos(i)),
          r * std::sin(u) * std::sin(i)};
}

double between(const std::array<double, 3>& p, const std::array<double, 3>& q) {
  return std::sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) + (p[2] - q[2]) * (p[2] - q[2]));
}
double distance(const Elements& a, const Elements& b, double t) { return between(place(a, t), place(b, t)); }

struct Nearest {
  std::size_t a, b;
  double time, distance;
};

/// All minima of distances below a limit, from 0 to the end, by samples `step` apart, of objects on circles in one
/// shell: none is faster than `fastest`, so a pair that is farther apart does not come nearer than the limit.
std::vector<Nearest> sampled(const std::vector<Elements>& catalogue, double end, double step, double limit) {
  std::vector<Nearest> found;
  const double fastest = 7.5;  // km/s; 7.47 at 795 km
  const std::size_t n = catalogue.size();
  std::vector<std::array<double, 3>> places(n);
  for (double t = step / 2; t < end; t += step) {
    for (std::size_t i = 0; i < n; ++i) places[i] = place(catalogue[i], t);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + 1; j < n; ++j) {
        if (between(places[i], places[j]) > limit + 2 * fastest * step / 2) continue;
        // Golden section over this step and a little more; a minimum at an end is that of another step.
        double low = t - 0.6 * step, high = t + 0.6 * step;
        while (high - low > 1e-6) {
          const double x = high - 0.618 * (high - low), y = low + 0.618 * (high - low);
          const bool left = distance(catalogue[i], catalogue[j], x) < distance(catalogue[i], catalogue[j], y);
          (left ? high : low) = left ? y : x;
        }
        if (std::abs(low - t) > 0.59 * step || low < 0 || low > end) continue;
        const double nearest = distance(catalogue[i], catalogue[j], low);
        const bool known = std::any_of(found.begin(), found.end(), [&, i = i, j = j](const Nearest& other) {
          return other.a == i && other.b == j && std::abs(other.time - low) < 0.01;
        });
        if (nearest < limit && !known) found.push_back({i, j, low, nearest});
      }
    }
  }
  return found;
}

std::vector<Conjunction> all(auto&& method, const std::vector<Elements>& catalogue, const Screening& options) {
  std::vector<Conjunction> found;
  method(catalogue, options, [&](const Conjunction& conjunction) { found.push_back(conjunction); });
  std::sort(found.begin(), found.end(), [](const Conjunction& x, const Conjunction& y) {
    return std::array{x.entry, double(x.a), double(x.b)} < std::array{y.entry, double(y.a), double(y.b)};
  });
  return found;
}

constexpr double off = 2 * interpolation_error;  // of the distance of two objects, km

TEST_CASE("conjunctions: none missed and none false, by a sampler of its own") {
  const auto seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  const std::vector<Elements> catalogue = dense_shell(300, seed);
  const Screening options{.distance = 5, .hours = 1};
  const auto found = all(screen, catalogue, options);
  const auto expected = sampled(catalogue, 3600, 8, options.distance + off);
  std::size_t borderline = 0, matched = 0;
  for (const Nearest& nearest : expected) {
    const auto same = std::find_if(found.begin(), found.end(), [&](const Conjunction& c) {
      return c.a == nearest.a && c.b == nearest.b && c.entry <= nearest.time && nearest.time <= c.exit;
    });
    if (same == found.end() && nearest.distance > options.distance - off) {
      ++borderline;
      continue;
    }
    CAPTURE(nearest.a, nearest.b, nearest.time, nearest.distance);
    REQUIRE(same != found.end());
    ++matched;
    CHECK(std::abs(same->distance - nearest.distance) < off);
    CHECK(distance(catalogue[same->a], catalogue[same->b], same->closest) < nearest.distance + off);
  }
  for (const Conjunction& c : found) {
    CAPTURE(c.a, c.b, c.entry, c.closest, c.distance, c.exit);
    CHECK(c.entry <= c.closest);
    CHECK(c.closest <= c.exit);
    CHECK(std::abs(distance(catalogue[c.a], catalogue[c.b], c.closest) - c.distance) < off);
    if (!c.near_at_start) CHECK(std::abs(distance(catalogue[c.a], catalogue[c.b], c.entry) - options.distance) < off);
    if (!c.near_at_end) CHECK(std::abs(distance(catalogue[c.a], catalogue[c.b], c.exit) - options.distance) < off);
    const bool seen = std::any_of(expected.begin(), expected.end(), [&](const Nearest& nearest) {
      return c.a == nearest.a && c.b == nearest.b && c.entry <= nearest.time && nearest.time <= c.exit;
    });
    CHECK((seen || c.near_at_start || c.near_at_end));  // those may have their minimum outside of the hour
  }
  CHECK(matched > 10);
  CHECK(borderline <= 1);  // one in 1 250 is expected to be within 2 m of 5 km
}

TEST_CASE("conjunctions: world and windows find the same doubles, the sieve the same but for interpolation") {
  const bool dense = GENERATE(false, true);
  const auto catalogue = dense ? dense_shell(300, 3) : made_up_catalogue(1000, 3);
  const Screening options{.distance = 20, .hours = dense ? 0.3 : 1.5};
  const auto by_world = all(screen, catalogue, options);
  const auto by_windows = all(screen_by_windows, catalogue, options);
  const auto by_sieve =
      all([](const auto& of, const auto& how, const auto& tell) { sieve(of, how, 8, tell); }, catalogue, options);
  REQUIRE(by_world.size() > 10);
  REQUIRE(by_windows.size() == by_world.size());
  REQUIRE(by_sieve.size() == by_world.size());
  for (std::size_t i = 0; i < by_world.size(); ++i) {
    const Conjunction &x = by_world[i], &y = by_windows[i], &z = by_sieve[i];
    CAPTURE(i, x.a, x.b, x.entry, x.closest, x.distance, x.exit);
    CHECK((x.a == y.a && x.b == y.b && x.entry == y.entry && x.exit == y.exit));
    CHECK((x.closest == y.closest && x.distance == y.distance));
    CHECK((x.near_at_start == y.near_at_start && x.near_at_end == y.near_at_end));
    CHECK((x.a == z.a && x.b == z.b));
    CHECK(std::abs(x.distance - z.distance) < off);
  }
}

TEST_CASE("conjunctions: quintics are nearer to their orbits than the bound says, and not by much") {
  double farthest = 0;
  for (const Elements& elements : made_up_catalogue(200, 4)) {
    Trajectory trajectory(elements);
    double of_this = 0;
    int k = 0;
    for (int piece = 0; piece < 12; ++piece) {
      const Path path = trajectory.next();
      while (++k, !trajectory.ends_at(k)) {
      }
      for (int i = 0; i <= 20; ++i) {
        const double t = path.start + (k * tick - path.start) * i / 20;
        const Eigen::Vector3d x = path.position(t);
        of_this = std::max(of_this, between({x[0], x[1], x[2]}, place(elements, t)));
      }
    }
    CAPTURE(elements.semi_major_axis, elements.eccentricity);
    CHECK(of_this < interpolation_error);
    farthest = std::max(farthest, of_this);
  }
  CHECK(farthest > interpolation_error / 4);
}

TEST_CASE("conjunctions: objects that are near from the start") {
  const Elements first{7000, 0.001, 1, 2, 3, 0};
  Elements behind = first;  // 3 km behind, for good
  behind.mean_anomaly -= 3 / 7000.0;
  const std::vector<Elements> catalogue{first, behind, first};
  const Screening options{.distance = 5, .hours = 3};
  for (const auto& method : {screen, screen_by_windows}) {
    const auto found = all(method, catalogue, options);
    REQUIRE(found.size() == 3);
    for (const Conjunction& c : found) {
      CHECK((c.entry == 0 && c.near_at_start));
      CHECK((c.exit == 3 * 3600 && c.near_at_end));
      const double least = c.a == 0 && c.b == 2 ? 0 : 3 * (1 - 0.001);  // at apogee the chord is shortest
      CHECK(c.distance == Approx(least).margin(0.01));
    }
  }
}

TEST_CASE("conjunctions: a pair that starts near and parts, and meets again") {
  const double rise = 0.7;
  const Elements first{7000, 0, rise, 0, 0, 0};
  const Elements other{7000, 0, -rise, 0, 0, 0};  // both cross the equator in one point, at 0 and every half turn
  const Screening options{.distance = 5, .hours = 1};
  const double half_turn = pi / std::sqrt(398600.4418 / (7000.0 * 7000 * 7000));
  for (const auto& method : {screen, screen_by_windows}) {
    const auto found = all(method, {first, other}, options);
    REQUIRE(found.size() == 2);
    CHECK((found[0].near_at_start && found[0].entry == 0 && found[0].closest == 0 && found[0].distance < off));
    CHECK_FALSE(found[0].near_at_end);
    CHECK_FALSE(found[1].near_at_start);
    CHECK(found[1].closest == Approx(half_turn).margin(0.001));
    CHECK(found[1].distance < off);
    CHECK(found[1].entry + found[1].exit == Approx(2 * half_turn).margin(0.001));
    // They part at 2 v sin(rise), so it takes this long to be 5 km apart.
    const double time = 5 / (2 * 7000 * pi / half_turn * std::sin(rise));
    CHECK(found[0].exit == Approx(time).margin(0.001));
  }
}

TEST_CASE("conjunctions: what cannot be screened is refused") {
  const auto ignore = [](const Conjunction&) {};
  const std::vector<Elements> some = dense_shell(2, 1);
  CHECK_THROWS_AS(screen(some, {.distance = 0}, ignore), std::invalid_argument);
  CHECK_THROWS_AS(screen_by_windows(some, {.hours = -1}, ignore), std::invalid_argument);
  CHECK_THROWS_AS(Orbit({7000, 1, 0, 0, 0, 0}), std::invalid_argument);
  CHECK_THROWS_AS(screen(std::vector<Elements>{{40000, 0.99, 0, 0, 0, 0}}, {}, ignore), std::invalid_argument);
}

}  // namespace test_conjunctions
