#include "collision/narrow_phase/narrow_phase.hpp"

#include "collision/degrees.hpp"
#include "collision/narrow_phase/capsule_contact.hpp"
#include "collision/narrow_phase/convex_contact.hpp"
#include "collision/narrow_phase/mesh_contact.hpp"
#include "collision/narrow_phase/pair_tests.hpp"

namespace kds::collision {
namespace {

/// A row for each kind of shape: what tests it against itself and the kinds above it.
template <int Degree>
constexpr PairTable<Degree> make_table() {
  PairTable<Degree> table;
  table.template add<Sphere, Sphere>(BallsContact<Degree>{});
  table.template add<Box, Sphere>(BoxBallContact<Degree>{});
  table.template add<Box, Box>(BoxesContact<Degree>{});
  table.template add<Capsule, Sphere, Box, Capsule>(CapsuleContact<Degree>{});
  table.template add<MeshShape, Sphere, Box, Capsule, MeshShape>(MeshContact<Degree>{});
  return table;
}

template <int Degree>
constexpr PairTable<Degree> table = make_table<Degree>();

/// Calls ask(a, b) with the motions as they are, or of the least degree from 2 on that both have: what is asked of them
/// is then answered as in a world of that degree, bit for bit, and by its quicker tests.
template <int Degree, class Ask>
auto in_least_degree(const MovingShape<Degree>& a, const MovingShape<Degree>& b, const Ask& ask) {
  if constexpr (Degree >= 3) {
    if (a.motion.coefficients[Degree].isZero(0) && b.motion.coefficients[Degree].isZero(0)) {
      const auto motion_a = without_last(a.motion);
      const auto motion_b = without_last(b.motion);
      return in_least_degree(MovingShape<Degree - 1>{a.shape, motion_a}, MovingShape<Degree - 1>{b.shape, motion_b},
                             ask);
    }
  }
  return ask(a, b);
}

}  // namespace

template <int Degree>
const PairTests<Degree>& pair_tests(const PlacedShape& a, const PlacedShape& b) {
  return table<Degree>.of(a.shape.index(), b.shape.index());
}

template <int Degree>
double first_contact(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t0, double horizon,
                     ContactMode mode, FoundTouch* found) {
  return in_least_degree(a, b, [&]<int D>(const MovingShape<D>& x, const MovingShape<D>& y) {
    return pair_tests<D>(x.shape, y.shape).first_contact(x, y, t0, horizon, mode, found);
  });
}

template <int Degree>
ContactEstimate estimated_first_contact(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t0,
                                        double horizon, ContactMode mode, PairMemory& memory, FoundTouch* found) {
  return in_least_degree(a, b, [&]<int D>(const MovingShape<D>& x, const MovingShape<D>& y) -> ContactEstimate {
    const PairTests<D>& tests = pair_tests<D>(x.shape, y.shape);
    const double time = tests.apart_until(x, y, t0, horizon, memory);
    if (time == never || time > horizon) return {never, true};
    if (time > t0) return {time, false};
    return {tests.first_contact(x, y, t0, horizon, mode, found), true};
  });
}

template <int Degree>
bool in_contact(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t) {
  return in_least_degree(a, b, [&]<int D>(const MovingShape<D>& x, const MovingShape<D>& y) {
    return pair_tests<D>(x.shape, y.shape).in_contact(x, y, t);
  });
}

template <int Degree>
double first_separation(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t0, double horizon) {
  return in_least_degree(a, b, [&]<int D>(const MovingShape<D>& x, const MovingShape<D>& y) {
    return pair_tests<D>(x.shape, y.shape).first_separation(x, y, t0, horizon);
  });
}

template <int Degree>
Contact contact_at(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t, const FoundTouch& found) {
  return in_least_degree(a, b, [&]<int D>(const MovingShape<D>& x, const MovingShape<D>& y) {
    return pair_tests<D>(x.shape, y.shape).contact_at(x, y, t, found);
  });
}

#define KDS_INSTANTIATE(degree)                                                                                      \
  static_assert(table<degree>.complete());                                                                           \
  template const PairTests<degree>& pair_tests(const PlacedShape&, const PlacedShape&);                              \
  template double first_contact(const MovingShape<degree>&, const MovingShape<degree>&, double, double, ContactMode, \
                                FoundTouch*);                                                                        \
  template ContactEstimate estimated_first_contact(const MovingShape<degree>&, const MovingShape<degree>&, double,   \
                                                   double, ContactMode, PairMemory&, FoundTouch*);                   \
  template bool in_contact(const MovingShape<degree>&, const MovingShape<degree>&, double);                          \
  template double first_separation(const MovingShape<degree>&, const MovingShape<degree>&, double, double);          \
  template Contact contact_at(const MovingShape<degree>&, const MovingShape<degree>&, double, const FoundTouch&);
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
