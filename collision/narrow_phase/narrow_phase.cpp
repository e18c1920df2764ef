#include "collision/narrow_phase/narrow_phase.hpp"

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

static_assert(table<1>.complete() && table<2>.complete());

}  // namespace

template <int Degree>
const PairTests<Degree>& pair_tests(const PlacedShape& a, const PlacedShape& b) {
  return table<Degree>.of(a.shape.index(), b.shape.index());
}

template <int Degree>
double first_contact(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t0, double horizon,
                     ContactMode mode, FoundTouch* found) {
  return pair_tests<Degree>(a.shape, b.shape).first_contact(a, b, t0, horizon, mode, found);
}

template <int Degree>
ContactEstimate estimated_first_contact(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t0,
                                        double horizon, ContactMode mode, PairMemory& memory, FoundTouch* found) {
  const PairTests<Degree>& tests = pair_tests<Degree>(a.shape, b.shape);
  const double time = tests.apart_until(a, b, t0, horizon, memory);
  if (time == never || time > horizon) return {never, true};
  if (time > t0) return {time, false};
  return {tests.first_contact(a, b, t0, horizon, mode, found), true};
}

template <int Degree>
bool in_contact(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t) {
  return pair_tests<Degree>(a.shape, b.shape).in_contact(a, b, t);
}

template <int Degree>
double first_separation(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t0, double horizon) {
  return pair_tests<Degree>(a.shape, b.shape).first_separation(a, b, t0, horizon);
}

template <int Degree>
Contact contact_at(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t, const FoundTouch& found) {
  return pair_tests<Degree>(a.shape, b.shape).contact_at(a, b, t, found);
}

template const PairTests<1>& pair_tests(const PlacedShape&, const PlacedShape&);
template const PairTests<2>& pair_tests(const PlacedShape&, const PlacedShape&);
template double first_contact(const MovingShape<1>&, const MovingShape<1>&, double, double, ContactMode, FoundTouch*);
template double first_contact(const MovingShape<2>&, const MovingShape<2>&, double, double, ContactMode, FoundTouch*);
template ContactEstimate estimated_first_contact(const MovingShape<1>&, const MovingShape<1>&, double, double,
                                                 ContactMode, PairMemory&, FoundTouch*);
template ContactEstimate estimated_first_contact(const MovingShape<2>&, const MovingShape<2>&, double, double,
                                                 ContactMode, PairMemory&, FoundTouch*);
template bool in_contact(const MovingShape<1>&, const MovingShape<1>&, double);
template bool in_contact(const MovingShape<2>&, const MovingShape<2>&, double);
template double first_separation(const MovingShape<1>&, const MovingShape<1>&, double, double);
template double first_separation(const MovingShape<2>&, const MovingShape<2>&, double, double);
template Contact contact_at(const MovingShape<1>&, const MovingShape<1>&, double, const FoundTouch&);
template Contact contact_at(const MovingShape<2>&, const MovingShape<2>&, double, const FoundTouch&);

}  // namespace kds::collision
