#include "collision/world/resting/contact_gaps.hpp"

#include "collision/narrow_phase/mesh_margins.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/relative_motion.hpp"
#include "collision/response/least_constraint.hpp"
#include "collision/shapes/shape_forms.hpp"
#include "collision/shapes/support.hpp"
#include "collision/vectors.hpp"
#include "collision/world/resting/cluster_rules.hpp"
#include "kds/arithmetic/lattice.hpp"

#include <algorithm>
#include <cmath>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

bool is_round(const PlacedShape& shape) { return rounding_radius(shape.shape) > 0; }

/// b, displaced.
template <int Degree>
certificates::PointMotion<Degree> moved(certificates::PointMotion<Degree> motion, const Vector3d& by) {
  motion.coefficients[0] += by;
  return motion;
}

/// The least Bernstein coefficient on [0, 1] of a polynomial, constant first, which is nowhere lower there.
template <std::size_t Size>
double least_bernstein_coefficient(const std::array<double, Size>& polynomial) {
  double least = polynomial[0];
  for (std::size_t j = 1; j < Size; ++j) {
    double sum = 0, part = 1;  // of the term i: (j over i) / (degree over i)
    for (std::size_t i = 0; i <= j; ++i) {
      sum += part * polynomial[i];
      part *= static_cast<double>(j - i) / static_cast<double>(Size - 1 - i);
    }
    least = std::min(least, sum);
  }
  return least;
}

/// By how much a mesh is moved nearer to find the nearest places, as a part of their size.
constexpr double nearest_part = 0x1p-26;

}  // namespace

template <class Motion>
double ContactGaps<Motion>::size(const Contact& contact) const {
  const double size = bodies_[contact.a].bounding_radius;
  return contact.b == no_body ? size : std::min(size, bodies_[contact.b].bounding_radius);
}

template <class Motion>
bool ContactGaps<Motion>::balls(const Contact& contact) const {
  return contact.b != no_body && bodies_.mover(contact.a).radius > 0 && bodies_.mover(contact.b).radius > 0;
}

template <class Motion>
bool ContactGaps<Motion>::on_plane(const Contact& contact) const {
  return contact.b == no_body || bodies_.unbounded(contact.a) || bodies_.unbounded(contact.b);
}

template <class Motion>
bool ContactGaps<Motion>::concave(const Contact& contact) const {
  if (on_plane(contact) || balls(contact)) return false;
  return collision::concave(bodies_.shape(contact.a).shape) || collision::concave(bodies_.shape(contact.b).shape);
}

template <class Motion>
bool ContactGaps<Motion>::turns(const Contact& contact) const {
  if (on_plane(contact)) return false;
  if (balls(contact)) return true;
  const PlacedShape a = bodies_.shape(contact.a);
  const PlacedShape b = bodies_.shape(contact.b);
  const bool a_round = is_round(a);
  const bool b_round = is_round(b);
  if (a_round && b_round) return true;
  if (!a_round && !b_round) return false;
  const PlacedShape& other = a_round ? b : a;
  if (collision::concave(other.shape)) return true;
  if (polytope_of(other.shape)) {
    const Vector3d towards = a_round ? Vector3d(-contact.normal) : contact.normal;
    return supporting_feature(other, towards).feature.kind != Feature::Kind::face;
  }
  return std::none_of(other.half_axes.begin(), other.half_axes.end(), [&](const Vector3d& axis) {
    return std::abs(dot(contact.normal, axis)) >= norm(axis) * (1 - 0x1p-40);
  });
}

template <class Motion>
double ContactGaps<Motion>::parting(const Contact& contact) const {
  Vector3d apart = -bodies_.path(contact.a).velocity(clock_.now);
  if (contact.b != no_body) apart += bodies_.path(contact.b).velocity(clock_.now);
  return dot(contact.normal, apart);
}

template <class Motion>
double ContactGaps<Motion>::rate_error(const Contact& contact) const {
  if (!concave(contact)) return rate_rounding;
  const auto& a = bodies_.path(contact.a);
  const auto& b = bodies_.path(contact.b);
  const auto motion = relative_to(a.restarted(clock_.now), b.restarted(clock_.now));
  const double radii = bodies_[contact.a].bounding_radius + bodies_[contact.b].bounding_radius;
  return rate_rounding + contact_gap(motion, radii)(0) / size(contact);
}

template <class Motion>
double ContactGaps<Motion>::along_normal(const Contact& contact) const {
  const double now = clock_.now;
  if (contact.b == no_body) {
    const Eigen::Index axis = contact.wall / 2;
    const double place = bodies_.path(contact.a).position(now)[axis];
    const double radius = bodies_[contact.a].bounding_radius;
    return contact.wall % 2 != 0 ? (walls_->max[axis] - radius) - place : place - (walls_->min[axis] + radius);
  }
  if (balls(contact)) {
    const auto& a = bodies_.mover(contact.a);
    const auto& b = bodies_.mover(contact.b);
    return dot(contact.normal, b.motion.position(now) - a.motion.position(now)) - a.radius - b.radius;
  }
  if (!concave(contact)) return gap_along(bodies_.moving(contact.a), bodies_.moving(contact.b), contact.normal, now);
  if (contact.since == -never) return 0;  // It has come from outside the cluster.
  const auto& a = bodies_.path(contact.a);
  const auto& b = bodies_.path(contact.b);
  const Vector3d went = (b.position(now) - b.position(contact.since)) - (a.position(now) - a.position(contact.since));
  return contact.gap + dot(contact.normal, went);
}

template <class Motion>
double ContactGaps<Motion>::nearest(Contact& contact) const {
  if (on_plane(contact) || concave(contact)) return along_normal(contact);
  if (balls(contact)) {
    const SurfaceGap gap = after(contact, Vector3d::Zero());
    contact.normal = gap.normal;
    return gap.width;
  }
  const auto a = bodies_.moving(contact.a);
  const auto b = bodies_.moving(contact.b);
  if (!is_round(a.shape) && !is_round(b.shape)) return along_normal(contact);
  const SurfaceGap gap = surface_gap(a, b, clock_.now);
  contact.normal = gap.normal;
  return gap.width;
}

template <class Motion>
SurfaceGap ContactGaps<Motion>::after(const Contact& contact, const Vector3d& displacement) const {
  if (balls(contact)) {
    const double now = clock_.now;
    const auto& a = bodies_.mover(contact.a);
    const auto& b = bodies_.mover(contact.b);
    const Vector3d apart = b.motion.position(now) - a.motion.position(now) + displacement;
    const double distance = norm(apart);
    if (distance > 0) return {distance - a.radius - b.radius, apart / distance};
  }
  const auto b = bodies_.moving(contact.b);
  const auto later = moved(b.motion, displacement);
  return surface_gap(bodies_.moving(contact.a), MovingShape<Motion>{b.shape, later}, clock_.now);
}

template <class Motion>
bool ContactGaps<Motion>::renew(Contact& contact) const {
  const double now = clock_.now;
  contact.gap = nearest(contact);
  contact.since = now;
  if (contact.gap > cluster::kept_gap * size(contact)) return false;
  if (on_plane(contact)) return true;
  const PlacedShape a = bodies_.shape(contact.a);
  const PlacedShape b = bodies_.shape(contact.b);
  const bool round = is_round(a) || is_round(b);
  const bool in_places = concave(contact);
  if (round && !in_places) return true;
  const auto where = place(contact, contact.gap);
  if (!where) return false;
  if (!in_places || !round) return true;
  const auto& [touch, nearer] = *where;
  contact.normal = touch.normal;
  // From the surface of the mesh to that of a ball.
  if (const double of_b = bodies_.mover(contact.b).radius; of_b > 0) {
    contact.gap = dot(contact.normal, bodies_.path(contact.b).position(now) - touch.point) - of_b;
  } else if (const double of_a = bodies_.mover(contact.a).radius; of_a > 0) {
    contact.gap = dot(contact.normal, touch.point - nearer - bodies_.path(contact.a).position(now)) - of_a;
  }
  return true;
}

template <class Motion>
auto ContactGaps<Motion>::place(const Contact& contact, double gap) const -> std::optional<Place> {
  const double now = clock_.now;
  const auto a = bodies_.moving(contact.a);
  const auto b = bodies_.moving(contact.b);
  for (const double part : {nearest_part, cluster::room_of_many}) {
    const Vector3d nearer = -(gap + part * size(contact)) * contact.normal;
    const auto motion = moved(b.motion, nearer);
    const MovingShape<Motion> touching{b.shape, motion};
    if (in_contact(a, touching, now)) return Place{contact_at(a, touching, now), nearer};
  }
  return std::nullopt;
}

template <class Motion>
bool ContactGaps<Motion>::on_face(const Contact& contact) const {
  if (!concave(contact) || !turns(contact)) return false;
  const auto where = place(contact, along_normal(contact));
  if (!where) return false;
  const collision::Contact& touch = where->touch;
  const Feature& feature = is_round(bodies_.shape(contact.a)) ? touch.feature_b : touch.feature_a;
  return feature.kind == Feature::Kind::face && dot(touch.normal, contact.normal) >= 1 - 0x1p-40;
}

template <class Motion>
std::array<double, Motion::degree + std::size_t{1}> ContactGaps<Motion>::higher_terms(const Contact& contact,
                                                                                      const Vector3d& normal,
                                                                                      double span) const {
  std::array<double, Motion::degree + std::size_t{1}> terms{};
  if constexpr (Motion::degree >= 3) {
    for (const BodySlot id : {contact.a, contact.b}) {
      if (id == no_body || !bodies_.fixed(id)) continue;
      const Motion motion = bodies_.path(id).restarted(clock_.now);
      double power = span * span * (id == contact.a ? -1 : 1);
      for (std::size_t i = 3; i <= Motion::degree; ++i) {
        power *= span;
        terms[i] += power * dot(normal, motion.coefficients[i]);
      }
    }
  }
  return terms;
}

template <class Motion>
double ContactGaps<Motion>::beyond_parabola(const Contact& contact, const Vector3d& normal, double span) const {
  double sum = 0;
  for (const double term : higher_terms(contact, normal, span)) sum += term;
  return sum;
}

template <class Motion>
bool ContactGaps<Motion>::proven(const Contact& contact, double rate, double half, double span) const {
  if (contact.b == no_body) return true;
  const double gap = along_normal(contact) + cluster::rounding * size(contact);
  if constexpr (Motion::degree >= 3) {
    auto terms = higher_terms(contact, contact.normal, span);
    if (std::any_of(terms.begin(), terms.end(), [](double term) { return term != 0; })) {
      terms[0] = gap, terms[1] = rate * span, terms[2] = half * span * span;
      return least_bernstein_coefficient(terms) >= 0;
    }
  }
  return gap >= 0 && gap + (rate + std::min(half, 0.0) * span) * span >= 0;
}

template <class Motion>
bool ContactGaps<Motion>::deeper(const Contact& contact, double by) const {
  if (!(overlap(contact) > by)) return false;
  if (contact.b == no_body) return true;
  const auto b = bodies_.moving(contact.b);
  const auto apart = moved(b.motion, by * contact.normal);
  return in_contact(bodies_.moving(contact.a), MovingShape<Motion>{b.shape, apart}, clock_.now);
}

template <class Motion>
double ContactGaps<Motion>::deepest_overlap(const Contact& contact) const {
  const double now = clock_.now;
  const double spacing = next_up(std::abs(now)) - std::abs(now);
  double coordinates = 0;
  for (const BodySlot id : {contact.a, contact.b}) {
    if (id == no_body) continue;
    const auto& path = bodies_.path(id);
    coordinates += 0x1p-46 * path.position(now).cwiseAbs().maxCoeff() + 4 * spacing * norm(path.velocity(now));
  }
  return 0x1p-30 * size(contact) + coordinates;
}

#define KDS_INSTANTIATE(motion) template class ContactGaps<motion>;
KDS_FOR_EACH_PATH(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
