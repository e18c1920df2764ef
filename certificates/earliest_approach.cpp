#include "certificates/earliest_approach.hpp"

namespace kds::certificates::detail {

template <int PathDegree>
void find_approaches_by_two(const FourPairs& pairs, double now, double horizon, double* earliest) {
  find_approaches_in<Two, PathDegree>(pairs, now, horizon, earliest);
}

#ifdef KDS_BUILT_FOR_AVX2_TOO
namespace {
const bool has_registers_of_four = __builtin_cpu_supports("avx2");
}

template <int PathDegree>
void find_approaches(const FourPairs& pairs, double now, double horizon, double* earliest) {
  return has_registers_of_four ? find_approaches_by_four<PathDegree>(pairs, now, horizon, earliest)
                               : find_approaches_by_two<PathDegree>(pairs, now, horizon, earliest);
}
#else
template <int PathDegree>
void find_approaches(const FourPairs& pairs, double now, double horizon, double* earliest) {
  find_approaches_by_two<PathDegree>(pairs, now, horizon, earliest);
}
#endif

template void find_approaches_by_two<1>(const FourPairs&, double, double, double*);
template void find_approaches_by_two<2>(const FourPairs&, double, double, double*);
template void find_approaches<1>(const FourPairs&, double, double, double*);
template void find_approaches<2>(const FourPairs&, double, double, double*);

}  // namespace kds::certificates::detail
