#include "tests/certificates/check_feature_contact.hpp"

#include <catch2/catch.hpp>

#include <limits>
#include <vector>

namespace test_feature_degeneracies {
namespace {

using namespace kds;
using namespace kds::tests;
using Eigen::Vector3d;
using enum FeatureContactStatus;

const Vector3d o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);

/// A query whose answer is known beforehand.
struct Known {
  const char* name;
  Features kind;
  std::array<Vector3d, 4> begin;
  std::array<Vector3d, 4> end;
  bool touches;
  double time;  // of the first touch
};

constexpr auto vf = Features::vertex_face;
constexpr auto ee = Features::edge_edge;

// The face o, x, y; the edge from -x to x, and one across it, from -y to y.
std::vector<Known> known_queries() {
  const Vector3d in(0.25, 0.25, 0);
  std::vector<Known> all;
  const auto vertex = [&](const char* name, const Vector3d& from, const Vector3d& to, bool touches, double time) {
    all.push_back({name, vf, {from, o, x, y}, {to, o, x, y}, touches, time});
  };
  const auto edge = [&](const char* name, const Vector3d& a0, const Vector3d& b0, const Vector3d& a1,
                        const Vector3d& b1, bool touches, double time) {
    all.push_back({name, ee, {a0, b0, -x, x}, {a1, b1, -x, x}, touches, time});
  };
  vertex("through the face", in + z, in - z, true, 0.5);
  vertex("beside the face", x + y + z, x + y - z, false, 0);
  vertex("contact at the end exactly", in + z, in, true, 1);
  vertex("an ulp short of it", in + z, in + z * 0x1p-52, false, 0);
  vertex("contact at the start, leaving", in, in + z, true, 0);
  vertex("on an edge of the face", 0.5 * x + z, 0.5 * x - z, true, 0.5);
  vertex("on a corner of the face", x + z, x - z, true, 0.5);
  vertex("on the slanted edge", 0.5 * (x + y) + z, 0.5 * (x + y) - z, true, 0.5);
  vertex("in the plane, into the face", in - 2 * x, in + 2 * x, true, 1.75 / 4);
  vertex("in the plane, to the slanted edge", x + y, in, true, 2.0 / 3);
  vertex("in the plane, along an edge", 2 * x, -2 * x, true, 0.25);
  vertex("in the plane, past the face", x + 2 * y, 2 * x + y, false, 0);
  vertex("in the plane, grazing the corner", 2 * x - y, y, true, 0.5);
  vertex("at rest on the face", in, in, true, 0);
  vertex("at rest above the face", in + z * 1e-3, in + z * 1e-3, false, 0);
  edge("across, through it", -y + z, y + z, -y - z, y - z, true, 0.5);
  edge("across, contact at the end", -y + z, y + z, -y, y, true, 1);
  edge("across, contact at the start", -y, y, -y + z, y + z, true, 0);
  edge("end on end", x + z, x + y + z, x - z, x + y - z, true, 0.5);
  edge("end on the inside", 0.5 * x + z, 0.5 * x + z + y, 0.5 * x - z, 0.5 * x - z + y, true, 0.5);
  edge("past the end", 1.5 * x - y + z, 1.5 * x + y + z, 1.5 * x - y - z, 1.5 * x + y - z, false, 0);
  edge("parallel, side on", -x + y, x + y, -x - y, x - y, true, 0.5);
  edge("parallel, side on, slanted approach", -3 * x + y, -x + y, -x, x, true, 1);
  edge("parallel, in a line", -5 * x, -4 * x, -2 * x, -x, true, 1);
  edge("parallel, in a line, apart", -5 * x, -4 * x, -3 * x, -2 * x, false, 0);
  edge("parallel, along each other", -9 * x + 1e-3 * y, -8 * x + 1e-3 * y, 8 * x + 1e-3 * y, 9 * x + 1e-3 * y, false,
       0);
  edge("equal edges at rest", -x, x, -x, x, true, 0);
  edge("in one plane, turning into it", 2 * y, 2 * y + x, 2 * y, -x - y, true, 2.0 / 3);
  // A line that turns over a point at a distance of 0: they share it all the time.
  edge("crossing all the time, turning", -y, y, -y + 0.5 * x, y - 0.5 * x, true, 0);
  // Without area or length.
  all.push_back({"a face that is a segment", vf, {z, -x, x, 0.5 * x}, {-z, -x, x, 0.5 * x}, true, 0.5});
  all.push_back({"past a face that is a segment", vf, {z + y, -x, x, 0.5 * x}, {-z + y, -x, x, 0.5 * x}, false, 0});
  all.push_back({"a face that is a point", vf, {z, o, o, o}, {-z, o, o, o}, true, 0.5});
  all.push_back({"a face that shrinks to a point", vf, {z, -x, x, y}, {o, o, o, o}, true, 1});
  all.push_back({"a face that opens from a point", vf, {z, y, y, y}, {o, -x, x, y}, true, 1});
  all.push_back({"an edge that is a point", ee, {z, z, -x, x}, {-z, -z, -x, x}, true, 0.5});
  all.push_back({"two edges that are points", ee, {z, z, o, o}, {-z, -z, o, o}, true, 0.5});
  all.push_back({"points that pass each other", ee, {z + y, z + y, o, o}, {-z + y, -z + y, o, o}, false, 0});
  all.push_back({"an edge that shrinks to a point on the other", ee, {z - y, z + y, -x, x}, {o, o, -x, x}, true, 1});
  all.push_back({"everything in one point", vf, {o, o, o, o}, {o, o, o, o}, true, 0});
  return all;
}

Ends transformed(const Known& query, double scale, const Vector3d& offset) {
  Ends ends{query.begin, query.end};
  for (auto& points : ends) {
    for (auto& p : points) p = p * scale + offset;
  }
  return ends;
}

}  // namespace

TEST_CASE("degenerate features and motions with known answers", "[feature_contact]") {
  for (const auto& query : known_queries()) {
    // Powers of two keep the touches exact; the offset holds every bit of the small numbers that occur.
    for (const double scale : {1.0, 0x1p-20, 0x1p20, 0x1p-300, 0x1p300}) {
      CAPTURE(query.name, scale);
      const Ends ends = transformed(query, scale, Vector3d::Zero());
      const auto truth = ExactFeatures(query.kind, exact_paths(ends)).first_touch(0, 1);
      REQUIRE(truth.has_value() == query.touches);
      if (truth) CHECK(truth->approximate() == Approx(query.time).margin(1e-15));
      CHECK(complaint(query.kind, ends) == "");
      CHECK(complaint(query.kind, ends, {.relative = 1e-9}) == "");
      CHECK(complaint(query.kind, ends, {.relative = 0}) == "");
      const auto r = ask(query.kind, ends);
      if (query.touches) {
        CHECK((r.status == at_start) == (query.time == 0));
        CHECK(r.time == Approx(query.time).margin(1e-5));
      }
    }
  }
}

TEST_CASE("far from the origin differences alone count", "[feature_contact]") {
  for (const auto& query : known_queries()) {
    for (const double scale : {1.0, 0x1p-6, 0x1p10}) {
      CAPTURE(query.name, scale);
      const Vector3d offset(1e8, -2e8, 3e8);
      const Ends ends = transformed(query, scale, offset);
      CHECK(complaint(query.kind, ends) == "");
      bool exact = true;
      for (std::size_t i = 0; i < 2; ++i) {
        for (std::size_t k = 0; k < 4; ++k)
          exact = exact && (ends[i][k] - offset) / scale == (i ? query.end : query.begin)[k];
      }
      // Where the sums are exact the answer is the same, bit for bit.
      if (!exact) continue;
      const auto near = ask(query.kind, transformed(query, scale, Vector3d::Zero()));
      const auto far = ask(query.kind, ends);
      CHECK(near.status == far.status);
      CHECK(near.time == far.time);
      CHECK(near.weights == far.weights);
      CHECK(near.normal == far.normal);
    }
  }
}

TEST_CASE("what an answer says besides the time", "[feature_contact]") {
  const Vector3d p(0.25, 0.5, 0);
  const auto r = ask(vf, Ends{{{p + z, o, x, y}, {p - z, o, x, y}}});
  CHECK(r.status == contact);
  CHECK(r.time <= 0.5);
  CHECK(r.time > 0.5 - 1e-6);
  CHECK(r.latest >= 0.5);
  CHECK(r.latest < 0.5 + 1e-6);
  CHECK(r.weights[0] == 1);
  CHECK(r.weights[1] == Approx(0.25));
  CHECK(r.weights[2] == Approx(0.25));
  CHECK(r.weights[3] == Approx(0.5));
  CHECK((r.normal - z).norm() < 1e-12);
  CHECK(r.tolerance == Approx(3e-6));  // the greatest coordinate: 1 at the start, and 2 on the way
  const auto e = ask(ee, Ends{{{-y + z, y + z, -x, 3 * x}, {-y - z, y - z, -x, 3 * x}}});
  CHECK(e.status == contact);
  CHECK(e.weights[0] == Approx(0.5));
  CHECK(e.weights[1] == Approx(0.5));
  CHECK(e.weights[2] == Approx(0.75));
  CHECK(e.weights[3] == Approx(0.25));
  CHECK((e.normal - z).norm() < 1e-12);
  // From below the normal points down.
  CHECK((ask(vf, Ends{{{p - z, o, x, y}, {p + z, o, x, y}}}).normal + z).norm() < 1e-12);
}

TEST_CASE("a smaller tolerance reports fewer near misses", "[feature_contact]") {
  const Vector3d p = 0.25 * x + 0.25 * y + 0.5 * z + 1e-7 * Vector3d(-1, -1, 1).normalized();
  const Ends near{{{p, o, x + z, y + z}, {p, o, x + z, y + z}}};
  CHECK(ask(vf, near).status == at_start);
  CHECK(ask(vf, near, {.relative = 1e-9}).status == none);
  CHECK(ask(vf, near, {.absolute = 1e-8}).status == none);
  CHECK(ask(vf, near, {.absolute = 2e-7}).status == at_start);
  CHECK(ask(vf, near, {.relative = 0}).tolerance == Approx(0.75 * 0x1p-38).margin(0));
}

TEST_CASE("parabolas that graze", "[feature_contact]") {
  // The vertex comes down to height h at t = 1 and goes up again.
  const auto dive = [](double h) {
    std::array<PointMotion<2>, 4> points;
    points[0] = {{Vector3d(0.25, 0.25, 1 + h), Vector3d(0, 0, -2), Vector3d(0, 0, 1)}, 0};
    points[1] = {{o, o, o}, 0};
    points[2] = {{x, o, o}, 0};
    points[3] = {{y, o, o}, 0};
    return points;
  };
  CHECK(ask(vf, dive(0), 0, 2).status == undecided);
  CHECK(ask(vf, dive(0), 0, 2).time == Approx(1).margin(2e-3));  // sqrt of the tolerance: the height is a square
  CHECK(ask(vf, dive(0x1p-20), 0, 2, {.relative = 1e-8}).status == none);
  CHECK(ask(vf, dive(-0x1p-20), 0, 2).status != none);
  CHECK(ask(vf, dive(-0x1p-8), 0, 2).status == contact);
  for (const double h : {0.0, 0x1p-40, -0x1p-40, 0x1p-20, -0x1p-20, 0x1p-10, -0x1p-10}) {
    for (const double end : {0.5, 1.0, 2.0}) {
      for (const double relative : {1e-6, 1e-9, 0.0}) {
        CAPTURE(h, end, relative);
        CHECK(complaint(vf, dive(h), 0, end, {.relative = relative}) == "");
      }
    }
  }
  // A common gravity, and a common start far away in time, change nothing.
  auto falling = dive(0);
  for (auto& p : falling) {
    p.coefficients[2] += Vector3d(0, 0, -4);
    p.start = 0x1p30;
  }
  CHECK(ask(vf, falling, 0x1p30, 0x1p30 + 2).status == undecided);
  CHECK(complaint(vf, falling, 0x1p30, 0x1p30 + 2) == "");
}

TEST_CASE("a vertex that hovers over a turning face takes few steps", "[feature_contact]") {
  // The face turns about its foot by half a turn of its corners' chords, at a height far below its size.
  for (const double height : {1e-2, 1e-4, 1e-5}) {
    const Ends turn{{{Vector3d(0.3, 0.3, height), o, x, y}, {Vector3d(0.3, 0.3, height), o + 0.3 * x, x + y, y - x}}};
    const auto r = ask(vf, turn);
    CAPTURE(height);
    CHECK(r.status == none);
    CHECK(r.steps <= 4);
  }
  const Ends tilt{
      {{Vector3d(0.3, 0.3, 1e-5), o, x, y}, {Vector3d(0.3, 0.3, 1e-5), -z, x + z * 1.3333, y + z * 0.9999}}};
  CHECK(complaint(vf, tilt) == "");
  CHECK(ask(vf, tilt).steps < 16);
}

TEST_CASE("an interval that is an instant, and numbers that are none", "[feature_contact]") {
  const auto still = [](double height) {
    return std::array<PointMotion<1>, 4>{PointMotion<1>{{Vector3d(0.25, 0.25, height), -z}, 0},
                                         PointMotion<1>{{o, o}, 0}, PointMotion<1>{{x, o}, 0},
                                         PointMotion<1>{{y, o}, 0}};
  };
  CHECK(ask(vf, still(1), 1, 1).status == at_start);
  CHECK(ask(vf, still(1), 0.5, 0.5).status == none);
  CHECK(ask(vf, still(1), 0.5, 1).status != none);
  CHECK_THROWS_AS(ask(vf, still(std::numeric_limits<double>::quiet_NaN()), 0, 1), std::invalid_argument);
  CHECK_THROWS_AS(ask(vf, still(std::numeric_limits<double>::infinity()), 0, 1), std::invalid_argument);
  CHECK_THROWS_AS(ask(vf, still(1), 0, std::numeric_limits<double>::infinity()), std::invalid_argument);
}

}  // namespace test_feature_degeneracies
