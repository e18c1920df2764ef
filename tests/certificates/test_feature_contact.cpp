#include "certificates/features/feature_contact.hpp"
#include "tests/certificates/check_certificate.hpp"
#include "tests/certificates/exact_features.hpp"
#include "tests/certificates/feature_queries.hpp"

#include <catch2/catch.hpp>

#include <map>
#include <string>

namespace {

using namespace kds;
using namespace kds::tests;
using certificates::ContactTolerance;
using certificates::FeatureContact;
using certificates::FeatureContactStatus;
using certificates::PointMotion;
using Eigen::Vector3d;

using Ends = std::array<std::array<Vector3d, 4>, 2>;

std::array<Path, 4> exact_paths(const Ends& ends) {
  std::array<Path, 4> paths;
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t d = 0; d < 3; ++d) {
      const auto begin = oracle::rational(ends[0][k][static_cast<int>(d)]);
      const auto end = oracle::rational(ends[1][k][static_cast<int>(d)]);
      paths[k][d] = oracle::Polynomial({begin, end - begin});
    }
  }
  return paths;
}

template <int Degree>
std::array<Path, 4> exact_paths(const std::array<PointMotion<Degree>, 4>& points) {
  return {exact(points[0]), exact(points[1]), exact(points[2]), exact(points[3])};
}

FeatureContact ask(Features kind, const Ends& ends, const ContactTolerance& tolerance = {}) {
  return kind == Features::vertex_face ? certificates::vertex_face_contact(ends[0], ends[1], tolerance)
                                       : certificates::edge_edge_contact(ends[0], ends[1], tolerance);
}

template <int Degree>
FeatureContact ask(Features kind, const std::array<PointMotion<Degree>, 4>& p, double t0, double t1,
                   const ContactTolerance& tolerance = {}) {
  return kind == Features::vertex_face
             ? certificates::vertex_face_contact(p[0], p[1], p[2], p[3], t0, t1, tolerance)
             : certificates::edge_edge_contact(p[0], p[1], p[2], p[3], t0, t1, tolerance);
}

/// The size by which tolerances are measured, from the numbers as they are.
double size_of(Features kind, const std::array<Path, 4>& paths, double t0, double t1) {
  double size = 0;
  const std::size_t firsts = kind == Features::vertex_face ? 1 : 2;
  for (std::size_t i = 0; i < firsts; ++i) {
    for (std::size_t j = firsts; j < 4; ++j) {
      for (std::size_t d = 0; d < 3; ++d) {
        const auto q = paths[i][d] - paths[j][d];
        // About t0, in units of the duration.
        oracle::Rational sum = 0;
        oracle::Polynomial derivative = q;
        oracle::Rational factor = 1;
        for (int n = 0; n <= q.degree(); ++n) {
          sum += abs(derivative(oracle::rational(t0)) * factor);
          derivative = derivative.derivative();
          factor *= (oracle::rational(t1) - oracle::rational(t0)) / oracle::Rational(n + 1);
        }
        size = std::max(size, approximate(sum));
      }
    }
  }
  return size;
}

/// Every law of FeatureContact, against exact numbers: what is wrong, or nothing.
std::string complaint(Features kind, const FeatureContact& r, const std::array<Path, 4>& paths, double t0, double t1,
                      const ContactTolerance& tolerance, const std::optional<oracle::Instant>& truth) {
  if (!r) return truth ? "missed" : "";
  const auto now = oracle::rational(r.time);
  if (!(r.time >= t0 && r.time <= t1)) return "time outside the interval";
  if (truth && truth->compare(now) < 0) return "late";
  if (r.status == FeatureContactStatus::at_start && r.time != t0) return "at start, but later";
  if (r.status == FeatureContactStatus::contact) {
    if (!truth) return "a contact that is none";
    if (truth->compare(oracle::rational(r.latest)) > 0) return "the latest time is too early";
    if (!(r.latest >= r.time && r.latest <= t1)) return "latest time outside the interval";
  }
  // The distance at the time reported. Two ulps of the clock are allowed for.
  const auto p = places(paths, now);
  const auto distance = squared_distance(kind, p);
  const double size = size_of(kind, paths, t0, t1);
  const double allowed = std::max(std::min(tolerance.absolute, tolerance.relative * size), 0x1p-38 * size);
  const double clock = t1 > t0 ? 8 * size * 0x1p-50 * (std::abs(r.time) + t1 - t0) / (t1 - t0) : 0;
  if (distance > oracle::square(oracle::rational(r.distance))) return "farther apart than it says";
  if (!(r.distance <= allowed * (1 + 1e-12) + clock)) return "farther apart than the tolerance";
  if (!(std::abs(r.tolerance - allowed) <= 1e-12 * allowed)) return "another tolerance";
  // The points named are that close, up to the rounding of their weights.
  const auto& w = r.weights;
  const std::size_t firsts = kind == Features::vertex_face ? 1 : 2;
  Place difference{};
  for (std::size_t d = 0; d < 3; ++d) {
    for (std::size_t k = 0; k < 4; ++k) {
      const auto term = oracle::rational(w[k]) * (p[k][d] - p[3][d]);
      difference[d] = k < firsts ? difference[d] + term : difference[d] - term;
    }
  }
  double sum = 0;
  for (std::size_t k = firsts; k < 4; ++k) sum += w[k];
  if (*std::min_element(w.begin(), w.end()) < 0 || std::abs(sum - 1) > 1e-15 * 4) return "weights";
  if (kind == Features::edge_edge && std::abs(w[0] + w[1] - 1) > 1e-15 * 4) return "weights of the first edge";
  if (approximate(squared_length(difference)) > std::pow(r.distance + 1e-14 * size, 2)) return "the points named are apart";
  if (!(std::abs(r.normal.norm() - 1) < 1e-12)) return "normal";
  return "";
}

struct Tally {
  std::map<std::string, int> complaints;
  std::map<std::string, int> at;
  int queries = 0, touching = 0, certified = 0, reported = 0, most_steps = 0;

  void add(const std::string& what, const FeatureContact& r, bool touches, const std::string& where) {
    ++queries;
    touching += touches;
    reported += bool(r);
    certified += r.status == FeatureContactStatus::contact;
    most_steps = std::max(most_steps, r.steps);
    if (!what.empty()) {
      ++complaints[what];
      ++at[what + " " + where];
    }
  }
  std::string text() const {
    std::string result = std::to_string(queries) + " queries, " + std::to_string(touching) + " touch, " +
                         std::to_string(reported) + " reported, " + std::to_string(certified) + " certified, at most " +
                         std::to_string(most_steps) + " steps;";
    for (const auto& [what, n] : at) result += " " + what + ": " + std::to_string(n);
    return result;
  }
};

}  // namespace

TEST_CASE("features on straight steps: nothing missed, nothing late, no alarm beyond the tolerance",
          "[feature_contact]") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  CAPTURE(seed);
  Tally tally;
  for (const double scale : {1.0, 1e-6, 1e-3, 1e3, 1e6}) {
    for (const double offset : {0.0, 1e8}) {
      FeatureQueries queries(seed, 0, scale, offset);
      for (int i = 0; i < 2 * encounters; ++i) {
        for (const auto kind : {Features::vertex_face, Features::edge_edge}) {
          const auto encounter = static_cast<Encounter>(i % encounters);
          const Ends e = ends(queries(encounter, kind));
          const auto paths = exact_paths(e);
          const auto truth = ExactFeatures(kind, paths).first_touch(0, 1);
          for (const ContactTolerance tolerance : {ContactTolerance{}, ContactTolerance{.absolute = 1e-9 * scale}}) {
            const auto r = ask(kind, e, tolerance);
            tally.add(complaint(kind, r, paths, 0, 1, tolerance, truth), r, truth.has_value(),
                      std::string(name(encounter)) + (kind == Features::vertex_face ? " vf" : " ee"));
          }
        }
      }
    }
  }
  INFO(tally.text());
  if (std::getenv("SHOW")) WARN(tally.text());
  CHECK(tally.complaints.empty());
  CHECK(tally.touching > tally.queries / 4);
  CHECK(tally.touching < tally.queries * 3 / 4);
  CHECK(tally.certified > tally.queries / 10);
  CHECK(tally.most_steps < 64);
}

TEMPLATE_TEST_CASE_SIG("features on polynomial paths, at any time and from any start", "[feature_contact]",
                       ((int Degree), Degree), 1, 2) {
  const std::uint64_t seed = 11;
  CAPTURE(Degree, seed);
  Tally tally;
  Random random(seed);
  for (const double scale : {1.0, 1e-6, 1e6}) {
    for (const double offset : {0.0, 1e8}) {
      FeatureQueries queries(seed, Degree == 2 ? 1 : 0, scale, offset);
      for (int i = 0; i < 3 * encounters; ++i) {
        for (const auto kind : {Features::vertex_face, Features::edge_edge}) {
          const auto encounter = static_cast<Encounter>(i % encounters);
          const auto query = queries(encounter, kind);
          const int form = random.integer(0, 2);
          const double t0 = form == 0 ? 0 : random.between(-0.25, 0.25);
          const double t1 = form == 0 ? 1 : random.between(0.75, 1.25);
          std::array<PointMotion<Degree>, 4> points;
          for (std::size_t k = 0; k < 4; ++k) {
            for (std::size_t j = 0; j <= Degree; ++j) points[k].coefficients[j] = query.c[k][j];
            if (form == 2 && random.one_in(2)) points[k] = points[k].restarted(random.between(-1, 1));
          }
          const auto paths = exact_paths(points);
          const auto truth = ExactFeatures(kind, paths).first_touch(t0, t1);
          const auto r = ask(kind, points, t0, t1);
          tally.add(complaint(kind, r, paths, t0, t1, {}, truth), r, truth.has_value(),
                    std::string(name(encounter)) + (kind == Features::vertex_face ? " vf" : " ee"));
        }
      }
    }
  }
  INFO(tally.text());
  if (std::getenv("SHOW")) WARN(tally.text());
  CHECK(tally.complaints.empty());
  CHECK(tally.touching > tally.queries / 8);
  CHECK(tally.most_steps < 64);
}
