// Predicates of points in the plane at an instant, decided by the exact signs of certificates.
#pragma once

#include "certificates/plane_certificates.hpp"
#include "kds/bounded.hpp"
#include "kds/framework/moving_set.hpp"

#include <array>

namespace kds::structures {

inline constexpr std::array<double, 2> along_x{1, 0};
inline constexpr std::array<double, 2> along_y{0, 1};

/// Signs at now+; those of sampled points are of their samples. A sign is 0 only if the points stay degenerate.
template <class Path>
struct PlanePredicates {
  const MovingSet<Path>& x;
  double now;
  Id changing = nobody;        ///< this one is treated as if it
  const Path* next = nullptr;  ///< had this motion

  /// > 0 if a, b, c turn counter-clockwise.
  int orientation(Id a, Id b, Id c) const {
    return exact_sign(certificates::Orientation<Path>{at(a), at(b), at(c)}, now);
  }
  /// < 0 if d is inside the circle through a, b, c, which turn counter-clockwise.
  int in_circle(Id a, Id b, Id c, Id d) const {
    return exact_sign(certificates::InCircle<Path>{at(a), at(b), at(c), at(d)}, now);
  }
  /// > 0 if b is farther in a direction than a.
  int order(Id a, Id b, const std::array<double, 2>& along) const {
    return exact_sign(certificates::DirectionOrder<Path, 2>{at(a), at(b), along}, now);
  }
  bool same(Id a, Id b) const { return order(a, b, along_x) == 0 && order(a, b, along_y) == 0; }

 private:
  const Path& at(Id id) const { return id == changing ? *next : x[id]; }
};

}  // namespace kds::structures
