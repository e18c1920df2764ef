#include "io/polygon.hpp"

#include "kds/arithmetic/ball.hpp"
#include "kds/arithmetic/exact.hpp"
#include "kds/motion.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace kds::io {
namespace {

using Eigen::Vector3d;
using Index = std::uint32_t;
using Triangle = std::array<Index, 3>;

/// The coordinates of a projection.
struct View {
  int x, y;
};
constexpr std::array<View, 3> views{View{0, 1}, View{1, 2}, View{2, 0}};

template <class Number>
Number turn(const View& view, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const auto to = [&](const Vector3d& p, int d) { return difference<Number>(p[d], a[d]); };
  return to(b, view.x) * to(c, view.y) - to(b, view.y) * to(c, view.x);
}

/// The sign of what value(Number()) gives in exact numbers.
template <class Value>
int sign_of(const Value& value) {
  const int quick = certain_sign(value(Ball<double>(0.0)));
  return quick != 0 ? quick : value(Exact()).sign();
}

/// Above 0 if a, b, c turn counter-clockwise, 0 if they are on a line.
int side(const View& view, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return sign_of([&]<class Number>(Number) { return turn<Number>(view, a, b, c); });
}

/// Twice the area, positive if it is gone around counter-clockwise.
template <class Number>
Number area(const View& view, const std::vector<const Vector3d*>& outline) {
  Number sum(0.0);
  for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
    sum = sum + turn<Number>(view, *outline[0], *outline[i], *outline[i + 1]);
  }
  return sum;
}

int area_sign(const View& view, const std::vector<const Vector3d*>& outline) {
  return sign_of([&]<class Number>(Number) { return area<Number>(view, outline); });
}

/// The projection in which the area is greatest, up to roundings, seen from the side from which it is positive. Where
/// the area is 0 in all projections y == x.
View widest_view(const std::vector<const Vector3d*>& outline) {
  std::array<View, 3> by_area = views;
  const auto size = [&](const View& view) { return std::abs(area<double>(view, outline)); };
  std::stable_sort(by_area.begin(), by_area.end(), [&](const View& a, const View& b) { return size(a) > size(b); });
  for (const View& view : by_area) {
    const int sign = area_sign(view, outline);
    if (sign != 0) return sign > 0 ? view : View{view.y, view.x};
  }
  return {0, 0};
}

/// What is left of a polygon while triangles are cut off.
class Outline {
 public:
  Outline(std::vector<Index> corners, std::vector<const Vector3d*> places, View view)
      : corners_(std::move(corners)),
        places_(std::move(places)),
        view_(view),
        next_(corners_.size()),
        previous_(corners_.size()),
        left_(corners_.size()) {
    std::iota(next_.begin(), next_.end() - 1, 1);
    std::iota(previous_.begin() + 1, previous_.end(), 0);
    next_.back() = 0;
    previous_.front() = corners_.size() - 1;
  }

  std::optional<std::vector<Triangle>> cut() {
    while (left_ > 2) {
      // Triangles without area leave a corner out, which a neighbour of the polygon may have: so they come late.
      if (remove_first([this](std::size_t b) { return is_ear(b) && !passes_corner(b); }, true)) continue;
      if (remove_first([this](std::size_t b) { return turn_at(b) == 0 && goes_back(b); }, false)) continue;
      if (remove_first([this](std::size_t b) { return is_ear(b); }, true)) continue;
      if (remove_first([this](std::size_t b) { return turn_at(b) == 0; }, false)) continue;
      return std::nullopt;
    }
    return std::move(triangles_);
  }

 private:
  const Vector3d& at(std::size_t i) const { return *places_[i]; }
  int turn_at(std::size_t b) const { return side(view_, at(previous_[b]), at(b), at(next_[b])); }

  /// Looks from the corner at which the last search ended.
  template <class Fits>
  bool remove_first(const Fits& fits, bool is_triangle) {
    std::size_t b = start_;
    for (std::size_t i = 0; i < left_; ++i, b = next_[b]) {
      if (!fits(b)) continue;
      const std::size_t a = previous_[b], c = next_[b];
      if (is_triangle) triangles_.push_back({corners_[a], corners_[b], corners_[c]});
      next_[a] = c, previous_[c] = a;
      start_ = c;
      --left_;
      return true;
    }
    return false;
  }

  template <class Visit>
  bool any_corner(const Visit& visit) const {
    std::size_t p = start_;
    for (std::size_t i = 0; i < left_; ++i, p = next_[p]) {
      if (visit(p)) return true;
    }
    return false;
  }

  /// The triangle before, at and after b turns left, no edge comes into it, and it is inside: an edge that the outline
  /// goes along in both directions may have the outside on both sides.
  bool is_ear(std::size_t b) const {
    if (turn_at(b) <= 0) return false;
    const Vector3d &a = at(previous_[b]), &c = at(next_[b]);
    return !any_corner([&](std::size_t p) { return meets_inside(a, at(b), c, at(p), at(next_[p])); }) &&
           goes_around(a, at(b), c) == 1;
  }

  /// How often the outline goes around the centroid of a triangle, which is not on it.
  int goes_around(const Vector3d& a, const Vector3d& b, const Vector3d& c) const {
    const auto below = [&](const Vector3d& p) {
      const auto height = [&]<class Number>(Number) {
        const auto over = [&](const Vector3d& q) { return difference<Number>(p[view_.y], q[view_.y]); };
        return over(a) + over(b) + over(c);
      };
      return sign_of(height) <= 0;
    };
    int turns = 0;
    any_corner([&](std::size_t i) {
      const Vector3d &p = at(i), &q = at(next_[i]);
      const bool from_below = below(p);
      if (from_below == below(q)) return false;
      const int on_left = sign_of([&]<class Number>(Number) {
        return turn<Number>(view_, p, q, a) + turn<Number>(view_, p, q, b) + turn<Number>(view_, p, q, c);
      });
      if (from_below && on_left > 0) ++turns;
      if (!from_below && on_left < 0) --turns;
      return false;
    });
    return turns;
  }

  /// Whether the segment p q has points inside of the triangle, which is counter-clockwise. If not, one of the lines
  /// through their edges has one of them on each side, or touches it.
  bool meets_inside(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& p,
                    const Vector3d& q) const {
    const auto outside = [&](const Vector3d& u, const Vector3d& v) {
      return side(view_, u, v, p) <= 0 && side(view_, u, v, q) <= 0;
    };
    if (outside(a, b) || outside(b, c) || outside(c, a)) return false;
    const int of_a = side(view_, p, q, a), of_b = side(view_, p, q, b), of_c = side(view_, p, q, c);
    return !(of_a <= 0 && of_b <= 0 && of_c <= 0) && !(of_a >= 0 && of_b >= 0 && of_c >= 0);
  }

  /// Whether a corner is on the new edge across b, between its ends.
  bool passes_corner(std::size_t b) const {
    const Vector3d &a = at(previous_[b]), &c = at(next_[b]);
    return any_corner([&](std::size_t p) {
      return side(view_, a, c, at(p)) == 0 && between(view_.x, a, at(p), c) && between(view_.y, a, at(p), c) &&
             !same(at(p), a) && !same(at(p), c);
    });
  }
  static bool between(int d, const Vector3d& a, const Vector3d& p, const Vector3d& c) {
    return std::min(a[d], c[d]) <= p[d] && p[d] <= std::max(a[d], c[d]);
  }
  bool same(const Vector3d& a, const Vector3d& b) const { return a[view_.x] == b[view_.x] && a[view_.y] == b[view_.y]; }

  /// Whether the outline turns round at b, which is on a line with its neighbours.
  bool goes_back(std::size_t b) const {
    const Vector3d &a = at(previous_[b]), &c = at(next_[b]);
    return !(between(view_.x, a, at(b), c) && between(view_.y, a, at(b), c)) || same(a, c) || same(at(b), c) ||
           same(a, at(b));
  }

  std::vector<Index> corners_;
  std::vector<const Vector3d*> places_;
  View view_;
  std::vector<std::size_t> next_, previous_;
  std::size_t left_;
  std::size_t start_ = 0;
  std::vector<Triangle> triangles_;
};

}  // namespace

std::optional<std::vector<Triangle>> cut_into_triangles(std::span<const Vector3d> vertices,
                                                        std::span<const Index> polygon) {
  using Triangles = std::vector<Triangle>;
  const auto corner = [&](std::size_t i) { return polygon[std::min(i, polygon.size() - 1)]; };
  if (polygon.size() <= 3) return Triangles{{corner(0), corner(1), corner(2)}};
  std::vector<Index> corners;
  std::vector<const Vector3d*> places;
  for (const Index i : polygon) {
    if (!places.empty() && *places.back() == vertices[i]) continue;
    corners.push_back(i);
    places.push_back(&vertices[i]);
  }
  while (places.size() > 1 && *places.back() == *places.front()) corners.pop_back(), places.pop_back();
  const View view = widest_view(places);
  if (view.x == view.y) {
    // It comes back along all its edges, seen from anywhere, or else encloses as much one way as the other.
    for (const View& any : views) {
      const auto triangles = Outline(corners, places, any).cut();
      if (!triangles || !triangles->empty()) return std::nullopt;
    }
    return Triangles{{corner(0), corner(0), corner(0)}};
  }
  if (places.size() == 4) {
    const auto turns_left = [&](std::size_t i) {
      return side(view, *places[i], *places[(i + 1) % 4], *places[(i + 2) % 4]) > 0;
    };
    if (turns_left(0) && turns_left(1) && turns_left(2) && turns_left(3)) {
      const bool even = (*places[2] - *places[0]).squaredNorm() < (*places[3] - *places[1]).squaredNorm();
      if (even) return Triangles{{corners[0], corners[1], corners[2]}, {corners[0], corners[2], corners[3]}};
      return Triangles{{corners[0], corners[1], corners[3]}, {corners[1], corners[2], corners[3]}};
    }
  }
  return Outline(std::move(corners), std::move(places), view).cut();
}

std::vector<Triangle> fan(std::span<const Index> polygon) {
  std::vector<Triangle> triangles;
  for (std::size_t i = 2; i < polygon.size(); ++i) triangles.push_back({polygon[0], polygon[i - 1], polygon[i]});
  return triangles;
}

}  // namespace kds::io
