#include "collision/deforming/surface_contact.hpp"

#include "collision/deforming/surface_search.hpp"

#include <algorithm>
#include <tuple>

namespace kds::collision {
namespace {

/// Of contacts at one time the lowest features come first.
bool comes_before(const SurfaceContact& x, const SurfaceContact& y) {
  if (x.contact.time != y.contact.time) return x.contact.time < y.contact.time;
  return std::tie(x.contact.feature_a, x.contact.feature_b, x.kind, x.vertices) <
         std::tie(y.contact.feature_a, y.contact.feature_b, y.kind, y.vertices);
}

template <int Degree>
std::optional<SurfaceContact> first_of(const SurfaceSearch<Degree>& search) {
  std::optional<SurfaceContact> first;
  search.earliest_first([&](const SurfaceContact& found) {
    if (!first || comes_before(found, *first)) first = found;
    return first->contact.time;
  });
  return first;
}

template <int Degree>
std::vector<SurfaceContact> all_of(const SurfaceSearch<Degree>& search) {
  std::vector<SurfaceContact> all;
  search.all([&](const SurfaceContact& found) { all.push_back(found); });
  std::stable_sort(all.begin(), all.end(), comes_before);
  return all;
}

}  // namespace

template <int Degree>
std::optional<SurfaceContact> first_contact(const MovingSurface<Degree>& a, const MovingSurface<Degree>& b,
                                            const SurfaceQuery& query) {
  return first_of(SurfaceSearch<Degree>(a, b, query));
}

template <int Degree>
std::vector<SurfaceContact> all_contacts(const MovingSurface<Degree>& a, const MovingSurface<Degree>& b,
                                         const SurfaceQuery& query) {
  return all_of(SurfaceSearch<Degree>(a, b, query));
}

template <int Degree>
std::optional<SurfaceContact> first_self_contact(const MovingSurface<Degree>& surface, const SurfaceQuery& query) {
  return first_of(SurfaceSearch<Degree>(surface, query));
}

template <int Degree>
std::vector<SurfaceContact> all_self_contacts(const MovingSurface<Degree>& surface, const SurfaceQuery& query) {
  return all_of(SurfaceSearch<Degree>(surface, query));
}

#define KDS_INSTANTIATE(degree)                                                                                    \
  template std::optional<SurfaceContact> first_contact(const MovingSurface<degree>&, const MovingSurface<degree>&, \
                                                       const SurfaceQuery&);                                       \
  template std::vector<SurfaceContact> all_contacts(const MovingSurface<degree>&, const MovingSurface<degree>&,    \
                                                    const SurfaceQuery&);                                          \
  template std::optional<SurfaceContact> first_self_contact(const MovingSurface<degree>&, const SurfaceQuery&);    \
  template std::vector<SurfaceContact> all_self_contacts(const MovingSurface<degree>&, const SurfaceQuery&);
KDS_INSTANTIATE(1)
KDS_INSTANTIATE(2)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
