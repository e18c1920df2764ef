// Certificates that refer to motions, made of temporaries: they would refer to what has gone.
#include "certificates/in_order.hpp"
#include "certificates/plane_certificates.hpp"
#include "certificates/plane_motion.hpp"

#include <array>

namespace misuse {

using namespace kds;
using namespace kds::certificates;
using Path = PlaneMotion<1>;

Path path();

int all(const Path& a, const Bounded& b) {
  const std::array<double, 2> up{0, 1};
  const Order<1> order{a.axis(0), a.axis(1)};
  const Ascending<Bounded> ascending{b, Bounded{}};
  const Orientation<Path> orientation{a, a, path()};
  const InCircle<Path> in_circle{a, path(), a, a};
  const DistanceOrder<Path> distances{path(), a, a, a};
  const DirectionOrder<Path, 2> direction{a, a, std::array<double, 2>{1, 0}};
  // Right ones, which must not be named.
  const DirectionOrder<Path, 2> upward{a, a, up};
  const InCircle right{a, a, a, a};
  return order.degree + ascending.degree + orientation.degree + in_circle.degree + distances.degree +
         direction.degree + upward.degree + right.degree;
}

}  // namespace misuse
