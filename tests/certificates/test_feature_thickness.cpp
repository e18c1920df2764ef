#include "tests/certificates/check_feature_contact.hpp"
#include "tests/certificates/feature_queries.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace test_feature_thickness {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::ControlPoints;

/// The paths that control points mean, exactly.
template <int Degree>
std::array<Path, 4> exact_paths(const ControlPoints<Degree>& control, double t0, double t1) {
  const oracle::Polynomial s({-oracle::rational(t0) / (oracle::rational(t1) - oracle::rational(t0)),
                              oracle::Rational(1) / (oracle::rational(t1) - oracle::rational(t0))});
  const oracle::Polynomial r = oracle::Polynomial(oracle::Rational(1)) - s;
  std::array<Path, 4> paths;
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t d = 0; d < 3; ++d) {
      const auto b = [&](std::size_t i) {
        return oracle::Polynomial(oracle::rational(control[i][k][static_cast<int>(d)]));
      };
      if constexpr (Degree == 1) {
        paths[k][d] = b(0) * r + b(1) * s;
      } else {
        paths[k][d] = b(0) * r * r + b(1) * r * s * oracle::Polynomial(oracle::Rational(2)) + b(2) * s * s;
      }
    }
  }
  return paths;
}

/// The first time at which two features are no farther apart than the thickness, by exhaustion: between the times at
/// which the distance of a vertex, a line or a plane is the thickness, the features stay on one side of it.
std::optional<oracle::Instant> first_touch(Features kind, const std::array<Path, 4>& p, double thickness, double t0,
                                           double t1) {
  const oracle::Rational begin = oracle::rational(t0);
  const oracle::Rational end = oracle::rational(t1);
  const oracle::Rational square = oracle::square(oracle::rational(thickness));
  const auto near = [&](const oracle::Rational& t) { return squared_distance(kind, places(p, t)) <= square; };
  if (near(begin)) return oracle::Instant(begin);
  std::vector<oracle::Instant> times;
  const auto add = [&](const oracle::Polynomial& g) {
    if (g.degree() < 1) return;
    for (const auto& r : oracle::roots(g, begin, end)) times.push_back(r);
  };
  const oracle::Polynomial level(square);
  const auto point = [&](const Path& a, const Path& b) {
    const Path ab = minus(b, a);
    add(dot(ab, ab) - level);
  };
  const auto line = [&](const Path& a, const Path& b, const Path& c) {
    const Path bc = minus(c, b);
    const Path x = cross(bc, minus(a, b));
    add(dot(x, x) - level * dot(bc, bc));
  };
  const bool face = kind == Features::vertex_face;
  for (std::size_t i = 0; i < (face ? 1U : 2U); ++i) {
    for (std::size_t j = face ? 1 : 2; j < 4; ++j) {
      point(p[i], p[j]);
      line(p[i], p[j], p[face ? j % 3 + 1 : 5 - j]);
    }
  }
  if (!face) line(p[2], p[0], p[1]), line(p[3], p[0], p[1]);
  const Path n = face ? cross(minus(p[2], p[1]), minus(p[3], p[1])) : cross(minus(p[1], p[0]), minus(p[3], p[2]));
  const auto volume = dot(n, minus(p[0], p[face ? 1 : 2]));
  add(volume * volume - level * dot(n, n));
  std::sort(times.begin(), times.end());
  for (std::size_t i = 0; i < times.size(); ++i) {
    oracle::Rational next = end;
    if (i + 1 < times.size()) {
      if (times[i].compare(times[i + 1]) == 0) continue;
      while (!times[i].is_rational() && times[i].high() > times[i + 1].low()) times[i].halve(), times[i + 1].halve();
      next = times[i + 1].low();
    }
    if (near((times[i].high() + next) / 2)) return times[i];
  }
  return std::nullopt;
}

struct Tally {
  std::map<std::string, int> complaints;
  int queries = 0, touching = 0, reported = 0, most_steps = 0, steps = 0;
};

template <int Degree>
void check(Features kind, const ControlPoints<Degree>& control, const ContactTolerance& tolerance, double t0, double t1,
           double from, const std::string& where, Tally& tally) {
  const auto paths = exact_paths<Degree>(control, t0, t1);
  const auto truth = first_touch(kind, paths, tolerance.thickness, from, t1);
  const FeatureContact r = kind == Features::vertex_face
                               ? certificates::vertex_face_contact<Degree>(control, t0, t1, from, tolerance)
                               : certificates::edge_edge_contact<Degree>(control, t0, t1, from, tolerance);
  ++tally.queries;
  tally.touching += truth.has_value();
  tally.reported += bool(r);
  tally.most_steps = std::max(tally.most_steps, r.steps);
  tally.steps += r.steps;
  const auto complain = [&](const char* what) { ++tally.complaints[std::string(what) + ": " + where]; };
  if (!r) {
    if (truth) complain("missed");
    return;
  }
  if (!(r.time >= from && r.time <= t1)) return complain("outside the interval");
  if (truth && truth->compare(oracle::rational(r.time)) < 0) complain("late");
  const auto distance = squared_distance(kind, places(paths, oracle::rational(r.time)));
  if (distance > oracle::square(oracle::rational(r.distance))) complain("farther apart than it says");
  const double clock = 0x1p-46 * size_of(kind, paths, t0, t1) * (1 + std::abs(t0) / (t1 - t0));
  if (!(r.distance <= tolerance.thickness + r.tolerance + clock)) complain("farther apart than the tolerance");
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("features with a thickness: nothing missed, nothing late, no alarm beyond the tolerance",
                       "[feature_contact]", ((int Degree), Degree), 1, 2) {
  const std::uint64_t seed = GENERATE(1, 2);
  CAPTURE(Degree, seed);
  Tally tally;
  Random random(seed + 100);
  for (const double scale : {1.0, 1e6}) {
    FeatureQueries queries(seed, Degree == 2 ? 1 : 0, scale, scale > 1 ? 1e8 : 0);
    for (int i = 0; i < (Degree == 1 ? 5 : 2) * encounters; ++i) {
      for (const auto kind : {Features::vertex_face, Features::edge_edge}) {
        const auto encounter = static_cast<Encounter>(i % encounters);
        const auto query = queries(encounter, kind);
        ControlPoints<Degree> control;
        for (std::size_t k = 0; k < 4; ++k) {
          const auto& c = query.c[k];
          control[0][k] = c[0];
          control[Degree][k] = c[0] + c[1] + c[2];
          if constexpr (Degree == 2) control[1][k] = c[0] + 0.5 * c[1];
        }
        const double t0 = random.one_in(2) ? 0 : 0.125;
        const double t1 = random.one_in(2) ? 1 : 1.5;
        const ContactTolerance tolerance{.thickness = std::pow(10, random.between(-6, 0)) * scale};
        const double from = random.one_in(3) ? random.between(t0, t1) : t0;
        check<Degree>(kind, control, tolerance, t0, t1, from, name(encounter), tally);
      }
    }
  }
  CAPTURE(tally.queries, tally.touching, tally.reported, tally.most_steps, tally.steps, tally.complaints);
  CHECK(tally.complaints.empty());
  CHECK(tally.touching > tally.queries / 4);
  CHECK(tally.touching < tally.queries * 9 / 10);
  CHECK(tally.most_steps < 64);
}

TEMPLATE_TEST_CASE_SIG("features by control points: the same without a thickness", "[feature_contact]",
                       ((int Degree), Degree), 1, 2) {
  const std::uint64_t seed = 5;
  CAPTURE(Degree, seed);
  std::map<std::string, int> complaints;
  FeatureQueries queries(seed, Degree == 2 ? 1 : 0, 1, 0);
  int touching = 0;
  for (int i = 0; i < 4 * encounters; ++i) {
    for (const auto kind : {Features::vertex_face, Features::edge_edge}) {
      const auto query = queries(static_cast<Encounter>(i % encounters), kind);
      ControlPoints<Degree> control;
      for (std::size_t k = 0; k < 4; ++k) {
        control[0][k] = query.c[k][0];
        control[Degree][k] = query.c[k][0] + query.c[k][1] + query.c[k][2];
        if constexpr (Degree == 2) control[1][k] = query.c[k][0] + 0.5 * query.c[k][1];
      }
      const double t0 = 3;
      const double t1 = 3.75;
      const auto paths = exact_paths<Degree>(control, t0, t1);
      const auto truth = ExactFeatures(kind, paths).first_touch(t0, t1);
      const FeatureContact r = kind == Features::vertex_face
                                   ? certificates::vertex_face_contact<Degree>(control, t0, t1, t0)
                                   : certificates::edge_edge_contact<Degree>(control, t0, t1, t0);
      touching += truth.has_value();
      const std::string what = complaint(kind, r, paths, t0, t1, {}, truth);
      if (!what.empty()) ++complaints[what];
    }
  }
  CAPTURE(complaints);
  CHECK(complaints.empty());
  CHECK(touching > encounters);
}

TEST_CASE("a ball that rolls over an edge, and a thickness that is none", "[feature_contact]") {
  // A ball of radius 1/2 around the vertex meets the plane z = 0 at s = 3/4.
  const std::array<Eigen::Vector3d, 4> begin{{{0.25, 0.25, 2}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  const std::array<Eigen::Vector3d, 4> end{{{0.25, 0.25, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  const auto r = certificates::vertex_face_contact(begin, end, {.thickness = 0.5});
  CHECK(r.status == FeatureContactStatus::undecided);
  CHECK(r.time == Approx(0.75).margin(2e-6));
  CHECK(r.time <= 0.75);
  CHECK(r.normal.isApprox(Eigen::Vector3d::UnitZ()));
  for (const double bad : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    CHECK_THROWS_AS(certificates::vertex_face_contact(begin, end, {.thickness = bad}), std::invalid_argument);
  }
  // The faces of cloth of a thickness that holds everything: at the start.
  CHECK(certificates::edge_edge_contact(begin, end, {.thickness = 1e300}).status == FeatureContactStatus::at_start);
}

}  // namespace test_feature_thickness
