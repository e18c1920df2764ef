// Two oriented boxes around parts of bodies that turn: for how long they are apart, in floats.
#pragma once

#include "collision/lanes.hpp"
#include "collision/narrow_phase/turning/float_view.hpp"
#include "collision/narrow_phase/turning/turning_view.hpp"
#include "collision/shapes/obb_tree.hpp"
#include "collision/shapes/outer_points.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kds::collision {

/// What all nodes of a body have in common.
struct NodeUnits {
  double unit;      ///< their length in the world
  double round;     ///< by which they are grown on all sides
  double farthest;  ///< distance of the farthest of them from the origin of the body
};

/// The box of these half extents as a node. Its unit is half its diagonal.
inline ObbNode box_node(const Eigen::Vector3d& half) {
  ObbNode node{};
  for (std::size_t k = 0; k < 3; ++k) node.axes[k][k] = 1;
  if (const double length = norm(half); length > 0) node.half_extents = lanes(half / length), node.radius = 1;
  return node;
}
inline NodeUnits box_units(const Eigen::Vector3d& half) { return {norm(half), 0, norm(half) * (1 + 0x1p-50)}; }

/// Two bodies seen at one time, and what holds for all of their nodes.
///
/// All is in the axes of body a. Lengths are divided by `size`, how far the bodies' parts may be from each other now,
/// and times by `ahead`: up to a radian of both turns together, and no longer than the time in which the bodies come to
/// be elsewhere. So all numbers are of order 1, and floats suffice.
///
/// Margin. In roundings of a float, u = 2^-24: numbers that are converted are good to 1, so what is turned by the
/// matrix to 7, axes of nodes as they are to 4, and the corners of a node are in the box of these axes to 8 (ObbTree
/// grows nodes by 2^-20 of their unit for the products of exact axes). A gap is a product with the way (12), and with
/// three half edges of each of two boxes, which are together no longer than 3^(1/2) times the size (60); its rate, of
/// vectors that add up to 4 at most, 48, and twice the 60 for the chords; half of its bend, of vectors that add up to
/// 13 and are turned twice, 60. That is some 300; `rounding` has room for 512: 3e-5 of the size. A larger one leaves
/// more to the triangles. What is lost of the way in doubles is added.
template <int Degree>
struct NodesView : TurningView<Degree> {
  using TurningView<Degree>::seen_from_a;
  using RigidMotion = certificates::RigidMotion<Degree>;
  static constexpr double rounding = 512 * 0x1p-24;

  NodesView(const RigidMotion& a, const RigidMotion& b, const PairRates& rates, const NodeUnits& of_a,
            const NodeUnits& of_b, double t, double horizon)
      : TurningView<Degree>(a, b, rates, t),
        size(norm(this->way.value) + of_a.farthest + of_b.farthest),
        ahead(std::max(0.0, this->stretch(of_a.farthest + of_b.farthest, (horizon - t) * (1 + 0x1p-40)))) {
    const double s = ahead;
    const auto put = [&](float* three, const Eigen::Vector3d& x) {
      const Eigen::Vector3d in_a = this->seen_from_a(x);
      for (int d = 0; d < 3; ++d) three[d] = static_cast<float>(in_a[d]);
    };
    for (int k = 0; k < 3; ++k) put(floats.columns[k], this->matrix_b.col(k));
    put(floats.way_now, this->way.value / size);
    put(floats.way_rate, s * this->way.rate / size);
    put(floats.way_bend, s * (s * this->way.bend) / size);
    put(floats.turn_a, s * this->spin_a);
    put(floats.turn_b, s * this->spin_b);
    floats.unit_a = static_cast<float>(of_a.unit / size);
    floats.unit_b = static_cast<float>(of_b.unit / size);
    floats.round = static_cast<float>((of_a.round + of_b.round) / size);
    floats.angle_a = static_cast<float>(s * this->rate_a);
    floats.angle_b = static_cast<float>(s * this->rate_b);
    const double bend = norm(this->way.bend) * s * s / size;
    const double speed = (norm(this->way.rate) + this->rate_error) * s / size + bend;
    const double distance = (norm(this->way.value) + this->way_error) / size + speed;
    const auto third_of = [&](double angle_n) {
      return static_cast<float>(TurningBounds::third_of(angle_n, s * this->rate_a, s * this->rate_b,
                                                        {distance, speed, bend}, of_a.farthest / size,
                                                        of_b.farthest / size) *
                                (1 + 0x1p-20));
    };
    floats.third[0] = third_of(0), floats.third[1] = third_of(s * this->rate_a);
    floats.third[2] = third_of(s * this->rate_b);
    floats.third_of_products = third_of(s * (this->rate_a + this->rate_b));
    floats.margin = static_cast<float>((rounding + (this->way_error + this->rate_error * s) / size) * (1 + 0x1p-20));
  }

  double size;   ///< length
  double ahead;  ///< how far to look ahead, s
  FloatView floats;
};

/// The numbers of a node, as they are looked at.
inline const float* numbers_of(const ObbNode& node) {
  static_assert(sizeof(ObbNode::axes) == sizeof(float) * NodePlaces::centre && offsetof(ObbNode, axes) == 0 &&
                offsetof(ObbNode, centre) == sizeof(float) * NodePlaces::centre &&
                offsetof(ObbNode, half_extents) == sizeof(float) * NodePlaces::half_extents &&
                offsetof(ObbNode, radius) == sizeof(float) * NodePlaces::radius);
  return reinterpret_cast<const float*>(&node);
}

/// How long they are surely apart.
template <int Degree>
NodeWaits nodes_apart(const NodesView<Degree>& view, const NodesTogether& nodes) {
  NodeWaits waits{};
  if (!view.certain) return waits;
  find_node_waits(view.floats, nodes, waits);
  if (!(view.ahead > 0)) waits.worth_it = 0;
  return waits;
}

/// Whether they are surely farther apart than a margin at the time of the view: bit i of pair i.
template <int Degree>
unsigned nodes_apart_by(double margin, const NodesView<Degree>& view, const NodesTogether& nodes) {
  if (!view.certain) return 0;
  return find_nodes_apart_by(static_cast<float>(margin / view.size * (1 + 0x1p-20)), view.floats, nodes);
}

/// For how much of the time ahead a plane surely separates the two bodies, whose outer points are in their units.
template <int Degree>
float separated_part(const NodesView<Degree>& view, const OuterPoints& a, const OuterPoints& b,
                     const LooseTurns* loose = nullptr) {
  static_assert(OuterPoints::most == most_outer_points);
  if (!view.certain || !(view.ahead > 0)) return 0;
  const auto places = [](const OuterPoints& points) {
    return PointsTogether{points.x(), points.y(), points.z(), static_cast<int>(points.size())};
  };
  return find_separated_part(view.floats, places(a), places(b), loose);
}

/// A corner of a triangle in the units of a view, in four floats.
template <int Degree>
void put_corner(float* four, const NodesView<Degree>& view, const Eigen::Vector3d& corner) {
  const double scale = 1 / view.size;
  for (int d = 0; d < 3; ++d) four[d] = static_cast<float>(scale * corner[d]);
  four[3] = 0;
}

}  // namespace kds::collision
