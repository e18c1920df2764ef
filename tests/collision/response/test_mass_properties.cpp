// Mass properties against formulas, and against surface integrals in rational numbers.
#include "collision/response/inertia.hpp"
#include "collision/response/mass_properties.hpp"
#include "collision/shapes/compound.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/mesh.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/support/random_numbers.hpp"

#include <Eigen/LU>
#include <boost/multiprecision/cpp_int.hpp>
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace test_mass_properties {
namespace {

using namespace kds::collision;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using samples::Random;
using Rational = boost::multiprecision::cpp_rational;
using Triangles = std::vector<Mesh::Triangle>;
using Vertices = std::vector<Vector3d>;
using Long = long double;

std::shared_ptr<const Mesh> make(Vertices vertices, Triangles triangles) {
  return std::make_shared<const Mesh>(std::move(vertices), std::move(triangles));
}

template <class Change>
std::shared_ptr<const Mesh> changed(const Mesh& mesh, const Change& change) {
  Vertices vertices;
  for (const Vector3d& v : mesh.vertices()) vertices.push_back(change(v));
  return make(vertices, {mesh.triangles().begin(), mesh.triangles().end()});
}

/// Both meshes as one.
std::shared_ptr<const Mesh> together(const Mesh& first, const Mesh& second, bool second_inward = false) {
  Vertices vertices(first.vertices().begin(), first.vertices().end());
  Triangles triangles(first.triangles().begin(), first.triangles().end());
  const auto before = static_cast<std::uint32_t>(vertices.size());
  vertices.insert(vertices.end(), second.vertices().begin(), second.vertices().end());
  for (auto [a, b, c] : second.triangles()) {
    if (second_inward) std::swap(b, c);
    triangles.push_back({a + before, b + before, c + before});
  }
  return make(vertices, triangles);
}

Matrix3d moments(double x, double y, double z) { return Vector3d(x, y, z).asDiagonal(); }

double off(const Matrix3d& a, const Matrix3d& b) { return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff(); }

std::string message(const Shape& shape, double mass = 1) {
  try {
    mass_properties(shape, mass);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

/// By the divergence theorem: the integral of x^p over the solid is that of x^(p+1) / (p+1) n_x over its surface, and
/// the mean of a product of three coordinates over a triangle is a sum over its corners.
struct ExactProperties {
  Rational volume;
  std::array<Rational, 3> centre;
  std::array<std::array<Rational, 3>, 3> inertia;  // of mass 1
};

ExactProperties exact_properties(const Mesh& mesh) {
  using Corner = std::array<Rational, 4>;  // its coordinates, and 1
  Rational volume = 0;
  std::array<Rational, 3> first;
  std::array<std::array<Rational, 3>, 3> second;
  for (const Mesh::Triangle& triangle : mesh.triangles()) {
    std::array<Corner, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3d& v = mesh.vertices()[triangle[i]];
      p[i] = {Rational(v[0]), Rational(v[1]), Rational(v[2]), Rational(1)};
    }
    std::array<Rational, 3> twice_area;
    for (std::size_t d = 0; d < 3; ++d) {
      const std::size_t e = (d + 1) % 3, f = (d + 2) % 3;
      twice_area[d] = (p[1][e] - p[0][e]) * (p[2][f] - p[0][f]) - (p[1][f] - p[0][f]) * (p[2][e] - p[0][e]);
    }
    const auto mean = [&](std::size_t x, std::size_t y, std::size_t z) {
      Rational sum = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
          for (std::size_t k = 0; k < 3; ++k) {
            const int weight = i == j && j == k ? 6 : i == j || j == k || k == i ? 2 : 1;
            sum += weight * p[i][x] * p[j][y] * p[k][z];
          }
        }
      }
      return Rational(sum / 60);
    };
    volume += twice_area[0] / 2 * mean(0, 3, 3);
    for (std::size_t d = 0; d < 3; ++d) {
      const std::size_t e = (d + 1) % 3;
      first[d] += twice_area[d] / 2 * mean(d, d, 3) / 2;
      second[d][d] += twice_area[d] / 2 * mean(d, d, d) / 3;
      second[d][e] += twice_area[d] / 2 * mean(d, d, e) / 2;
    }
  }
  ExactProperties result{volume, {}, {}};
  for (std::size_t d = 0; d < 3; ++d) result.centre[d] = first[d] / volume;
  for (std::size_t d = 0; d < 3; ++d) {
    const std::size_t e = (d + 1) % 3;
    const auto square = [&](std::size_t i) {
      return Rational(second[i][i] / volume - result.centre[i] * result.centre[i]);
    };
    result.inertia[d][d] = square(e) + square((d + 2) % 3);
    result.inertia[d][e] = result.inertia[e][d] = result.centre[d] * result.centre[e] - second[d][e] / volume;
  }
  return result;
}

double difference(double value, const Rational& exact) {
  const Rational d = Rational(value) - exact;
  return std::abs(d.convert_to<double>());
}

/// The bounds of the header, with the greatest extent of the mesh.
void check_exactly(const Mesh& mesh, double scale, double mass) {
  const MassProperties found = mass_properties(MeshShape{std::make_shared<const Mesh>(mesh), scale}, mass);
  const ExactProperties exact = exact_properties(mesh);
  Vector3d low, high;
  mesh.extents(Matrix3d::Identity(), scale, low, high);
  const double extent = (high - low).maxCoeff();
  CHECK(found.mass == mass);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto d = static_cast<std::size_t>(i);
    const double of_centre = difference(found.centre[i], exact.centre[d] * Rational(scale));
    CHECK(of_centre <= 0x1p-52 * std::abs(found.centre[i]) + 0x1p-54 * extent);
    for (Eigen::Index j = 0; j < 3; ++j) {
      const Rational meant =
          exact.inertia[d][static_cast<std::size_t>(j)] * Rational(scale) * Rational(scale) * Rational(mass);
      const double error = difference(found.inertia(i, j), meant);
      CHECK(error <= 0x1p-51 * std::abs(found.inertia(i, j)) + 0x1p-50 * mass * extent * extent);
      // What is no flat body has its roundings alone.
      CHECK(error <= 0x1p-51 * std::abs(found.inertia(i, j)) + 0x1p-80 * mass * extent * extent);
    }
  }
  CHECK(found.inertia == found.inertia.transpose());
}

TEST_CASE("Balls and boxes", "[mass properties]") {
  const MassProperties ball = mass_properties(Sphere{3}, 2);
  CHECK(ball.mass == 2);
  CHECK(ball.centre == Vector3d::Zero());
  CHECK(off(ball.inertia, moments(7.2, 7.2, 7.2)) < 4 * 0x1p-53);
  CHECK(is_spherical(ball.inertia));
  const MassProperties box = mass_properties(Box{{1, 2, 3}}, 6);
  CHECK(box.inertia == moments(26, 20, 10));
  CHECK(box.centre == Vector3d::Zero());
  CHECK(is_spherical(mass_properties(Box{{0.3, 0.3, 0.3}}, 0.7).inertia));
  CHECK_NOTHROW(checked_inertia(mass_properties(Box{{1, 1, 1e-30}}, 1).inertia));
  CHECK_NOTHROW(checked_inertia(mass_properties(Sphere{smallest_size}, smallest_size).inertia));
  CHECK_NOTHROW(checked_inertia(mass_properties(Sphere{largest_magnitude}, largest_magnitude).inertia));
}

/// Sums over discs across the axis: their squares of radii are polynomials of degree 2, their moments of degree 4, so
/// three points of Gauss are exact.
TEST_CASE("Capsules are their discs summed up", "[mass properties]") {
  for (const Capsule& capsule : std::vector<Capsule>{{1, 1}, {0.1, 7}, {5, 0.01}, {1e-20, 3e-20}, {2, 0}}) {
    const Long r = capsule.radius, h = capsule.half_length;
    Long volume = 0, along = 0, across = 0;
    const auto add = [&](Long from, Long to, bool cap) {
      const Long root = std::sqrt(0.6L) * (to - from) / 2;
      for (int i = -1; i <= 1; ++i) {
        const Long z = (from + to) / 2 + i * root, into = z - from;
        const Long square = cap ? r * r - into * into : r * r;
        const Long disc = square * (i == 0 ? 8 : 5) / 18 * (to - from);
        volume += disc, along += disc * square / 2, across += disc * (square / 4 + z * z);
      }
    };
    add(0, h, false);
    add(h, h + r, true);
    const MassProperties found = mass_properties(capsule, 3);
    CHECK(std::abs(found.inertia(2, 2) / (3 * along / volume) - 1) < 12 * 0x1p-53);
    CHECK(std::abs(found.inertia(0, 0) / (3 * across / volume) - 1) < 12 * 0x1p-53);
    CHECK(found.inertia(1, 1) == found.inertia(0, 0));
    CHECK(found.inertia.isDiagonal(0));
    CHECK(is_spherical(found.inertia) == (h == 0));
  }
  CHECK(mass_properties(Capsule{2, 0}, 3).inertia(0, 0) == Approx(mass_properties(Sphere{2}, 3).inertia(0, 0)));
}

TEST_CASE("A box of triangles has what the box has, wherever it is", "[mass properties]") {
  const Vector3d half(0.75, 1.5, 3.25);
  const auto box = samples::cuboid(half);
  const Matrix3d meant = mass_properties(Box{half}, 2.5).inertia;
  const MassProperties found = mass_properties(MeshShape{box}, 2.5);
  CHECK(off(found.inertia, meant) < 4 * 0x1p-53);
  CHECK(found.centre == Vector3d::Zero());
  for (const double scale : {1e-6, 1e6}) {
    const MassProperties scaled = mass_properties(MeshShape{box, scale}, 2.5);
    CHECK(off(scaled.inertia, scale * scale * meant) < 8 * 0x1p-53);
  }
  // 2^40 away vertices are still exact, and so the tensor is the same.
  const Vector3d far(0x1p40, -0x1p40, 3 * 0x1p38);
  const MassProperties away = mass_properties(MeshShape{changed(*box, [&](auto& v) { return v + far; })}, 2.5);
  CHECK(away.inertia == found.inertia);
  CHECK(away.centre == far);
  CHECK(is_spherical(mass_properties(MeshShape{samples::cuboid()}, 1).inertia));
}

TEST_CASE("A tetrahedron by its formula", "[mass properties]") {
  const auto mesh = make({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
  const MassProperties found = mass_properties(MeshShape{mesh}, 80);
  Matrix3d meant = Matrix3d::Constant(1);
  meant.diagonal().setConstant(6);
  CHECK(off(found.inertia, meant) < 4 * 0x1p-53);
  CHECK(found.centre == Vector3d::Constant(0.25));
}

TEST_CASE("What is symmetric about a plane has no products of inertia across it", "[mass properties]") {
  for (int sides = 3; sides <= 12; ++sides) {
    CAPTURE(sides);
    Vertices points;
    for (int i = 0; i < sides; ++i) {
      const double angle = 0.1 + 2 * std::acos(-1.0) * i / sides;
      for (const double z : {-0.3, 0.3}) points.emplace_back(0.7 * std::cos(angle), 0.25 * std::sin(angle), z);
    }
    const MassProperties prism = mass_properties(convex_hull(points), 1.7);
    CHECK((prism.inertia(0, 2) == 0 && prism.inertia(1, 2) == 0 && prism.centre[2] == 0));
  }
}

TEST_CASE("Finer and finer balls of triangles approach the ball", "[mass properties]") {
  double before = 0;
  for (int level = 0; level < 5; ++level) {
    const MassProperties found = mass_properties(MeshShape{samples::ball_mesh(level)}, 1);
    const double error = off(found.inertia, 0.4 * Matrix3d::Identity());
    if (level > 2) CHECK(before / error == Approx(4).margin(0.5));
    CHECK(found.centre.norm() < 1e-16);
    CHECK(is_spherical(found.inertia));
    before = error;
  }
  CHECK(before < 0.01);
}

TEST_CASE("Cubes turned by rounded rotations are spherical", "[mass properties]") {
  Random random(21);
  for (int i = 0; i < 200; ++i) {
    const Matrix3d r = random.orientation().toRotationMatrix();
    const auto mesh = changed(*samples::cuboid(), [&](const Vector3d& v) -> Vector3d { return r * v; });
    CHECK(is_spherical(mass_properties(MeshShape{mesh}, 1).inertia));
  }
}

TEST_CASE("Random meshes have the moments of rational numbers", "[mass properties]") {
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    INFO("seed " << seed);
    Random random(seed);
    const bool convex = seed % 2 == 0;
    Matrix3d shear;
    do {
      for (int d = 0; d < 3; ++d) shear.col(d) = random.vector(1);
    } while (shear.determinant() < 0.05);
    const Vector3d shift = seed % 3 == 0 ? random.vector(1e6) : random.vector(1);
    const double size = seed % 4 == 0 ? 1e-6 : seed % 4 == 1 ? 1e6 : 1;
    const auto mesh = changed(*samples::ball_mesh(seed % 5 == 0 ? 2 : 1), [&](const Vector3d& v) -> Vector3d {
      return size * (shear * v * (convex ? 1 : random.uniform(0.5, 1.5)) + shift);
    });
    check_exactly(*mesh, seed % 7 == 0 ? 1e-6 : seed % 7 == 1 ? 1e6 : random.uniform(0.5, 2), random.uniform(0.1, 9));
  }
  check_exactly(*samples::torus(12, 8), 1, 1);
  check_exactly(*samples::needle(), 0.3, 2);
}

TEST_CASE("Meshes whose numbers are at the ends of their range", "[mass properties]") {
  const auto cube = samples::cuboid();
  for (const double scale : {0x1p-110, 0x1p99}) {
    for (const double mass : {smallest_size, largest_magnitude}) {
      const Matrix3d found = mass_properties(MeshShape{cube, scale}, mass).inertia;
      CHECK(off(found / mass / (scale * scale), 2.0 / 3 * Matrix3d::Identity()) < 1e-15);
      CHECK_NOTHROW(checked_inertia(found));
    }
  }
}

TEST_CASE("Plates and needles, turned: their moments are within the bounds", "[mass properties]") {
  Random random(22);
  for (const double thin : {1e-2, 1e-4, 1e-6}) {
    for (int i = 0; i < 5; ++i) {
      const Matrix3d r = random.orientation().toRotationMatrix();
      const auto turn = [&](const Vector3d& v) -> Vector3d { return r * v; };
      INFO("thickness " << thin);
      check_exactly(*changed(*samples::cuboid({1, 1, thin}), turn), 1, 1);
      check_exactly(*changed(*samples::cuboid({thin, 1, thin}), turn), 1, 1);
    }
  }
}

TEST_CASE("Parts, cavities, touching parts and vertices named twice", "[mass properties]") {
  const auto cube = samples::cuboid();
  const Matrix3d of_8 = 8 * 2.0 / 3 * Matrix3d::Identity();
  // The cube of volume 64 without that of volume 8.
  const auto large = samples::cuboid({2, 2, 2});
  const MassProperties hollow = mass_properties(MeshShape{together(*large, *cube, true)}, 56);
  CHECK(off(hollow.inertia, 64 * 8.0 / 3 * Matrix3d::Identity() - of_8) < 1e-15);
  // Two cubes with a common edge, whose vertices are named by either: four triangles meet there.
  const auto next = changed(*cube, [](const Vector3d& v) -> Vector3d { return v + Vector3d(2, 2, 0); });
  const MassProperties two = mass_properties(MeshShape{together(*cube, *next)}, 16);
  CHECK(two.centre == Vector3d(1, 1, 0));
  Matrix3d apart = moments(1, 1, 2);
  apart(0, 1) = apart(1, 0) = -1;
  CHECK(off(two.inertia, 2 * of_8 + 16 * apart) < 1e-15);
  // No vertex is shared at all.
  Vertices vertices;
  Triangles triangles;
  for (const auto& triangle : cube->triangles()) {
    const auto n = static_cast<std::uint32_t>(vertices.size());
    for (const std::uint32_t i : triangle) vertices.push_back(cube->vertices()[i]);
    triangles.push_back({n, n + 1, n + 2});
  }
  CHECK(mass_properties(MeshShape{make(vertices, triangles)}, 8).inertia ==
        mass_properties(MeshShape{cube}, 8).inertia);
}

TEST_CASE("A compound has what its parts have as one mesh", "[mass properties]") {
  kds::tests::Random random(5);
  for (int run = 0; run < 20; ++run) {
    CAPTURE(run);
    std::vector<CompoundPart> parts;
    std::shared_ptr<const Mesh> whole;
    const int count = 1 + run % 4;
    for (int i = 0; i < count; ++i) {
      const Vector3d half(random.between(0.1, 2), random.between(0.1, 2), random.between(0.1, 2));
      const Vector3d at(random.between(-9, 9), random.between(-9, 9), random.between(-9, 9));
      const auto box = samples::cuboid(half);
      const auto placed = changed(*box, [&](const Vector3d& v) -> Vector3d { return v + at; });
      if (i % 3 == 0) parts.push_back({Box{half}, at});
      if (i % 3 == 1) parts.push_back({MeshShape{box}, at});
      if (i % 3 == 2) parts.push_back({convex_hull({box->vertices().begin(), box->vertices().end()}), at});
      whole = whole ? together(*whole, *placed) : placed;
    }
    const Compound made = compound(parts);
    const double mass = random.between(0.5, 3);
    const MassProperties expected = mass_properties(MeshShape{whole}, mass), found = mass_properties(made, mass);
    CHECK(found.mass == mass);
    CHECK((found.centre - expected.centre).norm() < 1e-14);
    CHECK(off(found.inertia, expected.inertia) < 1e-14);
    if (count == 1) {
      const MassProperties alone = mass_properties(made.parts->parts()[0], mass);
      CHECK((found.centre == alone.centre && found.inertia == alone.inertia));
    }
    const std::vector<CompoundPart> moved = about_centre_of_mass(parts);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      CHECK((parts[i].position - moved[i].position - found.centre).norm() < 1e-13);
    }
    const MassProperties centred = mass_properties(compound(moved), mass);
    CHECK(centred.centre.norm() < 1e-14);
    CHECK(off(centred.inertia, expected.inertia) < 1e-14);
  }
  // What two share counts twice. Three bars across each other, as they are, are spherical.
  const std::vector<CompoundPart> twice{{Box{{1, 1, 1}}}, {Box{{1, 1, 1}}}};
  CHECK(mass_properties(compound(twice), 2).inertia == mass_properties(Box{{1, 1, 1}}, 2).inertia);
  const std::vector<CompoundPart> jack{{Box{{2, 0.25, 0.25}}}, {Box{{0.25, 2, 0.25}}}, {Box{{0.25, 0.25, 2}}}};
  CHECK(is_spherical(mass_properties(compound(jack), 3).inertia));
}

TEST_CASE("A compound without mass properties is refused, and the part is named", "[mass properties]") {
  const auto cube = samples::cuboid();
  const Vertices vertices(cube->vertices().begin(), cube->vertices().end());
  Triangles open(cube->triangles().begin(), cube->triangles().end());
  open.pop_back();
  const auto with = [](const Shape& part) {
    const std::vector<CompoundPart> parts{{Box{{1, 1, 1}}}, {part, {3, 0, 0}}};
    return message(compound(parts));
  };
  const std::string name = "compound: part 1: mass_properties: the mesh ";
  CHECK(with(MeshShape{make(vertices, open)}) == name + "is open: edge 5-6 belongs to one triangle, 10");
  Triangles inward(cube->triangles().begin(), cube->triangles().end());
  for (auto& [a, b, c] : inward) std::swap(b, c);
  CHECK(with(MeshShape{make(vertices, inward)}) ==
        name + "is inside out: its triangles turn clockwise seen from outside");
  CHECK(message(Compound{}) == "compound: is missing");
  CHECK_THROWS_WITH(about_centre_of_mass({}), "compound: has no parts");
}

TEST_CASE("What has no mass properties is refused in one line", "[mass properties]") {
  const auto cube = samples::cuboid();
  const Vertices vertices(cube->vertices().begin(), cube->vertices().end());
  const Triangles triangles(cube->triangles().begin(), cube->triangles().end());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string name = "mass_properties: the mesh ";
  SECTION("masses and sizes") {
    CHECK(message(Sphere{1}, 0) == "mass: must be > 0");
    CHECK(message(Sphere{1}, -1) == "mass: must be > 0");
    CHECK(message(Sphere{1}, nan) == "mass: must be finite");
    CHECK(message(Sphere{1}, 1e70) == "mass: 1e+70 is above 2^205 (5.1e61)");
    CHECK(message(Sphere{1}, 1e-70) == "mass: 1e-70 is below 2^-205 (1.9e-62)");
    CHECK(message(Sphere{-1}) == "radius: must be > 0");
    CHECK(message(Box{{1, nan, 1}}) == "half_extents: must be finite");
    CHECK(message(Capsule{1, -1}) == "half_length: must be >= 0");
    CHECK(message(MeshShape{}) == "mesh: is missing");
    CHECK(message(MeshShape{cube, 0}) == "scale: must be > 0");
    CHECK(message(MeshShape{cube, nan}) == "scale: must be finite");
    CHECK(message(MeshShape{cube, 1e-40}).substr(0, 45) == "scale: 1e-40 makes an edge of the mesh 2e-40 ");
  }
  SECTION("an open mesh") {
    Triangles open = triangles;
    open.pop_back();  // {5, 7, 6}
    CHECK(message(MeshShape{make(vertices, open)}) == name + "is open: edge 5-6 belongs to one triangle, 10");
    CHECK(message(MeshShape{make(vertices, {{0, 1, 2}})}) == name + "is open: edge 0-1 belongs to one triangle, 0");
    open = triangles;
    open.push_back({0, 7, 2});
    CHECK(message(MeshShape{make(vertices, open)}) == name + "is open: edge 0-2 belongs to 3 triangles");
  }
  SECTION("triangles that contradict each other") {
    Triangles mixed = triangles;
    std::swap(mixed[11][0], mixed[11][1]);
    CHECK(message(MeshShape{make(vertices, mixed)}) ==
          name + "is not consistently oriented: triangles 10 and 11 both run along edge 5-6 that way");
  }
  SECTION("inside out") {
    Triangles inward = triangles;
    for (auto& triangle : inward) std::swap(triangle[0], triangle[1]);
    CHECK(message(MeshShape{make(vertices, inward)}) ==
          name + "is inside out: its triangles turn clockwise seen from outside");
  }
  SECTION("nothing within") {
    CHECK(message(MeshShape{make(vertices, {{0, 1, 2}, {0, 2, 1}})}) == name + "has no volume beyond rounding");
    CHECK(message(MeshShape{samples::cuboid({1, 1, 1e-13})}) == name + "has no volume beyond rounding");
    CHECK(message(MeshShape{together(*cube, *cube, true)}) == name + "has no volume beyond rounding");
  }
  SECTION("a needle") {
    CHECK(message(MeshShape{samples::cuboid({1, 1e-8, 1e-8})}) ==
          name + "is too thin: its least moment of inertia is lost in roundings");
    CHECK(message(MeshShape{samples::cuboid({1, 1e-6, 1e-6})}).empty());
  }
  SECTION("parts inside out that leave no body") {
    // Far from each other along x, one of them outweighs the other.
    const auto less =
        changed(*samples::cuboid({0.5, 1, 1}), [](const Vector3d& v) -> Vector3d { return v + Vector3d(9, 0, 0); });
    CHECK(!message(MeshShape{together(*cube, *less, true)}).empty());
  }
}

}  // namespace

}  // namespace test_mass_properties
