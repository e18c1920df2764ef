// Certificates that refer to motions, made of temporaries: they would refer to what has gone.
#include "certificates/arrival.hpp"
#include "certificates/in_order.hpp"
#include "certificates/in_sphere.hpp"
#include "certificates/plane_certificates.hpp"
#include "certificates/plane_motion.hpp"
#include "certificates/space_orientation.hpp"

#include <array>
#include <cstddef>

namespace misuse {

using namespace kds;
using namespace kds::certificates;
using Path = PlaneMotion<1>;

struct Point {
  static constexpr int degree = 1;
  std::array<Motion<1>, 3> coordinate;
  const Motion<1>& axis(int axis) const { return coordinate[static_cast<std::size_t>(axis)]; }
};

Path path();
Point point();

int all(const Path& a, const Bounded& b, const Point& p) {
  const std::array<double, 2> up{0, 1};
  const Order<1> order{a.axis(0), a.axis(1)};
  const Ascending<Bounded> ascending{b, Bounded{}};
  const Orientation<Path> orientation{a, a, path()};
  const InCircle<Path> in_circle{a, path(), a, a};
  const DistanceOrder<Path> distances{path(), a, a, a};
  const DirectionOrder<Path, 2> direction{a, a, std::array<double, 2>{1, 0}};
  const SpaceOrientation<Point> space_orientation{p, point(), p, p};
  const InSphere<Point> in_sphere{p, p, p, p, point()};
  const TurnsLeft turns{a, path()};
  const CrossesFirst crosses{path(), a};
  const ArrivesFirst arrives{Arrival{}, Arrival{}};
  // Right ones, which must not be named.
  const DirectionOrder<Path, 2> upward{a, a, up};
  const InCircle right{a, a, a, a};
  const InSphere sphere{p, p, p, p, p};
  return order.degree + ascending.degree + orientation.degree + in_circle.degree + distances.degree + direction.degree +
         upward.degree + right.degree + space_orientation.degree + in_sphere.degree + turns.degree + crosses.degree +
         arrives.degree + sphere.degree;
}

}  // namespace misuse
