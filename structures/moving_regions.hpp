// Regions that move and grow: balls and boxes whose sides are parallel to the axes.
#pragma once

#include "certificates/in_region.hpp"
#include "kds/framework/moving_set.hpp"
#include "kds/motion.hpp"

#include <concepts>
#include <cstddef>
#include <variant>

namespace kds::structures {

/// What PointsInsideRule (points_inside.hpp) asks of a region: it is where all its sides are >= 0, a closed set.
///
///     using Point, Side                     paths of points; the type of its certificates
///     static constexpr std::size_t sides    how many it has
///     side(i, point, sign) const -> Side    sign 1: the point is on the inner side of the i-th, or on it; -1: on the
///                                           outer one, or on it
template <class R>
concept Region = MovingElement<R> && requires(const R& region, const typename R::Point& point, std::size_t i) {
  requires MovingElement<typename R::Point>;
  { R::sides } -> std::convertible_to<std::size_t>;
  { region.side(i, point, 1.0) } -> std::same_as<typename R::Side>;
};

/// A disc (PlaneMotion) or ball (PointMotion). Nothing is in it while its radius is negative.
template <class Path>
struct BallRegion {
  using Point = Path;
  using Radius = Motion<Path::degree>;
  using Side = std::variant<certificates::InBall<Path>, certificates::OnSide<Path::degree>>;
  static constexpr std::size_t sides = 2;

  Path centre;
  Radius radius;

  Side side(std::size_t i, const Point& point, double sign) const {
    if (i == 0) return certificates::InBall<Path>{point, centre, radius, sign};
    return certificates::OnSide<Path::degree>{Radius{{}, radius.start}, radius, sign};
  }

  bool finite() const { return kds::detail::finite(centre) && is_finite(radius); }
  template <class Archive>
  void archive(Archive& archive) {
    archive(centre, radius);
  }
  friend bool operator==(const BallRegion&, const BallRegion&) = default;
  friend BallRegion reversed(const BallRegion& ball) { return {reversed(ball.centre), reversed(ball.radius)}; }
};

/// A rectangle (PlaneMotion) or box (PointMotion), between two corners. Nothing is in it while the low one is above the
/// high one in any coordinate.
template <class Path>
struct BoxRegion {
  using Point = Path;
  using Side = certificates::OnSide<Path::degree>;
  static constexpr std::size_t sides = 2 * certificates::dimensions<Path>;

  Path low, high;

  Side side(std::size_t i, const Point& point, double sign) const {
    const int axis = static_cast<int>(i / 2);
    if (i % 2 == 0) return {low.axis(axis), point.axis(axis), sign};
    return {point.axis(axis), high.axis(axis), sign};
  }

  bool finite() const { return kds::detail::finite(low) && kds::detail::finite(high); }
  template <class Archive>
  void archive(Archive& archive) {
    archive(low, high);
  }
  friend bool operator==(const BoxRegion&, const BoxRegion&) = default;
  friend BoxRegion reversed(const BoxRegion& box) { return {reversed(box.low), reversed(box.high)}; }
};

}  // namespace kds::structures
