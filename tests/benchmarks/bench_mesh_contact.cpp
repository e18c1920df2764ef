// Times of the tests of meshes: one box test, one pair of triangles, whole queries, building of trees.
#include "collision/narrow_phase/convex_touch.hpp"
#include "collision/narrow_phase/mesh_contact.hpp"
#include "collision/narrow_phase/obb_descent.hpp"
#include "collision/narrow_phase/separating_axes.hpp"
#include "tests/collision/sample_meshes.hpp"

#include <cstdio>
#include <ctime>
#include <limits>
#include <vector>

namespace {

using namespace kds::collision;
using namespace kds::collision::samples;

/// CPU time: other programs on the machine do not count.
double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

constexpr int rounds = 5;

/// Runs work(i) for i = 0 ... n - 1, several times, and gives the fastest time of one in nanoseconds.
template <class Work>
double nanoseconds(int n, const Work& work) {
  double best = std::numeric_limits<double>::infinity();
  for (int round = 0; round < rounds; ++round) {
    const double start = seconds();
    for (int i = 0; i < n; ++i) work(i);
    best = std::min(best, seconds() - start);
  }
  return best / n * 1e9;
}

template <int Degree>
void queries(const char* what, const std::shared_ptr<const Mesh>& mesh, int n, double miss) {
  Random random(1);
  std::vector<PlacedShape> shapes;
  std::vector<RelativeMotion<Degree>> motions;
  for (int i = 0; i < n; ++i) {
    for (int side = 0; side < 2; ++side) {
      const double scale = random.uniform(0.8, 1.2);
      shapes.push_back(placed(mesh, scale, random.orientation()));
    }
    motions.push_back(encounter<Degree>(random, 4, miss));
  }
  int hits = 0;
  const auto pair = [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    return MeshPair<Degree>(shapes[2 * k], shapes[2 * k + 1], motions[k]);
  };
  const double first =
      nanoseconds(n, [&](int i) { hits += pair(i).first_contact(0, 10, ContactMode::resolved).has_value(); });
  double free = 0;
  int found = 0;
  const double where = nanoseconds(n, [&](int i) {
    if (const auto touch = pair(i).first_contact(0, 10, ContactMode::resolved)) {
      pair(i).where(touch->tau);
      ++found;
    }
  });
  free = nanoseconds(n, [&](int i) {
    if (const auto touch = pair(i).first_contact(0, 10, ContactMode::resolved)) pair(i).first_free_time(touch->tau, 10);
  });
  std::printf("%-34s degree %d: first contact %8.2f us (%2d %% hit), where %8.2f us, first free time %8.2f us\n", what,
              Degree, first / 1e3, 100 * hits / (rounds * n), (where - first) / 1e3, (free - first) / 1e3);
}

template <int Degree>
void ball_queries(const char* what, const std::shared_ptr<const Mesh>& mesh, int n) {
  Random random(1);
  std::vector<PlacedShape> shapes;
  std::vector<RelativeMotion<Degree>> motions;
  for (int i = 0; i < n; ++i) {
    const double scale = random.uniform(0.8, 1.2);
    shapes.push_back(placed(mesh, scale, random.orientation()));
    motions.push_back(encounter<Degree>(random, 4, 1));
  }
  int hits = 0;
  for (const Shape& other : {Shape(Sphere{0.4}), Shape(Box{{0.3, 0.4, 0.2}})}) {
    const PlacedShape b = place(other, random.orientation());
    const double time = nanoseconds(n, [&](int i) {
      const auto k = static_cast<std::size_t>(i);
      hits += MeshPair<Degree>(shapes[k], b, motions[k]).first_contact(0, 10, ContactMode::resolved).has_value();
    });
    std::printf("%-25s and %-4s degree %d: first contact %8.2f us\n", what, other.index() == 0 ? "ball" : "box", Degree,
                time / 1e3);
  }
}

template <int Degree>
void single_tests() {
  Random random(2);
  const int n = 1000;
  std::vector<PlacedShape> shapes;
  std::vector<RelativeMotion<Degree>> motions;
  const auto mesh = torus(8, 4);
  for (int i = 0; i < n; ++i) motions.push_back(encounter<Degree>(random, 3, 1));
  std::vector<ObbNode> nodes;
  for (int i = 0; i < n; ++i) {
    ObbNode node = mesh->tree().nodes()[random.below(static_cast<std::uint32_t>(mesh->tree().nodes().size()))];
    const Eigen::Matrix3d axes = random.orientation().toRotationMatrix();
    for (int k = 0; k < 3; ++k) node.axes[static_cast<std::size_t>(k)] = lanes(axes.row(k));
    nodes.push_back(node);
  }
  const TreePose pose{nodes, 1, random.orientation().toRotationMatrix()};
  const std::array<double, Degree + 1> margin{};
  int passed = 0;
  const double box = nanoseconds(n, [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    const SliceMotion<Degree> motion(motions[k], contact_gap(motions[k], 3), {0, 1}, 3);
    const BoxPairTest<Degree> test(pose, pose, motion);
    for (int j = 0; j < 16; ++j) {
      const auto frame = test.frame(nodes[(k + static_cast<std::size_t>(j)) % nodes.size()]);
      for (int m = 0; m < 2; ++m) {
        StepWindow window;
        passed += test(frame, nodes[(k + static_cast<std::size_t>(j * 7 + m)) % nodes.size()], window);
      }
    }
  });
  std::printf("box against box                    degree %d: %6.1f ns (%d %% pass)\n", Degree, box / 32,
              passed / (rounds * 32 * n / 100));
  std::vector<PlacedTriangle> triangles;
  for (int i = 0; i < n; ++i) triangles.push_back({{random.vector(1), random.vector(1), random.vector(1)}});
  passed = 0;
  const double quick = nanoseconds(n, [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    for (std::size_t j = 0; j < 32; ++j) {
      TimeWindow window{0, 1};
      passed += may_touch(triangles[k], triangles[(k + j + 1) % triangles.size()], motions[k], margin, window);
    }
  });
  std::printf("triangles, quick test              degree %d: %6.1f ns (%d %% pass)\n", Degree, quick / 32,
              passed / (rounds * 32 * n / 100));
  double sum = 0;
  const double full = nanoseconds(n, [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    const auto gap = contact_gap(motions[k], 4);
    const ConvexTouch<Degree, PlacedTriangle> touch(triangles[k], triangles[(k + 1) % triangles.size()], motions[k],
                                                    gap, false);
    sum += touch.first_inside(0) < 1;
  });
  std::printf("triangles, closed forms            degree %d: %6.1f ns (%.0f)\n", Degree, full, sum);
}

}  // namespace

int main() {
  const auto ring = torus(8, 4);
  const auto knot = torus(78, 39, 0.75, 0.25, 0.2);
  std::printf("ring %zu triangles, torus %zu triangles\n", ring->triangles().size(), knot->triangles().size());
  double start = seconds();
  const Mesh copy(std::vector<Vector3d>(knot->vertices().begin(), knot->vertices().end()),
                  std::vector<Mesh::Triangle>(knot->triangles().begin(), knot->triangles().end()));
  std::printf("tree of %zu triangles: %.1f ms, %zu nodes\n", copy.triangles().size(), (seconds() - start) * 1e3,
              copy.tree().nodes().size());
  single_tests<1>();
  single_tests<2>();
  queries<1>("rings on collision course", ring, 2000, 0.5);
  queries<2>("rings on collision course", ring, 2000, 0.5);
  queries<1>("rings that meet or miss", ring, 2000, 3);
  queries<2>("rings that meet or miss", ring, 2000, 3);
  queries<1>("tori of 6 084 on collision course", knot, 200, 0.5);
  queries<2>("tori of 6 084 on collision course", knot, 200, 0.5);
  queries<1>("tori of 6 084 that meet or miss", knot, 200, 3);
  ball_queries<1>("ring", ring, 2000);
  ball_queries<2>("ring", ring, 2000);
  ball_queries<1>("torus", knot, 500);
  ball_queries<2>("torus", knot, 500);
}
