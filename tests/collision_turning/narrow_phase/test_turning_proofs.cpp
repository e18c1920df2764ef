// What doubles prove of parts of meshes that turn, and failure times that are remembered: against the definition.
#include "collision/narrow_phase/turning/float_vectors.hpp"
#include "collision/narrow_phase/turning/remembered_signs.hpp"
#include "collision/narrow_phase/turning/turning_mesh_sides.hpp"
#include "collision/narrow_phase/turning/turning_nodes.hpp"
#include "collision/narrow_phase/turning/turning_triangles.hpp"

#include "tests/collision/sample_meshes.hpp"
#include "tests/collision_turning/narrow_phase/turning_mesh_oracle.hpp"
#include "tests/collision_turning/narrow_phase/turning_oracle.hpp"
#include "tests/collision_turning/narrow_phase/turning_solids.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

namespace test_turning_proofs {
namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Vector3d;
using kds::tests::motion_of;
using kds::tests::Random;
using kds::tests::random_vector;
using Motion = certificates::RigidMotion<2>;
using EdgeEdge = certificates::EdgeEdgeSeparation<2>;
using VertexFace = certificates::VertexFaceSeparation<2>;

Motion random_motion(Random& random, const Vector3d& place) {
  return kds::tests::random_turning_motion(random, place, 2);
}

std::array<Vector3d, 3> random_triangle(Random& random) {
  const auto corner = [&] { return random_vector(random, 1); };
  return {corner(), corner(), corner()};
}

using Wide = Eigen::Matrix<long double, 3, 1>;
using Corners = std::array<Wide, 8>;

/// Where the corners of a node are at a time; the first three bits of a number say on which side of each axis.
Corners corners_of(const ObbNode& node, double unit, const Motion& motion, double when) {
  Corners corners;
  for (std::size_t k = 0; k < 8; ++k) {
    Vector3d corner(node.centre[0], node.centre[1], node.centre[2]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Vector3d direction(node.axes[0][axis], node.axes[1][axis], node.axes[2][axis]);
      corner += (k >> axis & 1 ? 1 : -1) * static_cast<double>(node.half_extents[axis]) * direction;
    }
    const auto place = kds::tests::TurningMeshOracle::point(motion, unit * corner, when);
    corners[k] = Wide(place[0], place[1], place[2]);
  }
  return corners;
}

/// The widest gap of two boxes along axes and products of axes.
long double gap_of(const Corners& a, const Corners& b) {
  std::vector<Wide> directions;
  for (const int i : {1, 2, 4}) {
    for (const int j : {1, 2, 4}) {
      const auto u = static_cast<std::size_t>(i), v = static_cast<std::size_t>(j);
      directions.insert(directions.end(), {a[u] - a[0], b[v] - b[0], (a[u] - a[0]).cross(b[v] - b[0])});
    }
  }
  long double widest = -std::numeric_limits<long double>::infinity();
  for (const Wide& direction : directions) {
    if (!(direction.norm() > 0)) continue;
    const Wide n = direction / direction.norm();
    const auto range = [&](const Corners& corners) {
      long double low = n.dot(corners[0]), high = low;
      for (const Wide& x : corners) low = std::min(low, n.dot(x)), high = std::max(high, n.dot(x));
      return std::pair(low, high);
    };
    const auto [low_a, high_a] = range(a);
    const auto [low_b, high_b] = range(b);
    widest = std::max({widest, low_a - high_b, low_b - high_a});
  }
  return widest;
}

/// Registers of eight floats, where there are any, give the bits that those of four do.
void check_widths(const FloatView& view, const NodesTogether& nodes) {
  const auto& four = collision::detail::gaps_by_four;
  const auto* const eight = collision::detail::gaps_by_eight();
  if (!eight) return;
  NodeWaits x, y;
  four.node_waits(view, nodes, x);
  eight->node_waits(view, nodes, y);
  CHECK(std::memcmp(x.part, y.part, sizeof x.part) == 0);
  CHECK(x.worth_it == y.worth_it);
  CHECK(four.nodes_apart_by(0.1F, view, nodes) == eight->nodes_apart_by(0.1F, view, nodes));
}
void check_widths(const FloatView& view, const TrianglesTogether& triangles) {
  const auto* const eight = collision::detail::gaps_by_eight();
  if (!eight) return;
  std::array<float, most_together> x, y;
  collision::detail::gaps_by_four.triangle_parts(view, triangles, x.data());
  eight->triangle_parts(view, triangles, y.data());
  CHECK(std::memcmp(x.data(), y.data(), sizeof x) == 0);
}

}  // namespace

TEST_CASE("nodes are apart for as long as is proven", "[turning]") {
  const std::uint64_t seed = 560;
  CAPTURE(seed);
  Random random(seed);
  int proven = 0, ended = 0;
  for (int round = 0; round < 1500; ++round) {
    const Motion a = random_motion(random, Vector3d::Zero()), b = random_motion(random, random_vector(random, 3));
    const auto half = [&] { return Vector3d(random.between(0, 1), random.between(0, 1), random.between(0, 1)); };
    const Box box_a{half()}, box_b{half()};
    const ObbNode node_a = box_node(box_a.half_extents), node_b = box_node(box_b.half_extents);
    const double t = random.between(0, 0.5), horizon = t + 1;
    const NodesView<2> view(a, b, {a, b}, box_units(box_a.half_extents), box_units(box_b.half_extents), t, horizon);
    NodesTogether nodes;
    nodes.count = most_together;
    for (int i = 0; i < most_together; ++i) nodes.a[i] = numbers_of(node_a), nodes.b[i] = numbers_of(node_b);
    CAPTURE(round);
    const auto gap = [&](double when) {
      return static_cast<double>(kds::tests::TurningOracle::gap(a, box_a, b, box_b, when));
    };
    if (const unsigned apart = nodes_apart_by(0.25, view, nodes); apart != 0) {
      CHECK(apart == 0xFF);
      // Along an axis; the oracle knows more of them.
      CHECK(gap(t) > 0.25);
    }
    const NodeWaits apart = nodes_apart(view, nodes);
    for (const float part : apart.part) CHECK(part == apart.part[0]);
    if (!apart.worth_it) continue;
    ++proven;
    const double until = std::min(horizon, t + view.ahead * static_cast<double>(apart.part[0]));
    for (int i = 0; i <= 20; ++i) CHECK(gap(t + (until - t) * i / 20) > 0);
    ended += until < horizon;
  }
  CHECK(proven > 500);
  CHECK(ended > 100);
}

TEST_CASE("nodes of meshes of any size are apart for as long as is proven", "[turning]") {
  const std::uint64_t seed = 563;
  CAPTURE(seed);
  Random random(seed);
  const auto mesh = samples::torus(8, 4);
  const auto nodes = mesh->tree().nodes();
  int proven = 0, ended = 0;
  for (int round = 0; round < 500; ++round) {
    const double size = std::ldexp(1.0, random.integer(-40, 40)), other = random.one_in(3) ? 0x1p-6 : 1;
    const MeshShape shape_a{mesh, size}, shape_b{mesh, size * other};
    const NodeUnits units_a = MeshOfPair(shape_a).units(), units_b = MeshOfPair(shape_b).units();
    Motion a = random_motion(random, Vector3d::Zero()), b = random_motion(random, random_vector(random, 2));
    for (Motion* const motion : {&a, &b}) {
      for (Vector3d& coefficient : motion->path.coefficients) coefficient *= size;
    }
    constexpr std::size_t count = most_together;
    std::array<const ObbNode*, count> nodes_a, nodes_b;
    for (const ObbNode*& node : nodes_a) node = &nodes[random.below(nodes.size())];
    for (const ObbNode*& node : nodes_b) node = &nodes[random.below(nodes.size())];
    NodesTogether together;
    together.count = most_together;
    for (std::size_t i = 0; i < count; ++i) {
      together.a[i] = numbers_of(*nodes_a[i]), together.b[i] = numbers_of(*nodes_b[i]);
    }
    const double t = random.between(0, 0.5), horizon = t + 1;
    const NodesView<2> view(a, b, {a, b}, units_a, units_b, t, horizon);
    const NodeWaits apart = nodes_apart(view, together);
    check_widths(view.floats, together);
    for (std::size_t pair = 0; pair < count; ++pair) {
      if (!(apart.worth_it >> pair & 1)) continue;
      ++proven;
      CAPTURE(round, pair);
      const double until = std::min(horizon, t + view.ahead * static_cast<double>(apart.part[pair]));
      for (int i = 0; i <= 20; ++i) {
        const double when = t + (until - t) * i / 20;
        CHECK(gap_of(corners_of(*nodes_a[pair], units_a.unit, a, when),
                     corners_of(*nodes_b[pair], units_b.unit, b, when)) > 0);
      }
      ended += until < horizon;
    }
  }
  CHECK(proven > 500);
  CHECK(ended > 100);
}

TEST_CASE("triangles are apart for as long as is proven, and conditions that are sure hold", "[turning]") {
  using Oracle = kds::tests::TurningMeshOracle;
  const std::uint64_t seed = 561;
  CAPTURE(seed);
  Random random(seed);
  int proven = 0, sure = 0;
  for (int round = 0; round < 1000; ++round) {
    const Motion a = random_motion(random, Vector3d::Zero()), b = random_motion(random, random_vector(random, 2));
    const auto p = random_triangle(random), q = random_triangle(random);
    const TurningTriangles<2> pair(a, p, b, q);
    const double t = random.between(0, 0.5);
    CAPTURE(round);
    const auto placed = [](const Motion& motion, const std::array<Vector3d, 3>& corners, double when) {
      Oracle::Triangle triangle;
      for (std::size_t i = 0; i < 3; ++i) triangle[i] = Oracle::point(motion, corners[i], when);
      return std::vector<Oracle::Triangle>{triangle};
    };
    const double until = std::min(t + 1, pair.apart_until(t, t + 1));
    if (until > t) {
      ++proven;
      for (int i = 0; i <= 20; ++i) {
        const double when = t + (until - t) * i / 20;
        CHECK(Oracle::depth(placed(a, p, when), placed(b, q, when)) <= 0);
      }
    }
    const auto view = pair.frame(t);
    const double stretch = random.unit() * view.stretch(2, 1);
    for (int way = 0; way < TurningTriangles<2>::ways; ++way) {
      const auto unsure = pair.unsure(view, way, stretch);
      for (unsigned number = 0; number < 3; ++number) {
        if (unsure >> number & 1) continue;
        ++sure;
        pair.every_condition(way, 1u << number, [&](const auto& condition) {
          for (int i = 0; i <= 4; ++i) CHECK(sign_after(condition, t + stretch * i / 4) == 1);
          return true;
        });
      }
    }
  }
  CHECK(proven > 300);
  CHECK(sure > 3000);
}

TEST_CASE("conditions that begin to hold go on for as long as they surely rise", "[turning]") {
  const std::uint64_t seed = 566;
  CAPTURE(seed);
  Random random(seed);
  int begun = 0, rising = 0;
  for (int round = 0; round < 120; ++round) {
    const Motion a = random_motion(random, Vector3d::Zero()), b = random_motion(random, random_vector(random, 2));
    auto p = random_triangle(random), q = random_triangle(random);
    const double size = round % 2 == 0 ? 1 : 0x1p-20;  // then conditions of directions are far greater than the others
    for (Vector3d& corner : p) corner *= size;
    for (Vector3d& corner : q) corner *= size;
    const TurningTriangles<2> pair(a, p, b, q);
    const double t = random.between(0, 0.5);
    for (int way = 0; way < TurningTriangles<2>::ways; ++way) {
      for (unsigned number = 0; number < 3; ++number) {
        pair.every_condition(way, 1u << number, [&](const auto& condition) {
          const double begins = recovery_time(condition, t, t + 1);
          if (begins == never || begins == t) return true;
          ++begun;
          CAPTURE(round, way, number, begins);
          const auto view = pair.frame(begins);
          const double stretch = std::ldexp(view.stretch(2 * size, 1), -random.integer(0, 12)) * random.unit();
          const auto unsure = pair.unsure(view, way, stretch), of_open = pair.unsure_while_open(view, way, stretch);
          CHECK((unsure >> number & 1) == 1);
          CHECK((of_open & ~unsure) == 0);
          if (of_open >> number & 1) return true;
          ++rising;
          for (int i = 0; i <= 4; ++i) CHECK(sign_after(condition, begins + stretch * i / 4) == 1);
          return true;
        });
      }
    }
  }
  CHECK(begun > 500);
  CHECK(rising > 200);
}

TEST_CASE("triangles side by side are apart for as long as floats prove", "[turning]") {
  using Oracle = kds::tests::TurningMeshOracle;
  const std::uint64_t seed = 564;
  CAPTURE(seed);
  Random random(seed);
  int proven = 0, ended = 0;
  for (int round = 0; round < 300; ++round) {
    const Motion a = random_motion(random, Vector3d::Zero()), b = random_motion(random, random_vector(random, 2));
    constexpr std::size_t count = most_together;
    std::array<std::array<Vector3d, 3>, count> p, q;
    const double small = random.one_in(2) ? 1 : 0x1p-8;  // about the same point, so that they are near each other
    for (std::size_t pair = 0; pair < count; ++pair) {
      p[pair] = random_triangle(random), q[pair] = random_triangle(random);
      for (Vector3d& corner : p[pair]) corner *= small;
      if (random.one_in(4)) q[pair][2] = q[pair][1];  // a needle
    }
    const double t = random.between(0, 0.5), horizon = t + 1, farthest = 1.75;
    const NodesView<2> view(a, b, {a, b}, {1, 0, farthest}, {1, 0, farthest}, t, horizon);
    TrianglesTogether triangles{};
    triangles.count = most_together;
    for (std::size_t pair = 0; pair < count; ++pair) {
      for (std::size_t k = 0; k < 3; ++k) {
        put_corner(triangles.a[k][pair], view, p[pair][k]);
        put_corner(triangles.b[k][pair], view, q[pair][k]);
      }
    }
    std::array<float, count> parts;
    find_triangle_parts(view.floats, triangles, parts.data());
    check_widths(view.floats, triangles);
    const auto placed = [](const Motion& motion, const std::array<Vector3d, 3>& corners, double when) {
      Oracle::Triangle triangle;
      for (std::size_t i = 0; i < 3; ++i) triangle[i] = Oracle::point(motion, corners[i], when);
      return std::vector<Oracle::Triangle>{triangle};
    };
    for (std::size_t pair = 0; pair < count; ++pair) {
      if (!(parts[pair] > 0)) continue;
      ++proven;
      CAPTURE(round, pair);
      const double until = std::min(horizon, t + view.ahead * static_cast<double>(parts[pair]));
      for (int i = 0; i <= 20; ++i) {
        const double when = t + (until - t) * i / 20;
        CHECK(Oracle::depth(placed(a, p[pair], when), placed(b, q[pair], when)) <= 0);
      }
      ended += parts[pair] < 1;
    }
  }
  CHECK(proven > 400);
  CHECK(ended > 200);
}

TEST_CASE("functions are positive for the part of the time that is said", "[turning]") {
  const std::uint64_t seed = 565;
  CAPTURE(seed);
  Random random(seed);
  int ended = 0, all = 0;
  for (int round = 0; round < 2000; ++round) {
    FourFloats f0, f1, bend, third;
    for (int i = 0; i < 4; ++i) {
      const auto number = [&](double size) {
        return random.one_in(5) ? 0.0F : static_cast<float>(size * std::pow(10.0, random.between(-6, 0)));
      };
      f0[i] = number(1), f1[i] = number(2) * (random.one_in(3) ? 1.0F : -1.0F);
      bend[i] = number(4) * (random.one_in(3) ? 1.0F : -1.0F), third[i] = number(8);
    }
    const FourFloats part = positive_part(f0, f1, bend, third);
    for (int i = 0; i < 4; ++i) {
      CAPTURE(round, i, f0[i], f1[i], bend[i], third[i], part[i]);
      if (!(f0[i] > 0)) {
        CHECK(part[i] == 0);
        continue;
      }
      CHECK((part[i] > 0 && part[i] <= 1));
      const auto at = [&](long double s) {
        return f0[i] + s * (f1[i] + s * (std::min(bend[i], 0.0F) / 2 - s * third[i] / 6));
      };
      CHECK(at(part[i]) >= 0);                                                     // concave: so it is before
      if (part[i] < 1 && third[i] == 0) CHECK(at(part[i] * (1 + 0x1p-14L)) <= 0);  // as long as can be said
      part[i] < 1 ? ++ended : ++all;
    }
  }
  CHECK(ended > 500);
  CHECK(all > 500);
}

TEST_CASE("signs that are remembered are those that are found", "[turning]") {
  const std::uint64_t seed = 562;
  CAPTURE(seed);
  Random random(seed);
  int fail = 0, recover = 0;
  for (int round = 0; round < 100; ++round) {
    const Motion a = random_motion(random, Vector3d::Zero()), b = random_motion(random, random_vector(random, 1));
    const auto p = random_triangle(random), q = random_triangle(random);
    const EdgeEdge edges{a, b, {p[0], p[1]}, {q[0], q[1]}}, back{a, b, {p[1], p[0]}, {q[1], q[0]}};
    const EdgeEdge other{a, b, {p[1], p[0]}, {q[0], q[1]}};  // the other sign
    const VertexFace vertex{a, b, p[0], q}, of_b{b, a, q[0], p};
    // Bodies of the same shape have points of the same coordinates.
    const VertexFace alike{a, b, p[0], {p[1], q[0], q[1]}};
    const EdgeEdge fixed{a, a, {p[0], p[1]}, {p[0], p[1]}};  // zero at all times
    RememberedSigns signs;
    CAPTURE(round);
    std::vector<double> times;
    for (int ask = 0; ask < 20; ++ask) {
      // Times at which signs have changed are asked for again.
      const bool again = !times.empty() && random.one_in(3);
      const double t = again ? times[random.below(times.size())] : random.between(0, 1);
      const double until = t + random.between(0, 2);
      const auto compare = [&](const auto& certificate) {
        CHECK(signs.sign_after(certificate, t) == sign_after(certificate, t));
        const double fails = failure_time(certificate, t, until), recovers = recovery_time(certificate, t, until);
        if (random.one_in(2)) CHECK(signs.failure_time(certificate, t, until) == fails);
        CHECK(signs.recovery_time(certificate, t, until) == recovers);
        CHECK(signs.failure_time(certificate, t, until) == fails);
        fail += fails > t && fails<never, recover += recovers> t && recovers < never;
        for (const double time : {fails, recovers}) {
          if (time == never) continue;
          times.push_back(time);
          CHECK(signs.sign_after(certificate, time) == (time == fails ? -1 : 1));
          if (time > t) CHECK(signs.sign_after(certificate, next_down(time)) == (time == fails ? 1 : -1));
        }
      };
      compare(edges), compare(alike), compare(back), compare(other), compare(vertex), compare(of_b), compare(fixed);
    }
  }
  CHECK(fail > 500);
  CHECK(recover > 500);
}

}  // namespace test_turning_proofs
