// Capsules whose contacts are known numbers, and the places where their pieces meet.
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/pair_tests.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

namespace test_capsule_exact {
namespace {

using namespace kds;
using namespace kds::collision;
using certificates::PointMotion;
using Eigen::Quaterniond;
using Eigen::Vector3d;

const Quaterniond upright = Quaterniond::Identity();
const Quaterniond along_x(0.5, 0.5, 0.5, 0.5);  // turns z to x
const double quarter = std::sqrt(0.5);

PlacedShape capsule(double radius, double half_length, const Quaterniond& turned = upright) {
  return place(Capsule{radius, half_length}, turned);
}
PlacedShape box(double x, double y, double z) { return place(Box{{x, y, z}}, upright); }

/// b flies at a, which stands at the origin.
struct Flight {
  PlacedShape a, b;
  Vector3d from, velocity;
  Vector3d half_acceleration = Vector3d::Zero();

  template <class Ask>
  auto ask(const Ask& question) const {
    const PointMotion<2> still{{Vector3d::Zero()}, 0};
    const PointMotion<2> path{{from, velocity, half_acceleration}, 0};
    return question(TranslatingShape<2>{a, still}, TranslatingShape<2>{b, path});
  }
  /// The same whichever is named first.
  double contact(ContactMode mode = ContactMode::transparent, double t0 = 0, double horizon = 100) const {
    return ask([&](const auto& x, const auto& y) {
      const double t = first_contact(x, y, t0, horizon, mode);
      CHECK(first_contact(y, x, t0, horizon, mode) == t);
      return t;
    });
  }
  double separation(double t) const {
    return ask([&](const auto& x, const auto& y) { return first_separation(x, y, t, 100.0); });
  }
  bool touches(double t) const {
    return ask([&](const auto& x, const auto& y) { return in_contact(x, y, t); });
  }
  Contact where(double t) const {
    return ask([&](const auto& x, const auto& y) { return contact_at(x, y, t); });
  }
};

void check_place(const Flight& flight, double t, const Vector3d& point, const Vector3d& normal, const char* feature_a,
                 const char* feature_b) {
  const Contact contact = flight.where(t);
  INFO(contact.point.transpose() << "; " << contact.normal.transpose());
  CHECK((contact.point - point).norm() < 1e-14);
  CHECK((contact.normal - normal).norm() < 1e-14);
  CHECK(to_string(contact.feature_a) == feature_a);
  CHECK(to_string(contact.feature_b) == feature_b);
}

}  // namespace

TEST_CASE("capsule: a ball meets its side, its end and its shoulder at the very double", "[capsule]") {
  const Flight side{capsule(1, 2), placed_ball(0.5), {5, 0, 1}, {-1, 0, 0}};
  CHECK(side.contact() == 3.5);
  CHECK(side.separation(3.5) == 6.5);
  check_place(side, 3.5, {1, 0, 1}, {1, 0, 0}, "e0-1", "-");
  const Flight end{capsule(1, 2), placed_ball(0.5), {0, 0, 8}, {0, 0, -2}};
  CHECK(end.contact() == 2.25);
  check_place(end, 2.25, {0, 0, 3}, {0, 0, 1}, "v1", "-");
  // At the height of the end of the segment: where cylinder and half ball join, and neither holds the path alone.
  const Flight shoulder{capsule(1, 2), placed_ball(0.5), {5, 0, 2}, {-1, 0, 0}};
  CHECK(shoulder.contact() == 3.5);
  CHECK(shoulder.separation(3.5) == 6.5);
  // A 3-4-5 triangle beyond it: (4 - 1.2) / 2.
  const Flight round{capsule(1, 2), placed_ball(0.5), {4, 0, 2.9}, {-2, 0, 0}};
  CHECK(round.contact() == Approx(1.4).epsilon(1e-15));
  check_place(round, 1.4, {0.8, 0, 2.6}, {0.8, 0, 0.6}, "v1", "-");
}

TEST_CASE("capsule: what only grazes does not touch", "[capsule]") {
  const double in = std::nextafter(1.5, 0.0);
  for (const double along : {0.0, 1.0, 2.0}) {  // side, and where the end begins
    INFO(along);
    CHECK(Flight{capsule(1, 2), placed_ball(0.5), {5, 1.5, along}, {-1, 0, 0}}.contact() == never);
    const Flight nearer{capsule(1, 2), placed_ball(0.5), {5, in, along}, {-1, 0, 0}};
    const double t = nearer.contact();
    CHECK(t < 5);
    CHECK(t > 5 - 1e-7);
    CHECK(nearer.touches(t));
    CHECK_FALSE(nearer.touches(std::nextafter(t, 0.0)));
    CHECK(nearer.separation(t) > 5);
  }
  // Past the end, and along the whole side.
  CHECK(Flight{capsule(1, 2), placed_ball(0.5), {5, 0, 3.5}, {-1, 0, 0}}.contact() == never);
  CHECK(Flight{capsule(1, 2), placed_ball(0.5), {0, 1.5, 9}, {0, 0, -1}}.contact() == never);
  CHECK(Flight{capsule(1, 2), placed_ball(0.5), {0, in, 9}, {0, 0, -1}}.contact() < 7);
  // A parabola that touches at its top, and one that goes a rounding higher.
  CHECK(Flight{capsule(1, 2), placed_ball(0.5), {2.5, 0, 0}, {-2, 0, 0}, {1, 0, 0}}.contact() == never);
  CHECK(Flight{capsule(1, 2), placed_ball(0.5), {2.5 - 0x1p-50, 0, 0}, {-2, 0, 0}, {1, 0, 0}}.contact() < 1);
}

TEST_CASE("capsule: two of them, crossing, parallel and end to end", "[capsule]") {
  const Flight crossing{capsule(1, 2), capsule(0.5, 3, along_x), {1, 6, 0.25}, {0, -1, 0}};
  CHECK(crossing.contact() == 4.5);
  check_place(crossing, 4.5, {0, 1, 0.25}, {0, 1, 0}, "e0-1", "e0-1");
  CHECK(crossing.separation(4.5) == 7.5);
  // Crossing where both end: the corner of the parallelogram.
  const Flight corners{capsule(1, 2), capsule(0.5, 3, along_x), {3, 6, 2}, {0, -1, 0}};
  CHECK(corners.contact() == 4.5);
  CHECK(corners.separation(4.5) == 7.5);

  const Flight parallel{capsule(1, 2), capsule(0.5, 3), {6, 0, 4}, {-1, 0, 0}};
  CHECK(parallel.contact() == 4.5);
  check_place(parallel, 4.5, {1, 0, 1.5}, {1, 0, 0}, "e0-1", "e0-1");  // in the middle of what they share
  const Flight at_ends{capsule(1, 2), capsule(0.5, 3), {6, 0, 5}, {-1, 0, 0}};
  CHECK(at_ends.contact() == 4.5);
  const Flight head_on{capsule(1, 2), capsule(0.5, 3), {0, 0, 10.5}, {0, 0, -1}};
  CHECK(head_on.contact() == 4);
  check_place(head_on, 4, {0, 0, 3}, {0, 0, 1}, "v1", "v0");
  CHECK(head_on.separation(4) == 17);
  // Side by side, sliding along each other: a touch, and a rounding nearer a contact.
  CHECK(Flight{capsule(1, 2), capsule(0.5, 3), {1.5, 0, 20}, {0, 0, -1}}.contact() == never);
  CHECK(Flight{capsule(1, 2), capsule(0.5, 3), {std::nextafter(1.5, 0.0), 0, 20}, {0, 0, -1}}.contact() < 15);
  // Of one length: the ends of the sum coincide in its middle.
  const Flight equal{capsule(1, 2), capsule(0.5, 2), {6, 0, 0}, {-1, 0, 0}};
  CHECK(equal.contact() == 4.5);
  CHECK(equal.separation(4.5) == 7.5);
}

TEST_CASE("capsule: two that are turned alike, and two that are parallel but for a rounding", "[capsule]") {
  const Quaterniond turned = Quaterniond(0.3, -0.5, 0.7, 0.2).normalized();
  const PlacedShape a = capsule(1, 2, turned);
  const Vector3d axis = a.rotation.col(2);
  const Vector3d across = a.rotation.col(0);
  const Flight flight{a, capsule(0.5, 3, turned), 6 * across + axis, -across};
  const double t = flight.contact();
  CHECK(t == Approx(4.5).epsilon(1e-14));
  CHECK(flight.touches(t));
  CHECK_FALSE(flight.touches(std::nextafter(t, 0.0)));
  CHECK((flight.where(t).normal - across).norm() < 1e-14);
  CHECK(to_string(flight.where(t).feature_b) == "e0-1");
  for (const double tilt : {0x1p-53, 0x1p-52, 0x1p-50, 0x1p-47, 0x1p-40, 0x1p-30, 0x1p-20, 0x1p-10}) {
    INFO(tilt);
    const Quaterniond nearly = (turned * Quaterniond(1, tilt, tilt, tilt)).normalized();
    const Flight tilted{a, capsule(0.5, 3, nearly), 6 * across + axis, -across};
    const double begin = tilted.contact();
    CHECK(begin == Approx(4.5).margin(1e-14 + 16 * tilt));
    CHECK(tilted.touches(begin));
    CHECK_FALSE(tilted.touches(std::nextafter(begin, 0.0)));
    CHECK((tilted.where(begin).normal - across).norm() < 1e-13 + 16 * tilt);
    const double end = tilted.separation(begin);
    CHECK(end == Approx(7.5).margin(1e-14 + 16 * tilt));
    CHECK_FALSE(tilted.touches(end));
    CHECK(tilted.touches(std::nextafter(end, 0.0)));
  }
}

TEST_CASE("capsule: what is beside a tilted one is not above it", "[capsule]") {
  // Tilted in a plane, they meet across it: along a normal in that plane, what is beside the line of the capsule, or
  // the plane of two that are parallel but for a rounding, is above it by a rounding at most, or below.
  int pairs = 0;
  for (int plane = 0; plane < 3; ++plane) {
    const Vector3d across = Vector3d::Unit(plane);
    for (int k = 0; k < 100; ++k) {
      CAPTURE(plane, k);
      const Quaterniond turned(Eigen::AngleAxisd(0.03125 * k, across));
      const PlacedShape a = capsule(0.25, 0.5, turned);
      if (std::abs(a.rotation.col(2).dot(across)) > 0.5) continue;  // along the z axis that turns nothing
      Eigen::Matrix3d rounded = a.rotation;
      rounded(2, 2) = std::nextafter(rounded(2, 2), 2);
      for (const PlacedShape& b : {a, place_turned(Capsule{0.25, 0.5}, rounded), placed_ball(0.25)}) {
        const Flight flight{a, b, across, -across};
        const double t = flight.contact(ContactMode::resolved);
        CHECK(std::abs(t - 0.5) < 1e-15);
        CHECK((flight.where(t).normal - across).norm() < 1e-14);
        ++pairs;
      }
    }
  }
  CHECK(pairs == 600);
}

TEST_CASE("capsule: against a face, an edge and a corner of a box", "[capsule]") {
  const Flight tip{box(2, 2, 1), capsule(0.5, 1), {0.25, 0.5, 6}, {0, 0, -1}};
  CHECK(tip.contact() == 3.5);
  check_place(tip, 3.5, {0.25, 0.5, 1}, {0, 0, 1}, "f5", "v0");
  CHECK(tip.separation(3.5) == 8.5);
  // Lying on the face, over its edge, and over two of its corners.
  const Flight lying{box(2, 2, 1), capsule(0.5, 1, along_x), {0.25, 0.5, 6}, {0, 0, -1}};
  CHECK(lying.contact() == 4.5);
  check_place(lying, 4.5, {0.25, 0.5, 1}, {0, 0, 1}, "f5", "e0-1");
  const Flight over{box(2, 2, 1), capsule(0.5, 1, along_x), {2.5, 0.5, 6}, {0, 0, -1}};
  CHECK(over.contact() == 4.5);
  const Contact shared = over.where(4.5);  // within what they share
  CHECK((shared.point - Vector3d(1.75, 0.5, 1)).cwiseAbs().maxCoeff() < 0.25);
  CHECK(shared.point[2] == 1);
  CHECK(to_string(shared.feature_b) == "e0-1");
  const Flight long_one{box(2, 2, 1), capsule(0.5, 5, along_x), {0, 2, 6}, {0, 0, -1}};
  CHECK(long_one.contact() == 4.5);
  CHECK(long_one.separation(4.5) == 7.5);

  // Across the middle of an edge: along the diagonal of a square.
  const Flight edge{
      box(2, 2, 1), capsule(0.5, 1, Quaterniond(quarter, 0, 0, quarter) * along_x), {5, 5, 0}, {-1, -1, 0}};
  const Flight edge_up{box(2, 2, 1), capsule(0.5, 3), {5, 5, 0}, {-1, -1, 0}};  // parallel to it
  CHECK(edge_up.contact() == Approx(3 - 0.5 * quarter).epsilon(1e-15));
  check_place(edge_up, edge_up.contact(), {2, 2, 0}, {quarter, quarter, 0}, "e3-7", "e0-1");
  CHECK(edge.contact() < edge_up.contact());
  // Its end on a corner, along the diagonal of a cube.
  const Vector3d diagonal = Vector3d::Ones() / std::sqrt(3.0);
  // From z to the diagonal: about their cross product, by half of the angle. (FromTwoVectors compiles an SVD for this.)
  const Quaterniond to_diagonal = Quaterniond(1 + diagonal.z(), -diagonal.y(), diagonal.x(), 0).normalized();
  const Flight corner{box(1, 1, 1), capsule(0.5, 2, to_diagonal), 10 * diagonal, -diagonal};
  CHECK(corner.contact() == Approx(10 - 2 - 0.5 - std::sqrt(3.0)).epsilon(1e-14));
  CHECK(to_string(corner.where(corner.contact()).feature_a) == "v7");
  CHECK(to_string(corner.where(corner.contact()).feature_b) == "v0");
  // Grazing: over a face, along an edge, past a corner.
  CHECK(Flight{box(2, 2, 1), capsule(0.5, 1), {9, 0, 2.5}, {-1, 0, 0}}.contact() == never);
  CHECK(Flight{box(2, 2, 1), capsule(0.5, 1), {9, 0, std::nextafter(2.5, 0.0)}, {-1, 0, 0}}.contact() < 7);
  CHECK(Flight{box(2, 2, 1), capsule(0.5, 1), {2.5, 9, 2}, {0, -1, 0}}.contact() == never);
  CHECK(Flight{box(2, 2, 1), capsule(0.5, 1), {std::nextafter(2.5, 0.0), 9, 2}, {0, -1, 0}}.contact() < 7);
}

TEST_CASE("capsule: starts in touch, overlaps and goes on", "[capsule]") {
  const Flight resting{box(2, 2, 1), capsule(0.5, 1, along_x), {0, 0, 1.5}, {1, 0, 0}};
  CHECK(resting.contact() == never);
  CHECK(resting.contact(ContactMode::resolved) == never);
  CHECK_FALSE(resting.touches(0));
  const Flight pressed{box(2, 2, 1), capsule(0.5, 1, along_x), {0, 0, 1.5}, {0, 0, -1}};
  CHECK(pressed.contact() == 0);
  CHECK(pressed.contact(ContactMode::resolved) == 0);
  const Flight leaving{box(2, 2, 1), capsule(0.5, 1, along_x), {0, 0, std::nextafter(1.5, 0.0)}, {0, 0, 1}};
  CHECK(leaving.contact() == 0);
  CHECK(leaving.contact(ContactMode::resolved) == never);
  CHECK(leaving.separation(0) < 1e-15);
  const Flight turning{box(2, 2, 1), capsule(0.5, 1, along_x), {0, 0, 1.5}, {0, 0, 2}, {0, 0, -1}};
  CHECK(turning.contact() == 2);
  CHECK(turning.contact(ContactMode::resolved) == 2);
  // The cores overlap: out of the nearest face.
  const Flight deep{box(2, 2, 1), capsule(0.5, 1, along_x), {0.25, 0, 0.75}, {0, 0, 1}};
  CHECK(deep.touches(0));
  CHECK(deep.separation(0) == 0.75);
  CHECK((deep.where(0).normal - Vector3d::UnitZ()).norm() < 1e-15);
  const Flight far_in{box(9, 9, 9), capsule(0.5, 1), {0, 1, 0}, {0, 1, 0}};  // deeper than any face is thick
  CHECK(far_in.touches(0));
  CHECK(far_in.separation(0) == 8.5);
  const Flight one_in_another{capsule(1, 2), capsule(0.5, 3), {0, 0, 1}, {0, 0, 1}};
  CHECK(one_in_another.touches(0));
  CHECK(one_in_another.separation(0) == 5.5);
  CHECK(std::abs(one_in_another.where(0).normal[2]) < 1e-15);
  const Flight crossed{capsule(1, 2), capsule(0.5, 3, along_x), {0, 0, 0}, {0, 1, 0}};
  CHECK(std::abs(crossed.where(0).normal[1]) == 1);
  CHECK(crossed.separation(0) == 1.5);
}

TEST_CASE("capsule: of no length it is the ball, bit for bit", "[capsule]") {
  const Quaterniond turned = Quaterniond(0.3, -0.5, 0.7, 0.2).normalized();
  const PlacedShape none = capsule(0.5, 0, turned);
  CHECK(ball_radius(none.shape) == 0.5);
  CHECK(none.high == placed_ball(0.5).high);
  for (const PlacedShape& other : {place(Box{{0.3, 0.6, 0.9}}, turned), capsule(0.4, 0.7, turned), placed_ball(0.7)}) {
    const Vector3d from(4, 0.25, -0.125), velocity(-1, 0.03, 0.01);
    const Flight flight{other, none, from, velocity};
    const Flight ball{other, placed_ball(0.5), from, velocity};
    CHECK(flight.contact() == ball.contact());
    CHECK(flight.contact() < 4);
    CHECK(flight.where(flight.contact()).normal == ball.where(ball.contact()).normal);
  }
}

TEST_CASE("capsule: numbers that cannot be", "[capsule]") {
  const auto refusal = [](double radius, double half_length) {
    try {
      place(Capsule{radius, half_length}, upright);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  CHECK(refusal(0, 1) == "radius: must be > 0");
  CHECK(refusal(-1, 1) == "radius: must be > 0");
  CHECK(refusal(infinity, 1) == "radius: must be finite");
  CHECK(refusal(1, -1) == "half_length: must be >= 0");
  CHECK(refusal(1, std::nan("")) == "half_length: must be finite");
  CHECK(refusal(1, 1e-70).find("half_length: 1e-70 is below") == 0);
  CHECK(refusal(1, 1e70).find("half_length: 1e+70 is above") == 0);
  CHECK(refusal(1, 0) == "taken");
}

}  // namespace test_capsule_exact
