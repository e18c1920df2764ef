// Shapes and worlds as lines.
#include "collision/drawing/draw_world.hpp"

#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

namespace kds::collision::test_drawing {
namespace {

using namespace tests;

constexpr double rounding = 1e-12;

template <class Check>
void check_points(const std::vector<Segment>& lines, const Check& check) {
  for (const auto& line : lines) {
    for (const Vector3d& x : line) check(x);
  }
}

TEST_CASE("Lines of round shapes are on their surfaces, and circles close") {
  for (const int sides : {1, 4, 23, 24}) {
    CAPTURE(sides);
    const auto quarter = static_cast<std::size_t>((sides + 3) / 4);
    const auto ball = outline(Sphere{2.5}, 0, sides);
    CHECK(ball.size() == 12 * quarter);
    check_points(ball, [](const Vector3d& x) { CHECK(x.norm() == Approx(2.5).epsilon(rounding)); });
    for (std::size_t i = 1; i < ball.size(); ++i) {
      if (i % (4 * quarter) != 0) CHECK(ball[i][0] == ball[i - 1][1]);
    }
    const auto capsule = outline(Capsule{0.5, 2}, 0, sides);
    CHECK(capsule.size() == 2 * 8 * quarter + 4);
    check_points(capsule, [](const Vector3d& x) {
      const Vector3d on_axis(0, 0, std::clamp(x[2], -2.0, 2.0));
      CHECK((x - on_axis).norm() == Approx(0.5).epsilon(rounding));
    });
  }
}

TEST_CASE("Lines of boxes, hulls and meshes are their edges, each once") {
  const auto box = outline(Box{{1, 2, 3}});
  CHECK(box.size() == 12);
  for (const auto& [from, to] : box) {
    CHECK((from.cwiseAbs() == Vector3d(1, 2, 3) && to.cwiseAbs() == Vector3d(1, 2, 3)));
    CHECK(((to - from).array() != 0).count() == 1);
  }
  const std::vector<Vector3d> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  CHECK(outline(convex_hull(corners)).size() == 6);
  const auto torus = samples::torus(8, 4);
  const auto edges = outline(MeshShape{torus, 2});
  CHECK(edges.size() == torus->triangles().size() * 3 / 2);
  std::set<std::pair<std::size_t, std::size_t>> seen;
  for (const auto& line : edges) {
    std::array<std::size_t, 2> ends{};
    for (int k = 0; k < 2; ++k) {
      const auto found = std::find(torus->vertices().begin(), torus->vertices().end(), Vector3d(line[k] / 2));
      REQUIRE(found != torus->vertices().end());
      ends[k] = static_cast<std::size_t>(found - torus->vertices().begin());
    }
    CHECK(seen.insert(std::minmax(ends[0], ends[1])).second);
  }
}

TEST_CASE("A mesh that bends is drawn as it is at that time") {
  const std::vector<Vector3d> flat{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  std::vector<Vector3d> bent = flat;
  bent[2] = {0, 1, 4};
  const auto script = std::make_shared<const MeshScript>(std::vector<MeshScript::Keyframe>{{0, flat}, {2, bent}},
                                                         std::vector<Mesh::Triangle>{{0, 1, 2}});
  const auto lines = outline(BendingMesh{script}, 1);
  REQUIRE(lines.size() == 3);
  CHECK(lines[1][1] == Vector3d(0, 1, 2));
  CHECK(lines[2][1] == Vector3d(0, 1, 2));
}

TEST_CASE("A world is drawn where its bodies are, each as what it is") {
  World<1> world(with_response(Response::elastic));
  const BodyId moving = world.add_body(body<1>(Box{{1, 1, 1}}, motion<1>({2, 0, 0}, {1, 0, 0})));
  auto described = body<1>(Box{{1, 2, 3}}, motion<1>({9, 9, 9}));
  described.fixed = true;
  world.add_body(described);
  described = ball<1>(0.5, {-9, 0, 0});
  described.sensor = true;
  world.add_body(described);
  auto later = ball<1>(1, {50, 0, 0});
  later.motion[0].start = 5;
  world.add_body(later);
  world.advance_to(1);
  std::map<Drawn, std::vector<Segment>> drawn;
  const DrawLine line = [&](const Vector3d& from, const Vector3d& to, Drawn what) {
    drawn[what].push_back({from, to});
  };
  draw(world, line, {.sides = 8, .velocity_seconds = 0.5}, 3);
  CHECK(drawn[Drawn::body].size() == 12);
  check_points(drawn[Drawn::body],
               [](const Vector3d& x) { CHECK((x - Vector3d(5, 0, 0)).cwiseAbs() == Vector3d::Ones()); });
  CHECK(drawn[Drawn::fixed].size() == 12);
  CHECK(drawn[Drawn::sensor].size() == 24);
  REQUIRE(drawn[Drawn::velocity].size() == 3);
  CHECK(drawn[Drawn::velocity][0][0] == Vector3d(5, 0, 0));
  CHECK(drawn[Drawn::velocity][0][1] == Vector3d(5.5, 0, 0));
  drawn.clear();
  draw(world, line, {.bodies = [&](BodyId id) { return id == moving; }});
  CHECK(drawn.size() == 1);
  check_points(drawn[Drawn::body],
               [](const Vector3d& x) { CHECK((x - Vector3d(3, 0, 0)).cwiseAbs() == Vector3d::Ones()); });
}

TEST_CASE("Partners are joined by one line each") {
  World<1> world(with_response(Response::none));
  for (const double x : {0.0, 1.5, 3.0, 9.0}) world.add_body(ball<1>(1, {x, 0, 0}));
  world.advance_to(1);
  std::vector<Segment> partners;
  const DrawLine line = [&](const Vector3d& from, const Vector3d& to, Drawn what) {
    if (what == Drawn::partner) partners.push_back({from, to});
  };
  draw(world, line, {.partners = true});
  CHECK(partners == std::vector<Segment>{{zero, Vector3d(1.5, 0, 0)}, {Vector3d(1.5, 0, 0), Vector3d(3, 0, 0)}});
}

}  // namespace
}  // namespace kds::collision::test_drawing
