// A ball away from the face, an edge or a corner of a triangle that turns.
#pragma once

#include "certificates/turning/rigid_motion.hpp"
#include "certificates/turning/turned_vector.hpp"
#include "certificates/turning/turning_terms.hpp"
#include "kds/polynomial.hpp"
#include "kds/turning/turning_certificate.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace kds::certificates {

/// The face of a triangle seen from one side (0: from which its corners are counter-clockwise; 1: from the other), an
/// edge (from corner k to the next) or a corner.
struct TrianglePart {
  enum class Kind { face, edge, corner };  ///< a face has a side for its number
  Kind kind;
  std::size_t number;
};

namespace detail {

/// A ball and a triangle of a body, of which only the body turns. d is the way from a corner of the triangle to the
/// centre of the ball, in the body's coordinates.
template <int Degree>
struct BallAndTriangle {
  const PointMotion<Degree>& ball;         ///< the path of the centre
  const RigidMotion<Degree>& body;         ///< of the triangle
  std::array<Eigen::Vector3d, 3> corners;  ///< of the body
  TrianglePart part;

  /// Certificates are sums in two spins. Only one body turns here, so both are its spin.
  std::array<Spin, 2> spins() const { return {body.spin(), body.spin()}; }

  const Eigen::Vector3d& corner(std::size_t ahead) const { return corners[(first() + ahead) % 3]; }
  /// The corner from which d is measured.
  std::size_t first() const { return part.kind == TrianglePart::Kind::face ? 0 : part.number; }

  template <class Number>
  VectorOf<Number> edge(std::size_t from, std::size_t to) const {
    return difference_of<Number>(corner(from), corner(to));
  }
  template <class Number>
  VectorOf<Number> normal() const {
    return cross(edge<Number>(0, 1), edge<Number>(0, 2));
  }

  /// m . d times the scale of the body.
  template <class Number, int Order, class Way>
  TurnedNumber<Number, Order> beyond(const Turner<Number>& turn, const Way& way, const VectorOf<Number>& m) const {
    return seen_along<Order>(turn, way, m, dot(m, vector_of<Number>(corner(0))));
  }

  template <class Number, int Order>
  auto way(double epoch) const {
    return way_between<Number, std::min(Order, Degree)>(body.path, ball, epoch);
  }
};

}  // namespace detail

/// m . d >= 0: the centre of a ball is on that side of a part of a triangle on which the part may be the nearest. For a
/// face m is its normal; for an edge the direction in the plane away from the triangle (number 0); for a corner there
/// are two, along the edges that end there (numbers 0 and 1).
template <int Degree>
struct CentreBeyondPart : detail::BallAndTriangle<Degree> {
  static constexpr int degree = Degree;
  std::size_t number;

  template <class Number, int Order>
  TurningSum<Order, Number> turning_sum(double epoch) const {
    const auto beyond = this->template beyond<Number, Order>(
        Turner<Number>(this->body), this->template way<Number, Order>(epoch), direction<Number>());
    TurningSum<Order, Number> f{};
    for (std::size_t i = 0; i < 3; ++i) f.p[i][0] = beyond[i];
    return f;
  }

 private:
  template <class Number>
  VectorOf<Number> direction() const {
    switch (this->part.kind) {
      case TrianglePart::Kind::face:
        return this->part.number == 0 ? this->template normal<Number>()
                                      : cross(this->template edge<Number>(0, 2), this->template edge<Number>(0, 1));
      case TrianglePart::Kind::edge:
        return cross(this->template edge<Number>(0, 1), this->template normal<Number>());
      case TrianglePart::Kind::corner:
        break;
    }
    return this->template edge<Number>(1 + number, 0);
  }
};

/// The distance of the centre from the plane of a face, the line of an edge or a corner is at least the radius, as a
/// sum of squares: (N . d)^2 >= r^2 |N|^2, |e x d|^2 >= r^2 |e|^2, |d|^2 >= r^2; times the square of the scale of the
/// body. r is the sum of two radii, that of the ball and one that the triangle is grown by, which is not rounded.
template <int Degree>
struct BallBeyondPart : detail::BallAndTriangle<Degree> {
  static constexpr int degree = 2 * Degree;
  std::array<double, 2> radii;

  template <class Number, int Order>
  TurningSum<Order, Number> turning_sum(double epoch) const {
    const Turner<Number> turn(this->body);
    const auto way = this->template way<Number, Order>(epoch);
    TurningSum<Order, Number> f{};
    const auto add = [&](const VectorOf<Number>& m) {
      add_square(f, this->template beyond<Number, Order>(turn, way, m));
    };
    const Number zero(0.0), one(1.0);
    Number length = one;
    if (this->part.kind == TrianglePart::Kind::face) {
      const VectorOf<Number> n = this->template normal<Number>();
      add(n);
      length = dot(n, n);
    } else if (this->part.kind == TrianglePart::Kind::edge) {
      // The coordinates of d x e are products of d with e x unit vectors.
      const VectorOf<Number> e = this->template edge<Number>(0, 1);
      add({zero, e[2], zero - e[1]});
      add({zero - e[2], zero, e[0]});
      add({e[1], zero - e[0], zero});
      length = dot(e, e);
    } else {
      add({one, zero, zero});
      add({zero, one, zero});
      add({zero, zero, one});
    }
    const Number scaled_radius = turn.scale() * (Number(radii[0]) + Number(radii[1]));
    f.p[0][0].c[0] = f.p[0][0].c[0] - scaled_radius * scaled_radius * length;
    return f;
  }
};

}  // namespace kds::certificates
