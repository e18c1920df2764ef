#include "collision/queries/casts.hpp"

#include "collision/narrow_phase/mesh_margins.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/queries/standing_body.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <unordered_set>
#include <utility>
#include <variant>

namespace kds::collision {
namespace {

using Eigen::Vector3d;
using StraightPath = certificates::PointMotion<1>;
using CastShape = MovingShape<StraightPath>;

/// What a ray is: a ball of the least radius.
PlacedShape point() { return placed_ball(smallest_size); }

void require_way(const char* function, const PlacedShape& shape, const Ray& way) {
  detail::require_in_range(function, way.from);
  detail::require_in_range(function, way.to);
  if (!is_placed(shape))
    throw std::invalid_argument(std::string(function) + ": the shape is not what place() makes of it");
  if (bends(shape.shape)) throw std::invalid_argument(std::string(function) + ": a mesh that bends cannot be cast");
  if (unbounded(shape.shape)) throw std::invalid_argument(std::string(function) + ": a half-space cannot be cast");
}

/// A shape on its way, at times from 0 to 1.
class Cast {
 public:
  Cast(const PlacedShape& shape, const Ray& way) : shape_(shape) {
    path_.coefficients = {way.from, way.to - way.from};
    const auto growth = MeshClearance<1>(path_, shape.bounding_radius).growing();
    margin_ = growth[0] + growth[1];
  }

  /// Calls visit(id) for each body whose box meets that of the way from one time to another.
  template <class Motion, class Visit>
  void near(const BasicWorld<Motion>& world, double from, double to, const Visit& visit) const {
    const auto& [start, way] = path_.coefficients;
    const Vector3d a = start + from * way;
    const Vector3d b = start + to * way;
    const Vector3d room = (rounding * (start.cwiseAbs() + way.cwiseAbs())).array() + margin_;
    world.visit_overlapping(a.cwiseMin(b) + shape_.low - room, a.cwiseMax(b) + shape_.high + room, visit);
  }

  /// Where it first meets a body, until a time.
  template <class Motion>
  std::optional<Hit> meets(const BasicWorld<Motion>& world, BodyId id, double until) const {
    const detail::StandingBody body = detail::standing_body(world, id);
    const CastShape a{shape_, path_};
    const CastShape b{body.shape, StraightPath{{body.centre}}};
    FoundTouch found;
    const double t = first_contact(a, b, 0, until, ContactMode::transparent, &found);
    if (t == never) return std::nullopt;
    return Hit{id, contact_at(a, b, t, found)};
  }

 private:
  /// The ends of a piece of the way are off by less than three roundings of either coordinate, and so are the sides of
  /// the box around it. Larger has more bodies tested.
  static constexpr double rounding = 0x1p-50;

  const PlacedShape& shape_;
  StraightPath path_;
  double margin_;  ///< within which a mesh is met, at most, on the whole way
};

/// Into as many pieces as there are bodies in a row, if they fill a cube: so the boxes of most pieces meet few.
template <class Motion>
int pieces_of_way(const BasicWorld<Motion>& world) {
  constexpr double most = 256;
  return static_cast<int>(std::clamp(std::floor(std::cbrt(static_cast<double>(world.size()))), 1.0, most));
}

/// Calls visit(id) once for each accepted body whose box meets that of a piece of the way, piece by piece, as long as
/// `wanted(from)` is true of the time at which the next piece begins: all that is met before that time has been
/// visited.
template <class Motion, class Wanted, class Visit>
void visit_along(const BasicWorld<Motion>& world, const Cast& cast, const BodyFilter& filter, const Wanted& wanted,
                 const Visit& visit) {
  const int pieces = pieces_of_way(world);
  std::unordered_set<BodyId> seen;
  for (int i = 0; i < pieces; ++i) {
    const double from = static_cast<double>(i) / pieces;
    if (!wanted(from)) return;
    cast.near(world, from, static_cast<double>(i + 1) / pieces, [&](BodyId id) {
      if (seen.insert(id).second && detail::accepts(filter, id)) visit(id);
    });
  }
}

}  // namespace

template <class Motion>
std::optional<Hit> cast(const BasicWorld<Motion>& world, const PlacedShape& shape, const Ray& way,
                        const BodyFilter& filter) {
  require_way("cast", shape, way);
  const Cast cast(shape, way);
  std::optional<Hit> first;
  const auto wanted = [&](double from) { return !first || first->contact.time >= from; };
  visit_along(world, cast, filter, wanted, [&](BodyId id) {
    const auto hit = cast.meets(world, id, first ? first->contact.time : 1);
    if (hit && (!first || detail::sooner(*hit, *first))) first = hit;
  });
  return first;
}

template <class Motion>
std::optional<Hit> cast(const BasicWorld<Motion>& world, const Ray& ray, const BodyFilter& filter) {
  return cast(world, point(), ray, filter);
}

template <class Motion>
std::vector<Hit> cast_all(const BasicWorld<Motion>& world, const PlacedShape& shape, const Ray& way,
                          const BodyFilter& filter) {
  require_way("cast_all", shape, way);
  const Cast cast(shape, way);
  std::vector<Hit> hits;
  visit_along(
      world, cast, filter, [](double) { return true; },
      [&](BodyId id) {
        if (const auto hit = cast.meets(world, id, 1)) hits.push_back(*hit);
      });
  std::sort(hits.begin(), hits.end(), detail::sooner);
  return hits;
}

template <class Motion>
std::vector<Hit> cast_all(const BasicWorld<Motion>& world, const Ray& ray, const BodyFilter& filter) {
  return cast_all(world, point(), ray, filter);
}

template <class Motion>
std::vector<BodyId> overlapping(const BasicWorld<Motion>& world, const PlacedShape& shape, const Vector3d& at,
                                const BodyFilter& filter) {
  require_way("overlapping", shape, {at, at});
  StraightPath place;
  place.coefficients = {at};
  std::vector<BodyId> found;
  Cast(shape, {at, at}).near(world, 0, 0, [&](BodyId id) {
    if (!detail::accepts(filter, id)) return;
    const detail::StandingBody body = detail::standing_body(world, id);
    if (in_contact(CastShape{shape, place}, CastShape{body.shape, StraightPath{{body.centre}}}, 0)) found.push_back(id);
  });
  return found;
}

#define KDS_INSTANTIATE(motion)                                                                                     \
  template std::optional<Hit> cast(const BasicWorld<motion>&, const Ray&, const BodyFilter&);                       \
  template std::optional<Hit> cast(const BasicWorld<motion>&, const PlacedShape&, const Ray&, const BodyFilter&);   \
  template std::vector<Hit> cast_all(const BasicWorld<motion>&, const Ray&, const BodyFilter&);                     \
  template std::vector<Hit> cast_all(const BasicWorld<motion>&, const PlacedShape&, const Ray&, const BodyFilter&); \
  template std::vector<BodyId> overlapping(const BasicWorld<motion>&, const PlacedShape&, const Vector3d&,          \
                                           const BodyFilter&);
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
