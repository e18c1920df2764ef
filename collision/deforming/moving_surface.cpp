#include "collision/deforming/moving_surface.hpp"

#include "kds/audit.hpp"
#include "kds/certificate.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// Grows the box by what another holds.
template <int Degree>
void join(ControlBox<Degree>& box, const ControlBox<Degree>& other) {
  for (std::size_t i = 0; i <= Degree; ++i) {
    for (std::size_t d = 0; d < 3; ++d) {
      box.min[i][d] = std::min(box.min[i][d], other.min[i][d]);
      box.max[i][d] = std::max(box.max[i][d], other.max[i][d]);
    }
  }
}

/// The sum of control points times the Bernstein polynomials, by repeated averages.
template <std::size_t Count>
Vector3d at(std::array<Vector3d, Count> points, double s) {
  for (std::size_t level = Count - 1; level > 0; --level) {
    for (std::size_t i = 0; i < level; ++i) points[i] = (1 - s) * points[i] + s * points[i + 1];
  }
  return points[0];
}

}  // namespace

template <int Degree>
MovingSurface<Degree>::MovingSurface(const SurfaceTree& tree) : tree_(&tree), boxes_(tree.nodes().size()) {
  for (auto& points : control_) points.assign(tree.vertices(), Vector3d::Zero());
  refit(0, 1);
}

template <int Degree>
void MovingSurface<Degree>::refit(double t0, double t1) {
  t0_ = t0;
  t1_ = t1;
  const auto nodes = tree_->nodes();
  const auto elements = tree_->elements();
  for (std::size_t i = nodes.size(); i-- > 0;) {
    ControlBox<Degree>& box = boxes_[i];
    if (!nodes[i].is_leaf) {
      box = boxes_[nodes[i].first];
      join(box, boxes_[nodes[i].first + 1]);
      continue;
    }
    const auto& [a, b, c] = elements[nodes[i].first].vertices;  // those that do not count repeat others
    for (std::size_t k = 0; k < controls; ++k) {
      for (std::size_t d = 0; d < 3; ++d) {
        const auto axis = static_cast<Eigen::Index>(d);
        const double x = control_[k][a][axis];
        const double y = control_[k][b][axis];
        const double z = control_[k][c][axis];
        box.min[k][d] = std::min(std::min(x, y), z);
        box.max[k][d] = std::max(std::max(x, y), z);
      }
    }
  }
}

template <int Degree>
Vector3d MovingSurface<Degree>::position(std::size_t vertex, double t) const {
  std::array<Vector3d, controls> points;
  for (std::size_t i = 0; i < controls; ++i) points[i] = control_[i][vertex];
  return at(points, part(t));
}

template <int Degree>
Vector3d MovingSurface<Degree>::velocity(std::size_t vertex, double t) const {
  std::array<Vector3d, controls - 1> points;
  for (std::size_t i = 0; i + 1 < controls; ++i) points[i] = control_[i + 1][vertex] - control_[i][vertex];
  return at(points, part(t)) * (t1_ > t0_ ? Degree / (t1_ - t0_) : 0);
}

template <int Degree>
void MovingSurface<Degree>::audit() const {
  tree_->audit();
  const auto nodes = tree_->nodes();
  const auto fail = [](std::size_t node) {
    throw AuditFailure("MovingSurface: the box of node " + std::to_string(node) + " does not hold what is below it");
  };
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t k = 0; k < controls; ++k) {
      for (std::size_t d = 0; d < 3; ++d) {
        const auto holds = [&](double low, double high) {
          if (!(boxes_[i].min[k][d] <= low && boxes_[i].max[k][d] >= high)) fail(i);
        };
        if (nodes[i].is_leaf) {
          for (const std::uint32_t v : tree_->elements()[nodes[i].first].vertices) {
            const double x = control_[k][v][static_cast<Eigen::Index>(d)];
            holds(x, x);
          }
        } else {
          for (const std::uint32_t child : {nodes[i].first, nodes[i].first + 1}) {
            holds(boxes_[child].min[k][d], boxes_[child].max[k][d]);
          }
        }
      }
    }
  }
}

template <int Degree>
PathControls<Degree>::PathControls(const certificates::PointMotion<Degree>& path, double t0, double t1) {
  using Number = Ball<double>;
  const Number duration = difference<Number>(t1, t0);
  for (int d = 0; d < 3; ++d) {
    const auto set = [&](std::size_t i, const Number& value) {
      points[i][d] = value.middle;
      error = std::max(error, value.radius * Number::slack);
    };
    const auto begin = about<Number>(path.axis(d), t0);
    set(0, begin.c[0]);
    if constexpr (Degree == 2) set(1, begin.c[0] + begin.c[1] * duration * 0.5);
    set(Degree, about<Number>(path.axis(d), t1).c[0]);
  }
}

template class MovingSurface<1>;
template class MovingSurface<2>;
template struct PathControls<1>;
template struct PathControls<2>;

}  // namespace kds::collision
