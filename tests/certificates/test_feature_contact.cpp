#include "tests/certificates/check_feature_contact.hpp"
#include "tests/certificates/feature_queries.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>

namespace test_feature_contact {
namespace {

using namespace kds;
using namespace kds::tests;

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
  CHECK(tally.complaints.empty());
  CHECK(tally.touching > tally.queries / 4);
  CHECK(tally.touching < tally.queries * 3 / 4);
  CHECK(tally.certified > tally.queries / 20);
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
  CHECK(tally.complaints.empty());
  CHECK(tally.touching > tally.queries / 8);
  CHECK(tally.most_steps < 64);
}

TEMPLATE_TEST_CASE_SIG(
    "features so small that there are no normal numbers of their size are not missed, nor found late", "[features]",
    ((int Degree), Degree), 1, 2) {
  const std::uint64_t seed = 770;
  CAPTURE(seed);
  Random random(seed);
  int missed = 0, late = 0, false_alarms = 0, found = 0;
  for (const int power : {-1020, -1040, -1060, -1070, -1074}) {
    for (int round = 0; round < 100; ++round) {
      std::array<PointMotion<Degree>, 4> points;
      const double end = random.between(0.5, 1.5);  // so that coefficients are rounded
      for (auto& point : points) {
        for (auto& c : point.coefficients) {
          for (int d = 0; d < 3; ++d) c[d] = std::ldexp(random.integer(-64, 64), power);
        }
      }
      for (const Features kind : {Features::vertex_face, Features::edge_edge}) {
        const FeatureContact answer = ask(kind, points, 0, end);
        const auto truth = ExactFeatures(kind, exact_paths(points)).first_touch(0, end);
        missed += truth && !answer;
        late += truth && answer && truth->compare(oracle::rational(answer.time)) < 0;
        false_alarms += !truth && answer.status == FeatureContactStatus::contact;
        found += answer.status == FeatureContactStatus::contact;
      }
    }
  }
  CHECK(missed == 0);
  CHECK(late == 0);
  CHECK(false_alarms == 0);
  CHECK(found > 15);
}

}  // namespace test_feature_contact
