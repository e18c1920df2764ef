#include "collision/queries/nearest.hpp"

#include "collision/narrow_phase/nearest_of_shape.hpp"
#include "collision/queries/standing_body.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// Finds a box about a point that holds enough bodies, and not many more.
template <class Motion>
class Surroundings {
 public:
  Surroundings(const BasicWorld<Motion>& world, const Vector3d& at, const BodyFilter& filter)
      : world_(world), at_(at), filter_(filter) {}

  /// Those whose volumes are no farther than a length in any coordinate.
  std::vector<BodyId> within(double reach) const {
    std::vector<BodyId> bodies;
    const Vector3d half = Vector3d::Constant(reach);
    world_.visit_overlapping(at_ - half, at_ + half, [&](BodyId id) {
      if (detail::accepts(filter_, id)) bodies.push_back(id);
    });
    return bodies;
  }

  /// A length within which there are so many bodies, if there are, and not many times as many, if that can be.
  double enough(std::size_t count) const {
    constexpr double step = 2;
    constexpr int most_steps = 32;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (world_.size() <= count) return infinity;
    const double size = at_.cwiseAbs().maxCoeff();
    double reach = 0x1p-6 * (size > 0 ? size : 1);
    std::size_t there = within(reach).size();
    if (there < count) {
      for (int i = 0; i < most_steps; ++i) {
        reach *= step;
        if (within(reach).size() >= count) return reach;
      }
      return infinity;
    }
    for (int i = 0; i < most_steps && there > 4 * count + 16; ++i) {
      there = within(reach / step).size();
      if (there < count) break;
      reach /= step;
    }
    return reach;
  }

 private:
  const BasicWorld<Motion>& world_;
  const Vector3d& at_;
  const BodyFilter& filter_;
};

bool nearer(const NearBody& a, const NearBody& b) {
  if (a.distance != b.distance) return a.distance < b.distance;
  return body_rank(a.body) < body_rank(b.body);
}

}  // namespace

template <class Motion>
std::vector<NearBody> nearest(const BasicWorld<Motion>& world, const Vector3d& to, std::size_t count,
                              const BodyFilter& filter) {
  if (!(to.array().abs() <= largest_magnitude).all()) {
    throw std::invalid_argument("nearest: a coordinate is not a number from -2^205 to 2^205");
  }
  if (count == 0) return {};
  const Surroundings<Motion> surroundings(world, to, filter);
  const auto measured = [&](double reach) {
    std::vector<NearBody> bodies;
    for (const BodyId id : surroundings.within(reach)) {
      const detail::StandingBody body = detail::standing_body(world, id);
      const NearestOfShape of_body = nearest_of_shape(body.shape, to - body.centre);
      bodies.push_back({id, of_body.distance, of_body.point + body.centre});
    }
    std::sort(bodies.begin(), bodies.end(), nearer);
    if (bodies.size() > count) bodies.resize(count);
    return bodies;
  };
  const double reach = surroundings.enough(count);
  std::vector<NearBody> bodies = measured(reach);
  // What is not in that box is farther than its half side; but not all in it are nearer than that.
  constexpr double roundings = 1 + 0x1p-20;
  if (bodies.size() == count && bodies.back().distance * roundings > reach) {
    bodies = measured(bodies.back().distance * roundings);
  }
  return bodies;
}

#define KDS_INSTANTIATE(motion) \
  template std::vector<NearBody> nearest(const BasicWorld<motion>&, const Vector3d&, std::size_t, const BodyFilter&);
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
