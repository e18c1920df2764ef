// Compiled for processors with AVX2, whatever the rest is compiled for: see kds/simd/four_wide.hpp for the rules of
// such a file.
#include "kds/simd/eight_wide.hpp"

#ifdef __AVX2__

#include "collision/narrow_phase/turning/float_node_gaps.hpp"
#include "collision/narrow_phase/turning/float_separation.hpp"
#include "collision/narrow_phase/turning/float_triangle_gaps.hpp"

namespace kds::collision::detail {

void find_node_waits_by_eight(const FloatView& view, const NodesTogether& nodes, NodeWaits& waits) {
  NodeGaps<EightFloats>(view, nodes.a, nodes.b).find_waits(waits.part, waits.worth_it);
}

unsigned find_nodes_apart_by_eight(float margin, const FloatView& view, const NodesTogether& nodes) {
  return NodeGaps<EightFloats>(view, nodes.a, nodes.b).exceed(margin);
}

void find_triangle_parts_by_eight(const FloatView& view, const TrianglesTogether& triangles, float* parts) {
  const EightFloats found = TriangleGaps<EightFloats>(view, triangles, 0).parts();
  __builtin_memcpy(parts, &found, sizeof found);
}

float find_separated_part_by_eight(const FloatView& view, const PointsTogether& a, const PointsTogether& b,
                                   const LooseTurns* loose) {
  return PlaneBetween<EightFloats>(view, a, b).part(loose);
}

}  // namespace kds::collision::detail

#endif
