#include "collision/narrow_phase/narrow_phase.hpp"

#include "certificates/turning/rigid_motion.hpp"
#include "collision/body_motion.hpp"
#include "collision/motions.hpp"
#include "collision/narrow_phase/bending_contact.hpp"
#include "collision/narrow_phase/capsule_contact.hpp"
#include "collision/narrow_phase/compound_contact.hpp"
#include "collision/narrow_phase/convex_contact.hpp"
#include "collision/narrow_phase/half_space_and_bending_mesh.hpp"
#include "collision/narrow_phase/half_space_contact.hpp"
#include "collision/narrow_phase/hull_contact.hpp"
#include "collision/narrow_phase/mesh_and_hull.hpp"
#include "collision/narrow_phase/mesh_contact.hpp"
#include "collision/narrow_phase/pair_tests.hpp"
#include "collision/narrow_phase/turning/turning_contact.hpp"
#include "collision/narrow_phase/turning/turning_mesh_contact.hpp"
#include "collision/shapes/shape_kinds.hpp"

#include <algorithm>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

namespace kds::collision {
namespace {

template <class Kind>
using FormOf = std::decay_t<decltype(form_of(detail::ShapeKind<Kind>{}, std::declval<const Kind&>()))>;
/// Whether the shapes of a kind are convex solids, which have a ConvexCore.
template <class Kind>
constexpr bool has_core = std::is_same_v<FormOf<Kind>, RoundedBox> || std::is_same_v<FormOf<Kind>, Polytope>;

/// Balls, boxes, capsules and hulls, in the order of Shape.
constexpr auto solids = []<class... Kinds>(std::type_identity<std::variant<Kinds...>>) {
  return (KindList<>{} + ... + std::conditional_t<has_core<Kinds>, KindList<Kinds>, KindList<>>{});
}(std::type_identity<Shape>{});

/// The rows that are the same however bodies move.
template <class Motion>
constexpr void add_rows_of_all_motions(PairTable<Motion>& table) {
  table.template add<HalfSpace, HalfSpace>(HalfSpacesContact<Motion>{});
  using CompoundTests = CompoundContact<Motion>;
  table.template add<Compound>(solids + KindList<MeshShape, HalfSpace, Compound>{}, CompoundTests{});
  if constexpr (Motion::degree <= 2) {
    table.template add<BendingMesh>(solids + KindList<MeshShape, BendingMesh>{}, BendingContact<Motion>{});
    table.template add<HalfSpace, BendingMesh>(HalfSpaceAndBendingMesh<Motion>{});
    table.template add<Compound, BendingMesh>(CompoundTests{});
  }
}

/// The general tests first, then those of particular kinds.
template <int Degree>
constexpr PairTable<certificates::PointMotion<Degree>> translating_table() {
  PairTable<certificates::PointMotion<Degree>> table;
  add_rows_of_all_motions(table);
  table.add_among(solids, HullContact<Degree>{});
  table.template add<HalfSpace>(solids + KindList<MeshShape>{}, HalfSpaceContact<Degree>{});
  table.template add<Sphere, Sphere>(BallsContact<Degree>{});
  table.template add<Box, Sphere>(BoxBallContact<Degree>{});
  table.template add<Box, Box>(BoxesContact<Degree>{});
  table.template add<Capsule, Sphere, Box, Capsule>(CapsuleContact<Degree>{});
  table.template add<MeshShape, Sphere, Box, Capsule, MeshShape>(MeshContact<Degree>{});
  table.template add<MeshShape, ConvexHull>(MeshHullContact<Degree>{});
  return table;
}

/// Of bodies that turn. What bends keeps its orientation.
template <int Degree>
constexpr PairTable<certificates::RigidMotion<Degree>> turning_table() {
  PairTable<certificates::RigidMotion<Degree>> table;
  add_rows_of_all_motions(table);
  table.add_among(solids, TurningContact<Degree>{});
  table.template add<HalfSpace>(solids + KindList<MeshShape>{}, TurningContact<Degree>{});
  table.template add<MeshShape, Sphere, Box, Capsule, ConvexHull, MeshShape>(TurningMeshContact<Degree>{});
  return table;
}

template <class Motion>
constexpr PairTable<Motion> make_table() {
  if constexpr (turns<Motion>) {
    return turning_table<Motion::degree>();
  } else {
    return translating_table<Motion::degree>();
  }
}

template <class Motion>
constexpr PairTable<Motion> table = make_table<Motion>();

/// How far ahead of t0 exact tests look. Bodies that turn may come near each other again and again, so a search to the
/// end of time would not end.
template <class Motion>
double end_of_search(const MovingShape<Motion>& a, const MovingShape<Motion>& b, double t0, double horizon) {
  if constexpr (turns<Motion>) {
    if (turning_counts(a.shape, b.shape)) return std::min(horizon, t0 + time_to_look_ahead(a.motion, b.motion));
  }
  return horizon;
}

/// Calls ask(a, b) with the motions as they are, or of the least degree from 2 on that both have: what is asked of them
/// is then answered as in a world of that degree, bit for bit, and by its quicker tests.
template <class Motion, class Ask>
auto in_least_degree(const MovingShape<Motion>& a, const MovingShape<Motion>& b, const Ask& ask) {
  constexpr int degree = Motion::degree;
  if constexpr (!turns<Motion> && degree >= 3) {
    if (a.motion.coefficients[degree].isZero(0) && b.motion.coefficients[degree].isZero(0)) {
      const auto motion_a = without_last(a.motion);
      const auto motion_b = without_last(b.motion);
      return in_least_degree(TranslatingShape<degree - 1>{a.shape, motion_a},
                             TranslatingShape<degree - 1>{b.shape, motion_b}, ask);
    }
  }
  return ask(a, b);
}

}  // namespace

template <class Motion>
const PairTests<Motion>& pair_tests(const PlacedShape& a, const PlacedShape& b) {
  return table<Motion>.of(a.shape.index(), b.shape.index());
}

template <class Motion>
bool can_move_by(const Shape& shape) {
  return table<Motion>.has(shape.index());
}

template <class Motion>
double first_contact(const MovingShape<Motion>& a, const MovingShape<Motion>& b, double t0, double horizon,
                     ContactMode mode, FoundTouch* found) {
  return in_least_degree(a, b, [&]<class M>(const MovingShape<M>& x, const MovingShape<M>& y) {
    return pair_tests<M>(x.shape, y.shape).first_contact(x, y, t0, horizon, mode, found);
  });
}

namespace {

/// As certified_first_contact, by exact signs from the first instant on. `estimate`: an earlier time will do.
template <class Motion>
ContactEstimate sought_first_contact(const MovingShape<Motion>& a, const MovingShape<Motion>& b, double t0,
                                     double horizon, ContactMode mode, FoundTouch* found, bool estimate) {
  const PairTests<Motion>& tests = pair_tests<Motion>(a.shape, b.shape);
  const double end = end_of_search(a, b, t0, horizon);
  const ContactEstimate next = tests.estimated_contact
                                   ? tests.estimated_contact(a, b, t0, end, horizon, mode, estimate)
                                   : ContactEstimate{first_contact(a, b, t0, end, mode, found), true};
  if (next.time == never && !next.exact) return {never, true};  // up to the horizon
  return next.time == never && end < horizon ? ContactEstimate{end, false} : next;
}

/// The estimate that a proof makes which has got as far as `apart`; none where it tells nothing.
std::optional<ContactEstimate> estimate_of(double apart, double t0, double horizon) {
  if (apart > horizon) return ContactEstimate{never, true};
  if (apart > t0) return ContactEstimate{apart, false};
  return std::nullopt;
}

}  // namespace

template <class Motion>
ContactEstimate certified_first_contact(const MovingShape<Motion>& a, const MovingShape<Motion>& b, double t0,
                                        double horizon, ContactMode mode, FoundTouch* found) {
  if constexpr (turns<Motion>) {
    PairMemory memory;
    const double apart = pair_tests<Motion>(a.shape, b.shape).apart_until(a, b, t0, horizon, memory);
    if (const auto estimate = estimate_of(apart, t0, horizon)) return *estimate;
  }
  return sought_first_contact(a, b, t0, horizon, mode, found, false);
}

template <class Motion>
ContactEstimate certified_first_separation(const MovingShape<Motion>& a, const MovingShape<Motion>& b, double t0,
                                           double horizon) {
  const double end = end_of_search(a, b, t0, horizon);
  const double time = first_separation(a, b, t0, end);
  return time == never && end < horizon ? ContactEstimate{end, false} : ContactEstimate{time, true};
}

template <class Motion>
ContactEstimate estimated_first_contact(const MovingShape<Motion>& a, const MovingShape<Motion>& b, double t0,
                                        double horizon, ContactMode mode, PairMemory& memory, FoundTouch* found) {
  return in_least_degree(a, b, [&]<class M>(const MovingShape<M>& x, const MovingShape<M>& y) -> ContactEstimate {
    const PairTests<M>& tests = pair_tests<M>(x.shape, y.shape);
    if (const auto estimate = estimate_of(tests.apart_until(x, y, t0, horizon, memory), t0, horizon)) return *estimate;
    return sought_first_contact(x, y, t0, horizon, mode, found, true);
  });
}

template <class Motion>
bool in_contact(const MovingShape<Motion>& a, const MovingShape<Motion>& b, double t) {
  return in_least_degree(a, b, [&]<class M>(const MovingShape<M>& x, const MovingShape<M>& y) {
    return pair_tests<M>(x.shape, y.shape).in_contact(x, y, t);
  });
}

template <class Motion>
double first_separation(const MovingShape<Motion>& a, const MovingShape<Motion>& b, double t0, double horizon) {
  return in_least_degree(a, b, [&]<class M>(const MovingShape<M>& x, const MovingShape<M>& y) {
    return pair_tests<M>(x.shape, y.shape).first_separation(x, y, t0, horizon);
  });
}

template <class Motion>
Contact contact_at(const MovingShape<Motion>& a, const MovingShape<Motion>& b, double t, const FoundTouch& found) {
  return in_least_degree(a, b, [&]<class M>(const MovingShape<M>& x, const MovingShape<M>& y) {
    return pair_tests<M>(x.shape, y.shape).contact_at(x, y, t, found);
  });
}

#define KDS_INSTANTIATE(motion)                                                                                       \
  static_assert(motion::degree > 2 || table<motion>.complete());                                                      \
  template const PairTests<motion>& pair_tests(const PlacedShape&, const PlacedShape&);                               \
  template bool can_move_by<motion>(const Shape&);                                                                    \
  template double first_contact(const MovingShape<motion>&, const MovingShape<motion>&, double, double, ContactMode,  \
                                FoundTouch*);                                                                         \
  template ContactEstimate estimated_first_contact(const MovingShape<motion>&, const MovingShape<motion>&, double,    \
                                                   double, ContactMode, PairMemory&, FoundTouch*);                    \
  template ContactEstimate certified_first_contact(const MovingShape<motion>&, const MovingShape<motion>&, double,    \
                                                   double, ContactMode, FoundTouch*);                                 \
  template ContactEstimate certified_first_separation(const MovingShape<motion>&, const MovingShape<motion>&, double, \
                                                      double);                                                        \
  template bool in_contact(const MovingShape<motion>&, const MovingShape<motion>&, double);                           \
  template double first_separation(const MovingShape<motion>&, const MovingShape<motion>&, double, double);           \
  template Contact contact_at(const MovingShape<motion>&, const MovingShape<motion>&, double, const FoundTouch&);
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
