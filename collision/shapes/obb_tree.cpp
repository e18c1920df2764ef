#include "collision/shapes/obb_tree.hpp"

#include "kds/audit.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace kds::collision {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Boxes grow by this part of the unit: 32 roundings of a float. Centres and extents are rounded to floats once each
/// (2 roundings of numbers up to sqrt 3), and what is computed in doubles counts for nothing.
constexpr float growth = 32 * 0x1p-24F;

/// A box with at most this many triangles also tries the directions of their edges.
constexpr std::uint32_t few_triangles = 4;

/// A split must leave at least one triangle in so many on either side.
constexpr std::uint32_t worst_split = 8;

Vector3d coordinates(Lanes x) { return {x[0], x[1], x[2]}; }

Matrix3d rounded_axes(const ObbNode& node) {
  Matrix3d axes;
  for (int k = 0; k < 3; ++k) axes.row(k) = coordinates(node.axes[static_cast<std::size_t>(k)]).transpose();
  return axes;
}

struct Item {
  LeafTriangle triangle;
  Vector3d centre;
};

struct Fit {
  Matrix3d axes = Matrix3d::Identity();
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = -low;

  double surface() const {
    const Vector3d d = high - low;
    return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
  }
};

class Builder {
 public:
  Builder(std::span<const Vector3d> vertices, double unit, std::vector<Item>& items, std::vector<ObbNode>& nodes)
      : vertices_(vertices), unit_(unit), items_(items), nodes_(nodes) {}

  void build(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
    const Fit fit = best_fit(begin, end);
    set_box(nodes_[node], fit, begin, end);
    if (end - begin <= ObbTree::leaf_size) {
      nodes_[node].first = begin;
      nodes_[node].count = end - begin;
      return;
    }
    const std::uint32_t middle = split(fit, begin, end);
    const auto children = static_cast<std::uint32_t>(nodes_.size());
    nodes_[node].first = children;
    nodes_[node].count = 0;
    nodes_.resize(nodes_.size() + 2);
    build(children, begin, middle);
    build(children + 1, middle, end);
  }

 private:
  const Vector3d& corner(const Item& item, std::size_t i) const { return vertices_[item.triangle.vertices[i]]; }

  Fit fit_along(const Matrix3d& axes, std::uint32_t begin, std::uint32_t end) const {
    Fit fit;
    fit.axes = axes;
    for (std::uint32_t i = begin; i < end; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Vector3d x = axes.transpose() * corner(items_[i], k);
        fit.low = fit.low.cwiseMin(x);
        fit.high = fit.high.cwiseMax(x);
      }
    }
    return fit;
  }

  Fit best_fit(std::uint32_t begin, std::uint32_t end) const {
    Fit best = fit_along(Matrix3d::Identity(), begin, end);
    const auto consider = [&](const Matrix3d& axes) {
      const Fit fit = fit_along(axes, begin, end);
      if (fit.surface() < best.surface()) best = fit;
    };
    consider(principal_axes(best, begin, end));
    if (end - begin > few_triangles) return best;
    for (std::uint32_t i = begin; i < end; ++i) {
      for (std::size_t k = 0; k < 3; ++k) consider(edge_axes(items_[i], k));
    }
    return best;
  }

  /// [Gottschalk96] section 4: eigenvectors of the covariance of all points of the triangles. Lengths are measured
  /// from the middle of the box in units of its size, so that no square under- or overflows.
  Matrix3d principal_axes(const Fit& box, std::uint32_t begin, std::uint32_t end) const {
    const Vector3d origin = 0.5 * box.low + 0.5 * box.high;
    const double unit = (box.high - box.low).maxCoeff();
    double area_sum = 0;
    Vector3d first = Vector3d::Zero();
    Matrix3d second = Matrix3d::Zero();
    for (std::uint32_t i = begin; i < end; ++i) {
      const Vector3d p = (corner(items_[i], 0) - origin) / unit;
      const Vector3d q = (corner(items_[i], 1) - origin) / unit;
      const Vector3d r = (corner(items_[i], 2) - origin) / unit;
      const Vector3d m = (p + q + r) / 3;
      const double area = (q - p).cross(r - p).norm();
      area_sum += area;
      first += area * m;
      second += area / 12 * (9 * m * m.transpose() + p * p.transpose() + q * q.transpose() + r * r.transpose());
    }
    if (!(area_sum > 0)) return Matrix3d::Identity();
    first /= area_sum;
    const Matrix3d covariance = second / area_sum - first * first.transpose();
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(covariance);
    return solver.info() == Eigen::Success ? Matrix3d(solver.eigenvectors()) : Matrix3d(Matrix3d::Identity());
  }

  /// The frame of one edge of a triangle and the triangle's normal.
  Matrix3d edge_axes(const Item& item, std::size_t k) const {
    const Vector3d along = (corner(item, (k + 1) % 3) - corner(item, k)).stableNormalized();
    const Vector3d other = (corner(item, (k + 2) % 3) - corner(item, k)).stableNormalized();
    // Twice orthogonalised: of a thin triangle the first pass leaves a rest along the edge.
    Vector3d across = (other - along.dot(other) * along).stableNormalized();
    across = (across - along.dot(across) * along).stableNormalized();
    Matrix3d axes;
    axes << along, across, along.cross(across);
    return axes;
  }

  /// The box is that of the axes and the centre as rounded to floats.
  void set_box(ObbNode& node, const Fit& fit, std::uint32_t begin, std::uint32_t end) const {
    const Vector3d middle = fit.axes * (0.5 * fit.low + 0.5 * fit.high);
    for (int k = 0; k < 3; ++k) node.axes[static_cast<std::size_t>(k)] = lanes(fit.axes.row(k));
    node.centre = lanes(middle / unit_);
    const Vector3d centre = unit_ * coordinates(node.centre);
    const Matrix3d axes = rounded_axes(node);
    Vector3d widest = Vector3d::Zero();
    for (std::uint32_t i = begin; i < end; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        widest = widest.cwiseMax((axes.transpose() * (corner(items_[i], k) - centre)).cwiseAbs());
      }
    }
    node.half_extents = lanes(widest / unit_ + Vector3d::Constant(growth));
    node.radius = static_cast<float>(coordinates(node.half_extents).norm()) + growth;
  }

  /// Reorders [begin, end) into two parts and returns where the second begins.
  std::uint32_t split(const Fit& fit, std::uint32_t begin, std::uint32_t end) {
    const Vector3d size = fit.high - fit.low;
    std::array<int, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(), [&](int i, int j) { return size[i] > size[j]; });
    const std::uint32_t least = std::max<std::uint32_t>(1, (end - begin) / worst_split);
    for (const int axis : order) {
      const Vector3d direction = fit.axes.col(axis);
      double mean = 0;
      for (std::uint32_t i = begin; i < end; ++i) mean += direction.dot(items_[i].centre);
      mean /= end - begin;
      const auto second = std::partition(items_.begin() + begin, items_.begin() + end,
                                         [&](const Item& item) { return direction.dot(item.centre) < mean; });
      const auto middle = static_cast<std::uint32_t>(second - items_.begin());
      if (middle >= begin + least && middle + least <= end) return middle;
    }
    return halve(fit.axes.col(order[0]), begin, end);
  }

  /// Splits at the median; equal centres are told apart by their index.
  std::uint32_t halve(const Vector3d& direction, std::uint32_t begin, std::uint32_t end) {
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end,
                     [&](const Item& a, const Item& b) {
                       const double x = direction.dot(a.centre);
                       const double y = direction.dot(b.centre);
                       return x != y ? x < y : a.triangle.index < b.triangle.index;
                     });
    return middle;
  }

  std::span<const Vector3d> vertices_;
  double unit_;
  std::vector<Item>& items_;
  std::vector<ObbNode>& nodes_;
};

}  // namespace

ObbTree::ObbTree(std::span<const Vector3d> vertices, std::span<const std::array<std::uint32_t, 3>> triangles) {
  std::vector<Item> items;
  items.reserve(triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const auto& [a, b, c] = triangles[i];
    items.push_back({{triangles[i], i}, (vertices[a] + vertices[b] + vertices[c]) / 3});
  }
  double largest = 0;
  for (const Vector3d& v : vertices) largest = std::max(largest, v.cwiseAbs().maxCoeff());
  int exponent = 0;
  std::frexp(largest, &exponent);
  unit_ = std::ldexp(1.0, exponent);  // a power of two above: scaling by it is exact
  const auto n = static_cast<std::uint32_t>(items.size());
  nodes_.reserve(2 * n);
  nodes_.resize(1);
  Builder(vertices, unit_, items, nodes_).build(0, 0, n);
  nodes_.shrink_to_fit();
  leaf_triangles_.reserve(n);
  for (const Item& item : items) leaf_triangles_.push_back(item.triangle);
}

void ObbTree::audit(std::span<const Vector3d> vertices) const {
  const auto fail = [](std::uint32_t node, const std::string& what) {
    throw AuditFailure("ObbTree: node " + std::to_string(node) + ": " + what);
  };
  std::vector<std::uint32_t> seen(leaf_triangles_.size(), 0);
  // The triangles below a node are checked against it while walking up from each leaf.
  std::vector<std::uint32_t> parent(nodes_.size(), 0);
  for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
    if (nodes_[i].is_leaf()) continue;
    if (nodes_[i].first <= i || nodes_[i].first + 1 >= nodes_.size()) fail(i, "children out of range");
    parent[nodes_[i].first] = parent[nodes_[i].first + 1] = i;
  }
  for (std::uint32_t leaf = 0; leaf < nodes_.size(); ++leaf) {
    if (!nodes_[leaf].is_leaf()) continue;
    if (nodes_[leaf].first + nodes_[leaf].count > leaf_triangles_.size()) fail(leaf, "triangles out of range");
    for (std::uint32_t k = 0; k < nodes_[leaf].count; ++k) {
      const LeafTriangle& triangle = leaf_triangles_[nodes_[leaf].first + k];
      ++seen[triangle.index];
      for (std::uint32_t node = leaf;; node = parent[node]) {
        const ObbNode& box = nodes_[node];
        for (const std::uint32_t v : triangle.vertices) {
          const Vector3d x = rounded_axes(box).transpose() * (vertices[v] / unit_ - coordinates(box.centre));
          if (!(x.cwiseAbs().array() <= coordinates(box.half_extents).array()).all()) {
            fail(node, "triangle " + std::to_string(triangle.index) + " sticks out");
          }
        }
        if (node == 0) break;
      }
    }
  }
  for (std::uint32_t i = 0; i < seen.size(); ++i) {
    if (seen[i] != 1) throw AuditFailure("ObbTree: triangle " + std::to_string(i) + " is not in exactly one leaf");
  }
}

}  // namespace kds::collision
