// Separating axes that turn with the features they belong to.
#pragma once

#include "certificates/features/closest_point.hpp"
#include "certificates/features/positive_stretch.hpp"

#include <algorithm>
#include <array>

namespace kds::certificates {

/// How long a direction that turns with a part of the patch separates the patch from the origin.
///
/// A fixed direction loses a patch that turns around a point close by: it is good for a time in proportion to the gap.
/// These directions are polynomials of time, n(s), and n(s) . corner(s) > 0 for all corners is a certificate as well:
///
/// - the normal of the patch, n = u x v: the coplanarity of the four points, of degree 3 for linear paths (degree 6 for
///   quadratic ones); all corners have the same height over it;
/// - for an edge e and a fixed direction m, what is left of m across the edge, n = m |e|^2 - e (e . m), so that
///   n . x = (e x m) . (e x x): of degree 3 (6) as well, and both ends of the edge have the same height. With m the
///   closest direction now it holds while the edge turns as it likes and the origin stays within a quarter turn of m
///   around it. (The closest direction itself, with the moving corner in place of m, would square the gap, and so lose
///   half of the digits.)
///
/// A corner is approached with the axes of its two edges, an edge also with the normal. Each failure of such a
/// certificate uses up a root, or a quarter turn: a query takes few of these steps, whatever the gap (docs/features.md,
/// "Steps").
///
/// Where features have a thickness the certificates are n(s) . corner(s) > thickness |n(s)| (positive_beyond_until()).
template <Patch kind, int Degree>
class TurningAxis {
 public:
  explicit TurningAxis(const PatchPaths<Degree>& paths, double thickness = 0) : paths_(paths), thickness_(thickness) {
    const auto n = plane();
    const auto q0 = corner(0);
    volume_ = dot(n.v, q0.v);
    volume_error_ = dot_error(n, q0);
  }

  /// The signed volume n . q0 of the four points (six times that of their tetrahedron) for s in [0, 1], and a bound on
  /// its error there.
  const Polynomial<3 * Degree>& volume() const { return volume_; }
  double volume_error() const { return volume_error_; }

  /// As separated_until() in fixed_axis.hpp, with the normal of the patch, n = u x v: all corners are at one height,
  /// n . q0.
  double separated_by_plane_until(double s) const {
    const Polynomial<3 * Degree> height = volume_(s) < 0 ? -volume_ : volume_;
    if (thickness_ == 0) return positive_until(height, s, volume_error_);
    return beyond(height, volume_error_, plane(), s);
  }

  /// The same with the axes that belong to the part of the patch on which `point` lies, and to the larger parts next to
  /// it, which are at most a little worse now and may be much better soon; 1 where that is all the time there is.
  double separated_until(const PatchPoint& point, double s) const {
    double until = separated_by_plane_until(s);
    if (point.part == PatchPart::interior || until >= 1) return until;
    until = std::max(until, beside_edge(point.corner, point.position, s));
    if (point.part == PatchPart::edge || until >= 1) return until;
    const std::size_t before = point.corner > 0 ? point.corner - 1U : (kind == Patch::triangle ? 2U : 3U);
    return std::max(until, beside_edge(before, point.position, s));
  }

  /// The same with the axis that turns on as from `before` at time s0 to `now` at s, both of length 1. For parts that
  /// vanish just when they touch, so that the others are lost in their margins.
  double separated_turning_on(const Eigen::Vector3d& before, double s0, const Eigen::Vector3d& now, double s) const {
    const Eigen::Vector3d rate = (now - before) / (s - s0);
    std::array<Polynomial<1>, 3> axis;
    for (int d = 0; d < 3; ++d) axis[static_cast<std::size_t>(d)] = {{now[d] - s * rate[d], rate[d]}};
    const Bounded<1> n{axis, norm(axis), 0};
    double until = 1;
    for (std::size_t k = 0; k < 4 && until > s; ++k) until = std::min(until, positive(n, corner(k), n, s));
    return until;
  }

 private:
  using Scalar = Polynomial<Degree>;
  using Vector = std::array<Scalar, 3>;

  /// Greatest norm of a coordinate, rounded up.
  template <int D>
  static double norm(const std::array<Polynomial<D>, 3>& v) {
    return std::max({certificates::norm(v[0]), certificates::norm(v[1]), certificates::norm(v[2])}) * (1 + 0x1p-48);
  }
  static Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
  template <int A, int B>
  static std::array<Polynomial<A + B>, 3> cross(const std::array<Polynomial<A>, 3>& a,
                                                const std::array<Polynomial<B>, 3>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }
  template <int A, int B>
  static Polynomial<A + B> dot(const std::array<Polynomial<A>, 3>& a, const std::array<Polynomial<B>, 3>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }

  /// A vector polynomial computed, with the greatest norm of a coordinate and a bound on the error of each in [0, 1].
  template <int D>
  struct Bounded {
    std::array<Polynomial<D>, 3> v;
    double size;
    double error;
  };

  Vector path(std::size_t k) const {
    Vector q;
    for (std::size_t d = 0; d < 3; ++d) {
      for (std::size_t i = 0; i <= Degree; ++i) q[d].c[i] = paths_.c[i][d][k];
    }
    return q;
  }
  Bounded<Degree> corner(std::size_t k) const {
    const Vector q = path(k);
    return {q, norm(q), paths_.error};
  }
  Bounded<2 * Degree> plane() const { return cross(side(0, 1), side(0, kind == Patch::triangle ? 2 : 3)); }
  Bounded<Degree> side(std::size_t from, std::size_t to) const {
    const Vector e = minus(path(to), path(from));
    const double size = norm(e);
    return {e, size, 2 * paths_.error + half_ulp * size};
  }

  // Errors, with a the sizes and e the errors of the factors: a product of coordinates is off by a e' + a' e + e e' and
  // by Degree + 2 roundings of a a'; a cross product sums 2 of them and a dot product 3, with a rounding a sum. All but
  // the first factor are at most as large as bounds of the kind used here with 1.01 in place of second-order terms.
  template <int A, int B>
  static Bounded<A + B> cross(const Bounded<A>& a, const Bounded<B>& b) {
    constexpr double roundings = 2 * (std::min(A, B) + 4) * half_ulp;
    return {cross(a.v, b.v), 2.01 * a.size * b.size,
            2.02 * (a.size * b.error + b.size * a.error + a.error * b.error) + roundings * a.size * b.size};
  }
  template <int A, int B>
  static double dot_error(const Bounded<A>& a, const Bounded<B>& b) {
    constexpr double roundings = 3 * (std::min(A, B) + 5) * half_ulp;
    return 3.03 * (a.size * b.error + b.size * a.error + a.error * b.error) + roundings * a.size * b.size;
  }

  /// How long `height`, off by `error` at most, is above the thickness times the length of n.
  template <int P, int N>
  double beyond(const Polynomial<P>& height, double error, const Bounded<N>& n, double s) const {
    return positive_beyond_until(height, n.v, thickness_, s, error + thickness_ * (1.74 * n.error));  // sqrt(3)
  }
  /// The same of a . b.
  template <int A, int B, int N>
  double positive(const Bounded<A>& a, const Bounded<B>& b, const Bounded<N>& n, double s) const {
    const auto height = dot(a.v, b.v);
    if (thickness_ == 0) return positive_until(height, s, dot_error(a, b));
    return beyond(height, dot_error(a, b), n, s);
  }

  // The two corners that are not of the edge are as high as each other, if there are two.
  double beside_edge(std::size_t k, const Eigen::Vector3d& direction, double s) const {
    if (kind == Patch::triangle && k == 3) k = 0;  // the corner that a triangle repeats
    const Bounded<0> m{
        {{{{direction[0]}}, {{direction[1]}}, {{direction[2]}}}}, direction.lpNorm<Eigen::Infinity>(), 0};
    const auto e = side(k, (k + 1) % 4);
    const auto across = cross(e, m);
    // n = m |e|^2 - e (e . m) = (e x m) x e.
    const Bounded<2 * Degree> n = thickness_ > 0 ? cross(across, e) : Bounded<2 * Degree>{};
    const double own = positive(across, cross(e, corner(k)), n, s);
    if (!(own > s)) return s;
    const std::size_t opposite = kind == Patch::triangle ? (k + 2) % 3 : (k + 3) % 4;
    return std::min(own, positive(across, cross(e, corner(opposite)), n, s));
  }

  const PatchPaths<Degree>& paths_;
  double thickness_;
  Polynomial<3 * Degree> volume_;
  double volume_error_;
};

}  // namespace kds::certificates
