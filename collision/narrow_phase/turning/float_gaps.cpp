// Gaps of nodes and triangles, in registers of eight floats where the build and the processor have them, else of four.
#include "collision/narrow_phase/turning/float_node_gaps.hpp"
#include "collision/narrow_phase/turning/float_separation.hpp"
#include "collision/narrow_phase/turning/float_triangle_gaps.hpp"

namespace kds::collision {
namespace detail {
namespace {

constexpr int width = lanes_of_floats<FourFloats>;

void find_node_waits_by_four(const FloatView& view, const NodesTogether& nodes, NodeWaits& waits) {
  waits.worth_it = 0;
  for (int first = 0; first < nodes.count; first += width) {
    unsigned worth_it = 0;
    NodeGaps<FourFloats>(view, nodes.a + first, nodes.b + first).find_waits(waits.part + first, worth_it);
    waits.worth_it |= worth_it << first;
  }
}

unsigned find_nodes_apart_by_four(float margin, const FloatView& view, const NodesTogether& nodes) {
  unsigned apart = 0;
  for (int first = 0; first < nodes.count; first += width) {
    apart |= NodeGaps<FourFloats>(view, nodes.a + first, nodes.b + first).exceed(margin) << first;
  }
  return apart;
}

void find_triangle_parts_by_four(const FloatView& view, const TrianglesTogether& triangles, float* parts) {
  for (int first = 0; first < triangles.count; first += width) {
    const FourFloats found = TriangleGaps<FourFloats>(view, triangles, first).parts();
    __builtin_memcpy(parts + first, &found, sizeof found);
  }
}

float find_separated_part_by_four(const FloatView& view, const PointsTogether& a, const PointsTogether& b,
                                  const LooseTurns* loose) {
  return PlaneBetween<FourFloats>(view, a, b).part(loose);
}

}  // namespace

const FloatGaps gaps_by_four{find_node_waits_by_four, find_nodes_apart_by_four, find_triangle_parts_by_four,
                             find_separated_part_by_four};

#ifdef KDS_BUILT_FOR_AVX2_TOO
const FloatGaps* gaps_by_eight() {
  static constexpr FloatGaps gaps{find_node_waits_by_eight, find_nodes_apart_by_eight, find_triangle_parts_by_eight,
                                  find_separated_part_by_eight};
  return __builtin_cpu_supports("avx2") ? &gaps : nullptr;
}
#else
const FloatGaps* gaps_by_eight() { return nullptr; }
#endif

}  // namespace detail

namespace {

const detail::FloatGaps& gaps() {
  static const detail::FloatGaps* const by_eight = detail::gaps_by_eight();
  return by_eight ? *by_eight : detail::gaps_by_four;
}

}  // namespace

void find_node_waits(const FloatView& view, const NodesTogether& nodes, NodeWaits& waits) {
  gaps().node_waits(view, nodes, waits);
}
unsigned find_nodes_apart_by(float margin, const FloatView& view, const NodesTogether& nodes) {
  return gaps().nodes_apart_by(margin, view, nodes);
}
void find_triangle_parts(const FloatView& view, const TrianglesTogether& triangles, float* parts) {
  gaps().triangle_parts(view, triangles, parts);
}
float find_separated_part(const FloatView& view, const PointsTogether& a, const PointsTogether& b,
                          const LooseTurns* loose) {
  return gaps().separated_part(view, a, b, loose);
}

}  // namespace kds::collision
