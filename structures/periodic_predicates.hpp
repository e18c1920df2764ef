// Predicates of copies of points in a plane that repeats itself, at an instant.
#pragma once

#include "certificates/path_copy.hpp"
#include "certificates/plane_certificates.hpp"
#include "kds/bounded.hpp"
#include "kds/framework/moving_set.hpp"
#include "structures/periodic_mesh.hpp"
#include "structures/plane_predicates.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace kds::structures {

using certificates::Periods;

/// Certificates of vertices of a PeriodicMesh, and their signs at now+; those of sampled points are of their samples.
template <class Path>
struct PeriodicPredicates {
  using Copy = certificates::PathCopy<Path>;

  const MovingSet<Path>& x;
  const Periods& periods;
  double now = 0;
  Id changing = nobody;        ///< this one is treated as if it
  const Path* next = nullptr;  ///< had this motion,
  PeriodOffset jump = {};      ///< which is displaced by so many periods

  Copy at(const VertexCopy& v) const {
    return v.id == changing ? Copy{*next, periods, v.offset - jump} : Copy{x[v.id], periods, v.offset};
  }
  certificates::Orientation<Copy> orientation_of(const VertexCopy& a, const VertexCopy& b, const VertexCopy& c) const {
    return {at(a), at(b), at(c)};
  }
  certificates::InCircle<Copy> in_circle_of(const std::array<VertexCopy, 4>& corners) const {
    const auto& [a, b, c, d] = corners;
    return {at(a), at(b), at(c), at(d)};
  }

  /// > 0 if a, b, c turn counter-clockwise.
  int orientation(const VertexCopy& a, const VertexCopy& b, const VertexCopy& c) const {
    return exact_sign(orientation_of(a, b, c), now);
  }
  /// < 0 if the fourth is inside the circle through the others, which turn counter-clockwise.
  int in_circle(const std::array<VertexCopy, 4>& corners) const { return exact_sign(in_circle_of(corners), now); }
  /// Whether two copies stay in one place.
  bool same(const VertexCopy& a, const VertexCopy& b) const {
    const auto apart = [&](const std::array<double, 2>& along) {
      return exact_sign(certificates::DirectionOrder<Copy, 2>{at(a), at(b), along}, now) != 0;
    };
    return !apart(along_x) && !apart(along_y);
  }

  /// How many periods the second is from the first, rounded. Throws std::range_error if that is farther than an offset
  /// can express.
  PeriodOffset periods_between(Id from, const Path& to) const {
    const auto between = [&](int axis) {
      const double period = periods[static_cast<std::size_t>(axis)];
      const double whole = std::nearbyint((place(to, axis) - place(x[from], axis)) / period);
      if (!(std::abs(whole) <= static_cast<double>(certificates::farthest_offset))) {
        throw std::range_error("periodic triangulation: a point is more than 2^52 periods away from point " +
                               std::to_string(from));
      }
      return static_cast<std::int64_t>(whole);
    };
    const std::int64_t along = between(0);
    return {along, between(1)};
  }

 private:
  double place(const Path& path, int axis) const {
    const auto motion = about<Ball<double>>(path.axis(axis), now);
    if constexpr (requires { motion.middle; }) {
      return motion.middle.c[0].middle;
    } else {
      return motion.c[0].middle;
    }
  }
};

}  // namespace kds::structures
