// Gaps of nodes and triangles, in registers of eight floats where the build and the processor have them, else of four.
#include "collision/narrow_phase/turning/float_node_gaps.hpp"
#include "collision/narrow_phase/turning/float_triangle_gaps.hpp"

namespace kds::collision {
namespace {

#ifdef KDS_BUILT_FOR_AVX2_TOO
const bool by_eight = __builtin_cpu_supports("avx2");
#else
constexpr bool by_eight = false;
#endif

constexpr int width = lanes_of_floats<FourFloats>;

}  // namespace

void find_node_waits(const FloatView& view, const NodesTogether& nodes, NodeWaits& waits) {
#ifdef KDS_BUILT_FOR_AVX2_TOO
  if (by_eight) return detail::find_node_waits_by_eight(view, nodes, waits);
#endif
  waits.worth_it = 0;
  for (int first = 0; first < nodes.count; first += width) {
    unsigned worth_it = 0;
    detail::NodeGaps<FourFloats>(view, nodes.a + first, nodes.b + first).find_waits(waits.part + first, worth_it);
    waits.worth_it |= worth_it << first;
  }
}

unsigned find_nodes_apart_by(float margin, const FloatView& view, const NodesTogether& nodes) {
#ifdef KDS_BUILT_FOR_AVX2_TOO
  if (by_eight) return detail::find_nodes_apart_by_eight(margin, view, nodes);
#endif
  unsigned apart = 0;
  for (int first = 0; first < nodes.count; first += width) {
    apart |= detail::NodeGaps<FourFloats>(view, nodes.a + first, nodes.b + first).exceed(margin) << first;
  }
  return apart;
}

void find_triangle_parts(const FloatView& view, const TrianglesTogether& triangles, float* parts) {
#ifdef KDS_BUILT_FOR_AVX2_TOO
  if (by_eight) return detail::find_triangle_parts_by_eight(view, triangles, parts);
#endif
  for (int first = 0; first < triangles.count; first += width) {
    const FourFloats found = detail::TriangleGaps<FourFloats>(view, triangles, first).parts();
    __builtin_memcpy(parts + first, &found, sizeof found);
  }
}

}  // namespace kds::collision
