#include "collision/narrow_phase/narrow_phase.hpp"

#include "collision/narrow_phase/convex_contact.hpp"
#include "collision/narrow_phase/mesh_contact.hpp"

namespace kds::collision {
namespace {

template <int Degree>
bool has_mesh(const MovingShape<Degree>& a, const MovingShape<Degree>& b) {
  return std::holds_alternative<MeshShape>(a.shape.shape) || std::holds_alternative<MeshShape>(b.shape.shape);
}

}  // namespace

template <int Degree>
double first_contact(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t0, double horizon,
                     ContactMode mode, FoundTouch* found) {
  return has_mesh(a, b) ? MeshContact<Degree>::first_contact(a, b, t0, horizon, mode, found)
                        : ConvexContact<Degree>::first_contact(a, b, t0, horizon, mode);
}

template <int Degree>
ContactEstimate estimated_first_contact(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t0,
                                        double horizon, ContactMode mode, PairMemory& memory, FoundTouch* found) {
  const double time = has_mesh(a, b) ? MeshContact<Degree>::apart_until(a, b, t0, horizon)
                                     : ConvexContact<Degree>::apart_until(a, b, t0, horizon, memory);
  if (time == never || time > horizon) return {never, true};
  if (time > t0) return {time, false};
  return {first_contact(a, b, t0, horizon, mode, found), true};
}

template <int Degree>
bool in_contact(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t) {
  return has_mesh(a, b) ? MeshContact<Degree>::in_contact(a, b, t) : ConvexContact<Degree>::in_contact(a, b, t);
}

template <int Degree>
double first_separation(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t0, double horizon) {
  return has_mesh(a, b) ? MeshContact<Degree>::first_separation(a, b, t0, horizon)
                        : ConvexContact<Degree>::first_separation(a, b, t0, horizon);
}

template <int Degree>
Contact contact_at(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t, const FoundTouch& found) {
  return has_mesh(a, b) ? MeshContact<Degree>::contact_at(a, b, t, found) : ConvexContact<Degree>::contact_at(a, b, t);
}

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
