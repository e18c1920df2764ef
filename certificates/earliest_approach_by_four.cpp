// Compiled for processors with AVX2, whatever the rest is compiled for: see kds/simd/four_wide.hpp for the rules of
// such a file.
#include "certificates/earliest_approach.hpp"

#ifdef __AVX2__

namespace kds::certificates::detail {
namespace {

/// Four doubles of a ball in a row.
[[gnu::always_inline]] inline Four four_of(const std::byte* ball, int from) {
  Four x;
  __builtin_memcpy(&x, ball + from * static_cast<int>(sizeof(double)), sizeof x);
  return x;
}

}  // namespace

template <int PathDegree>
[[gnu::always_inline]] inline void read(const std::byte* const* balls, BallNumbers<Four, PathDegree>& numbers) {
  constexpr int count = 3 * (PathDegree + 1) + 2;
  Four all[count];
  for (int from = 0; from < count; from += 4) {
    const int begin = from + 4 <= count ? from : count - 4;  // the last four may overlap those before
    Four places[4];
    transpose(four_of(balls[0], begin), four_of(balls[1], begin), four_of(balls[2], begin), four_of(balls[3], begin),
              places);
    for (int i = 0; i < 4; ++i) all[begin + i] = places[i];
  }
  for (int k = 0; k <= PathDegree; ++k) {
    for (int d = 0; d < 3; ++d) numbers.motion.coefficients[k][d] = all[3 * k + d];
  }
  numbers.motion.start = all[count - 2];
  numbers.radius = all[count - 1];
}

template <int PathDegree>
void find_approaches_by_four(const FourPairs& pairs, double now, double horizon, double* earliest) {
  find_approaches_in<Four, PathDegree>(pairs, now, horizon, earliest);
}

template void find_approaches_by_four<1>(const FourPairs&, double, double, double*);
template void find_approaches_by_four<2>(const FourPairs&, double, double, double*);

}  // namespace kds::certificates::detail

#endif
