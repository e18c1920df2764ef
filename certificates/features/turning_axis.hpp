// Separating axes that turn with the features they belong to.
#pragma once

#include "certificates/features/closest_point.hpp"
#include "certificates/features/positive_stretch.hpp"

#include <algorithm>
#include <array>

namespace kds::certificates {

/// How long the closest direction *of the same part of the patch* separates the patch from the origin.
///
/// A fixed direction loses a patch that turns around a point close by: it is good for a time in proportion to the gap.
/// The exact closest direction of a part (the normal of the interior, the perpendicular on an edge, the way to a
/// corner) is itself a polynomial of time, n(s), so n(s) . corner(s) > 0 for all corners is a certificate too, of
/// degree 3 (interior: the coplanarity cubic), 4 (edge: the squared distance from its line, times a square) or 2
/// (corner) for linear paths, and twice that for quadratic ones. It fails only when the origin really comes to the
/// plane, line or point of the part, or when another part is in the way; each such failure uses up a root, so a
/// query takes a bounded number of these steps whatever the gap (docs/features.md, "Steps").
template <Patch kind, int Degree>
class TurningAxis {
 public:
  explicit TurningAxis(const PatchPaths<Degree>& paths) : paths_(paths) {}

  /// As separated_until() in fixed_axis.hpp, with the axis that belongs to the part of the patch on which `point` lies;
  /// 1 where that is all the time there is.
  double separated_until(const PatchPoint& point, double s) const {
    switch (point.part) {
      case PatchPart::interior: return over_interior(s);
      case PatchPart::edge: return beside_edge(point.corner, s);
      case PatchPart::corner: return before_corner(point.corner, s);
    }
    return s;
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

  template <int A, int B>
  static double positive(const Bounded<A>& a, const Bounded<B>& b, double s) {
    return positive_until(dot(a.v, b.v), s, dot_error(a, b));
  }

  // n = u x v; all corners are at the same height n . q0.
  double over_interior(double s) const {
    const auto n = cross(side(0, 1), side(0, kind == Patch::triangle ? 2 : 3));
    const auto q0 = corner(0);
    auto height = dot(n.v, q0.v);
    if (height(s) < 0) height = -height;
    return positive_until(height, s, dot_error(n, q0));
  }

  // n = (e x q) x e, so n . x = (e x q) . (e x x): the ends of the edge both at |e x q|^2, and the others of a patch
  // of four at one height as well, since n . e = 0.
  double beside_edge(std::size_t k, double s) const {
    const auto e = side(k, (k + 1) % 4);
    const auto moment = cross(e, corner(k));
    const double own = positive(moment, moment, s);
    if (!(own > s)) return s;
    return std::min(own, positive(moment, cross(e, corner(kind == Patch::triangle ? (k + 2) % 3 : (k + 3) % 4)), s));
  }

  double before_corner(std::size_t k, double s) const {
    const auto q = corner(k);
    double until = 1;
    for (std::size_t j = 0; j < 4 && until > s; ++j) until = std::min(until, positive(q, corner(j), s));
    return until;
  }

  const PatchPaths<Degree>& paths_;
};

}  // namespace kds::certificates
