// Two bodies that turn, seen at one time in floats: the numbers of which gaps of their parts are computed.
#pragma once

namespace kds::collision {

/// All vectors are in the axes of one body (a), in units in which they are of order 1: see NodesView, which makes it.
struct FloatView {
  float columns[3][3];                         ///< where the axes of b point
  float way_now[3], way_rate[3], way_bend[3];  ///< from the origin of a to that of b
  float turn_a[3], turn_b[3];                  ///< in the time ahead, as vectors
  float angle_a, angle_b;                      ///< their lengths
  float unit_a, unit_b, round;                 ///< of nodes
  float third[3];           ///< bounds on |f'''| of gaps: along a direction at rest, that turns with a, with b
  float third_of_products;  ///< the same along a product of vectors that turn with either
  float margin;             ///< that gaps may be off by
};

/// Up to how many pairs of nodes, or of triangles, are looked at together.
inline constexpr int most_together = 8;

/// Pairs of nodes: the numbers of each (ObbNode). Where there are less than eight the last one more than once.
struct NodesTogether {
  const float* a[most_together];
  const float* b[most_together];
  int count;
};

/// Places of numbers of a node, counted in floats.
struct NodePlaces {
  static constexpr int axes = 0, centre = 12, half_extents = 16, radius = 20;
};

/// How long two nodes are surely apart from the time of a view on, for each of some pairs.
struct NodeWaits {
  float part[most_together];  ///< of the time ahead
  unsigned worth_it;          ///< bit i: the pair gets near each other by then, for its size
};

/// Pairs of triangles: their corners about the origins of their bodies, in the axes of these, in the units of a view;
/// the fourth number does not count. Where there are less than eight the others are any numbers.
struct TrianglesTogether {
  alignas(16) float a[3][most_together][4], b[3][most_together][4];
  int count;
};

inline constexpr int most_outer_points = 64;
/// Points of a body whose convex hull holds it (OuterPoints), in the axes of the body, in units of nodes.
struct PointsTogether {
  const float *x, *y, *z;
  int count;  ///< a multiple of eight
};

/// Of bodies of which it is not known how exactly they turn: what is charged for that, of a and b, in the units of a
/// view. Their points are off by no more than the first; their velocities at the time of the view are off by no more
/// than the second; and as they turn they accelerate by no more than the third.
struct LooseTurns {
  float off[2], rate[2], bend[2];
};

/// Along the line between their centres, or along an axis of one of them that turns with it.
void find_node_waits(const FloatView& view, const NodesTogether& nodes, NodeWaits& waits);
/// Whether they are surely farther apart than a margin at the time of the view: bit i of pair i.
unsigned find_nodes_apart_by(float margin, const FloatView& view, const NodesTogether& nodes);
/// For how much of the time ahead triangles are surely apart.
void find_triangle_parts(const FloatView& view, const TrianglesTogether& triangles, float* parts);
/// For how much of the time ahead a plane is found that separates all of the two bodies. `loose`: null if they turn as
/// the view tells.
float find_separated_part(const FloatView& view, const PointsTogether& a, const PointsTogether& b,
                          const LooseTurns* loose = nullptr);

namespace detail {

/// The four functions above.
struct FloatGaps {
  void (*node_waits)(const FloatView&, const NodesTogether&, NodeWaits&);
  unsigned (*nodes_apart_by)(float margin, const FloatView&, const NodesTogether&);
  void (*triangle_parts)(const FloatView&, const TrianglesTogether&, float* parts);
  float (*separated_part)(const FloatView&, const PointsTogether& a, const PointsTogether& b, const LooseTurns* loose);
};
/// In registers of four floats.
extern const FloatGaps gaps_by_four;
/// In registers of eight, the same bits; null where the build or the processor has none.
const FloatGaps* gaps_by_eight();

/// For processors with AVX2 only.
void find_node_waits_by_eight(const FloatView& view, const NodesTogether& nodes, NodeWaits& waits);
unsigned find_nodes_apart_by_eight(float margin, const FloatView& view, const NodesTogether& nodes);
void find_triangle_parts_by_eight(const FloatView& view, const TrianglesTogether& triangles, float* parts);
float find_separated_part_by_eight(const FloatView& view, const PointsTogether& a, const PointsTogether& b,
                                   const LooseTurns* loose);

}  // namespace detail
}  // namespace kds::collision
