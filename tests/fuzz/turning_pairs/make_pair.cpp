#include "tests/fuzz/turning_pairs/make_pair.hpp"

#include "collision/shapes/compound.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/polytope.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/support/random_numbers.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

namespace turning_pairs {
namespace {

using Eigen::Vector3d;
using kds::collision::Box;
using kds::collision::Capsule;
using kds::collision::Compound;
using kds::collision::CompoundPart;
using kds::collision::ConvexHull;
using kds::collision::HalfSpace;
using kds::collision::Mesh;
using kds::collision::MeshShape;
using kds::collision::Shape;
using kds::collision::Sphere;
using kds::tests::Random;

enum Family : std::size_t {
  random_pair,
  parallel,
  shared_axis,
  along_axis,
  one_still,
  flat,
  grazing,
  linked,
  far_past
};

Vector3d direction(Random& random) {
  return Vector3d(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)).normalized();
}

/// From 1e-9 to 1e4 rad/s, more of them in the middle.
double random_rate(Random& random) {
  return std::pow(10.0, random.one_in(4) ? random.between(-9, 4) : random.between(-2, 2));
}

MeshShape triangle(Random& random, bool sliver) {
  const Vector3d a = direction(random), b = sliver ? Vector3d(-a + 0.001 * direction(random)) : direction(random);
  const Vector3d c = sliver ? Vector3d(a + 0.01 * direction(random)) : direction(random);
  return {std::make_shared<const Mesh>(std::vector<Vector3d>{a, b, c}, std::vector<Mesh::Triangle>{{0, 1, 2}})};
}

/// Two balls do not turn, so that one of a pair is something else.
Shape random_shape(Random& random, std::size_t family, bool ball) {
  const Vector3d half(random.between(0.1, 1), random.between(0.1, 1), random.between(0.1, 1));
  if (family == flat) {
    if (random.one_in(2)) return triangle(random, random.one_in(2));
    return Box{Vector3d(half[0], half[1], 1e-3 * half[2])};
  }
  if (family == parallel)
    return random.one_in(4) ? Shape(MeshShape{kds::collision::samples::cuboid(half)}) : Shape(Box{half});
  if (ball && random.one_in(4)) return Sphere{half[0]};
  if (random.one_in(3)) return triangle(random, false);
  if (random.one_in(10)) return MeshShape{kds::collision::samples::cuboid(half)};
  return Box{half};
}

std::vector<Piece> surface_pieces(const Mesh& mesh, double scale) {
  std::vector<Piece> pieces;
  for (const auto& corners : mesh.triangles()) {
    std::array<Vector3d, 3> points;
    for (std::size_t i = 0; i < 3; ++i) points[i] = scale * mesh.vertices()[corners[i]];
    pieces.push_back(triangle_piece(points));
  }
  return pieces;
}

std::vector<Piece> pieces_of(const Shape& shape) {
  if (const auto* const box = std::get_if<Box>(&shape)) return {box_piece(box->half_extents)};
  if (const auto* const ball = std::get_if<Sphere>(&shape)) return {ball_piece(ball->radius)};
  if (const auto* const plane = std::get_if<HalfSpace>(&shape)) return {half_space_piece(plane->normal, plane->offset)};
  if (const auto* const capsule = std::get_if<Capsule>(&shape)) {
    return {capsule_piece(capsule->radius, capsule->half_length)};
  }
  if (const auto* const hull = std::get_if<ConvexHull>(&shape)) {
    const auto points = hull->polytope->points();
    const auto normals = hull->polytope->normals();
    std::vector<std::array<std::size_t, 2>> edges;
    for (const auto& edge : hull->polytope->structure().edges) edges.push_back({edge.ends[0], edge.ends[1]});
    std::vector<Piece> pieces = surface_pieces(*hull->polytope->surface(), 1);
    for (Piece& piece : pieces) piece.counts = Piece::Counts::with_meshes;
    pieces.push_back(polytope_piece({points.begin(), points.end()}, {normals.begin(), normals.end()}, edges));
    pieces.back().counts = Piece::Counts::with_solids;
    return pieces;
  }
  std::vector<Piece> pieces;
  if (const auto* const compound = std::get_if<Compound>(&shape)) {
    for (const Shape& part : compound->parts->parts()) {
      for (const Piece& piece : pieces_of(part)) pieces.push_back(piece);
    }
    return pieces;
  }
  const auto& mesh = std::get<MeshShape>(shape);
  pieces = surface_pieces(*mesh.mesh, mesh.scale);
  for (Piece& piece : pieces) piece.of_mesh = true;
  return pieces;
}

/// A corner of a box goes round past a plate at a distance from 0.1 to 1e-12, or as deep in it.
void make_grazing(RandomPair& pair, Random& random) {
  const Vector3d half(random.between(0.3, 1), random.between(0.3, 1), random.between(0.1, 0.5));
  const double gap = (random.one_in(3) ? -1 : 1) * std::pow(10.0, -random.between(1, 12));
  const double radius = std::sqrt(half[0] * half[0] + half[1] * half[1]);
  pair.shape_a = Box{half};
  pair.a.angular_velocity = Vector3d(0, 0, pair.a.angular_velocity.norm());
  if (random.one_in(2)) {
    pair.shape_b = Box{Vector3d(0.25, 2, 2)};
    pair.b.path.coefficients[0] = Vector3d(radius + gap + 0.25, 0, 0);
  } else {
    const double x = radius + gap;
    const std::vector<Vector3d> corners{{x, -3, -2}, {x, 3, -2}, {x, 0, 4}};
    pair.shape_b = MeshShape{std::make_shared<const Mesh>(corners, std::vector<Mesh::Triangle>{{0, 1, 2}})};
  }
}

void make_moving(RandomPair& pair, Random& random, double rate) {
  const std::size_t family = pair.family;
  pair.shape_a = random_shape(random, family, true);
  pair.shape_b = random_shape(random, family, std::holds_alternative<Box>(pair.shape_a));
  const Vector3d from = family == along_axis || family == shared_axis ? Vector3d(Vector3d::UnitZ()) : direction(random);
  // On a lattice numbers agree exactly.
  const auto rounded = [&](const Vector3d& v) -> Vector3d {
    return family == parallel && random.one_in(2) ? Vector3d((4 * v).array().round() / 4) : v;
  };
  for (auto* motion : {&pair.a, &pair.b}) {
    const double side = motion == &pair.a ? -1 : 1;
    const Vector3d aside =
        family == along_axis || family == shared_axis ? Vector3d(Vector3d::Zero()) : direction(random);
    motion->path.coefficients[0] = rounded(side * random.between(0.8, 1.6) * from);
    motion->path.coefficients[1] = rounded(-side * random.between(0.5, 2) * from + 0.5 * aside);
    if (random.one_in(2)) motion->path.coefficients[2] = rounded(direction(random));
    if (family == shared_axis || family == along_axis) motion->path.coefficients[2] = Vector3d::Zero();
    motion->angular_velocity = rate * direction(random);
    if (family == parallel) motion->angular_velocity = rate * Vector3d::Unit(static_cast<int>(random.below(3)));
    if (family == shared_axis) motion->angular_velocity = Vector3d(0, 0, (random.one_in(2) ? 1 : -1) * rate);
    if (family == along_axis) motion->angular_velocity = Vector3d(0, 0, random.one_in(3) ? 0 : rate);
    if (family == one_still && motion == &pair.a) motion->angular_velocity = Vector3d::Zero();
    if (family != parallel && !(family == along_axis && random.one_in(2))) {
      motion->orientation.coeffs() =
          Eigen::Vector4d(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    }
  }
}

/// A capsule, thin or short, or as long as is wide; numbers of the lattice in the family that has one.
Capsule random_capsule(Random& random, std::size_t family) {
  if (family == parallel && random.one_in(2)) return {random.one_in(2) ? 0.25 : 0.5, random.one_in(2) ? 0.5 : 1.0};
  return {random.between(0.05, 0.5) * (random.one_in(4) ? 0.02 : 1), random.between(0.05, 1)};
}

/// A tetrahedron, or with its corners reflected a body of parallel edges and faces.
Shape random_hull(Random& random) {
  std::vector<Vector3d> points;
  for (int i = 0; i < 4; ++i) points.push_back(random.between(0.3, 1) * direction(random));
  if (random.one_in(2)) {
    for (std::size_t i = 0; i < 4; ++i) points.push_back(-points[i]);
  }
  return kds::collision::convex_hull(points);
}

/// In place of a box a capsule whose end goes round at the distance at which the corner of the box does.
void make_end_of_box(Shape& shape, kds::certificates::RigidMotion<2>& motion, Random& random) {
  const Vector3d half = std::get<Box>(shape).half_extents;
  const double half_diagonal = std::sqrt(half[0] * half[0] + half[1] * half[1]);
  const double radius = half_diagonal * random.between(0.05, 0.5);
  shape = Capsule{radius, half_diagonal - radius};
  motion.orientation = Eigen::Quaterniond(1, 1, 0, 0);  // across the axis about which it turns
}

/// Its end goes round past the plate at the distance at which the corner of the box did, or as deep.
void put_capsules(RandomPair& pair, Random& random) {
  if (pair.family == grazing) return make_end_of_box(pair.shape_a, pair.a, random);
  const bool both = random.one_in(2), first = random.one_in(2);
  if (both || first) pair.shape_a = random_capsule(random, pair.family);
  if (both || !first) pair.shape_b = random_capsule(random, pair.family);
  if (!both && random.one_in(3)) (first ? pair.shape_b : pair.shape_a) = random_hull(random);
}

/// Out of the half-space leads about the way on which b comes; in some families exactly along an axis.
void put_half_space(RandomPair& pair, Random& random) {
  Vector3d normal = pair.a.path.coefficients[1] - pair.b.path.coefficients[1];
  double offset = random.between(-0.5, 0.5);
  if (pair.family == grazing) {
    const auto* const mesh = std::get_if<MeshShape>(&pair.shape_b);
    const double from_axis = mesh ? mesh->mesh->vertices()[0][0] : pair.b.path.coefficients[0][0] - 0.25;
    pair.shape_b = pair.shape_a;
    std::swap(pair.a, pair.b);
    pair.a.path.coefficients[0] = Vector3d::Zero();
    normal = -Vector3d::UnitX(), offset = -from_axis;
  } else if (pair.family == linked) {
    normal = direction(random), offset = -random.between(0.8, 1.2);
    pair.b.path.coefficients[0] = Vector3d::Zero();
  } else if (pair.family == parallel) {
    int axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    normal = Vector3d(normal[axis] * Vector3d::Unit(axis)).normalized();
    offset = 0.25 * static_cast<double>(random.below(5)) - 0.5;
  } else if (pair.family == shared_axis || pair.family == along_axis) {
    normal = Vector3d::UnitZ();
  } else {
    normal = (normal.normalized() + 0.5 * direction(random)).normalized();
  }
  if (pair.family != grazing && random.one_in(2)) {
    if (random.one_in(2)) {
      pair.shape_b = random_capsule(random, pair.family);
    } else if (pair.family != linked) {
      pair.shape_b = random_hull(random);
    }
  }
  if (pair.family == grazing && random.one_in(2)) make_end_of_box(pair.shape_b, pair.b, random);
  pair.a.angular_velocity = Vector3d::Zero();
  pair.a.orientation = Eigen::Quaterniond::Identity();
  if (random.one_in(3) && pair.family != grazing && pair.family != parallel) {
    const Vector3d v = direction(random);
    pair.a.orientation = Eigen::Quaterniond(random.between(-1, 1), v[0], v[1], v[2]);
    normal = pair.a.orientation.normalized().conjugate() * normal;
    normal.normalize();
  }
  pair.shape_a = HalfSpace{normal, offset};
}

/// The shape, if it can be a part, and up to three more about it: near its middle, touching each other on a lattice, or
/// far from it. In the family "grazing" they do not reach farther from the axis; a plate is cut in two.
Shape with_more_parts(const Shape& shape, std::size_t family, Random& random) {
  std::vector<CompoundPart> parts;
  const auto* const box = std::get_if<Box>(&shape);
  if (family == grazing && box) {
    Vector3d half = box->half_extents;
    const int across = half[1] == 2 ? 1 : 2;
    half[across] /= 2;
    for (const double side : {-1.0, 1.0}) parts.push_back({Box{half}, side * half[across] * Vector3d::Unit(across)});
    if (across == 2) parts.push_back({Box{0.5 * half}, {0, 0, random.between(-2, 2)}});
    return kds::collision::compound(parts);
  }
  const bool can_be_part = box || std::holds_alternative<ConvexHull>(shape) || std::holds_alternative<MeshShape>(shape);
  if (family == linked || family == grazing) {
    return can_be_part ? Shape(kds::collision::compound(std::vector{CompoundPart{shape}})) : shape;
  }
  const double farthest = random.one_in(8) ? 8 : 1;
  if (can_be_part) {
    parts.push_back({shape, random.one_in(2) ? Vector3d(Vector3d::Zero()) : Vector3d(farthest * direction(random))});
  }
  const std::uint64_t more = 1 + random.below(3);
  for (std::uint64_t i = 0; i < more; ++i) {
    CompoundPart part{Box{Vector3d(0.25, 0.5, 0.25)}, farthest * random.between(0, 1) * direction(random)};
    if (family == parallel) {
      part.position = (2 * part.position).array().round() / 2;
    } else {
      part.shape =
          random.one_in(3) ? random_hull(random)
          : random.one_in(3)
              ? Shape(triangle(random, random.one_in(4)))
              : Shape(Box{Vector3d(random.between(0.05, 0.5), random.between(0.05, 0.5), random.between(0.05, 0.5))});
      if (random.one_in(2)) {
        const Vector3d v = direction(random);
        part.orientation = Eigen::Quaterniond(random.between(-1, 1), v[0], v[1], v[2]).normalized();
      }
    }
    parts.push_back(part);
  }
  return kds::collision::compound(parts);
}

/// One of the two is a compound, or both are; the other may be a half-space or a capsule.
void put_compounds(RandomPair& pair, Random& random) {
  if (random.one_in(5)) {
    put_half_space(pair, random);
    pair.shape_b = with_more_parts(pair.shape_b, pair.family, random);
    return;
  }
  pair.shape_a = with_more_parts(pair.shape_a, pair.family, random);
  if (random.one_in(6) && pair.family != grazing && pair.family != linked) {
    pair.shape_b = random_capsule(random, pair.family);
  } else if (random.one_in(2)) {
    pair.shape_b = with_more_parts(pair.shape_b, pair.family, random);
  }
}

}  // namespace

RandomPair make_pair(std::uint64_t seed, Kinds kinds) {
  Random random(seed);
  RandomPair pair;
  // Meshes of many triangles take the oracle a thousand times as long.
  pair.family = random.one_in(400) ? std::size_t{linked} : random.below(families);
  if (pair.family == linked && !random.one_in(40)) pair.family = random_pair;
  const double rate = random_rate(random);
  // At most some thousand radians.
  pair.horizon = std::min(1.0, 1000 / rate);
  for (auto* motion : {&pair.a, &pair.b}) {
    motion->path = {};
    motion->path.coefficients = {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
    motion->angular_velocity = rate * direction(random);
  }
  if (pair.family == grazing) {
    make_grazing(pair, random);
    pair.b.angular_velocity = Vector3d::Zero();
  } else if (pair.family == linked) {
    const MeshShape ring{kds::collision::samples::torus(5, 3)};
    pair.shape_a = pair.shape_b = ring;
    for (auto* motion : {&pair.a, &pair.b}) motion->path.coefficients[1] = 0.3 * direction(random);
    pair.b.path.coefficients[0] = Vector3d(0.75, 0, 0);
    pair.b.orientation = Eigen::Quaterniond(1, 1, 0, 0);
  } else {
    make_moving(pair, random, rate);
  }
  if (pair.family == far_past) {
    // There by about the time 0.
    for (auto* motion : {&pair.a, &pair.b}) {
      motion->path.start = -std::pow(10.0, random.between(0, 6));
      motion->path.coefficients[2] = Vector3d::Zero();
      motion->path.coefficients[0] += motion->path.start * motion->path.coefficients[1];
    }
  }
  if (kinds == Kinds::capsules) put_capsules(pair, random);
  if (kinds == Kinds::half_spaces) put_half_space(pair, random);
  if (kinds == Kinds::compounds) put_compounds(pair, random);
  pair.pieces_a = pieces_of(pair.shape_a);
  pair.pieces_b = pieces_of(pair.shape_b);
  return pair;
}

}  // namespace turning_pairs
