// The products that distances of parts of two bodies that turn are made of: as functions of time, and at one time.
#pragma once

#include "certificates/turning/extended_pose.hpp"
#include "certificates/turning/rigid_motion.hpp"
#include "certificates/turning/turned_vector.hpp"
#include "certificates/turning/turning_terms.hpp"
#include "kds/arithmetic/ball.hpp"
#include "kds/turning/turning_sum.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <type_traits>

namespace kds::certificates {

/// x and y are points of the bodies a and b, and d = y - x. This gives the products of d with itself and with vectors
/// of the bodies, all times one positive number, `scale`. The vectors are doubles, taken in the arithmetic of Number.
///
/// SummedProducts has them as TurningSums, ProductsNow at one time: a certificate writes its formula once, for both.
/// `Once` is the type of terms with one turned vector in each product, `Twice` that of products of two such terms.
template <class Number, int Order, int Degree>
class SummedProducts {
  static constexpr int order_of_way = std::min(Order, Degree);

 public:
  using Value = Number;
  using Once = TurningSum<Order, Number>;
  using Twice = TurningSum<Order, Number, 2>;

  SummedProducts(const RigidMotion<Degree>& a, const Eigen::Vector3d& x, const RigidMotion<Degree>& b,
                 const Eigen::Vector3d& y, double epoch)
      : turn_a_(a),
        turn_b_(b),
        rate_a_(a.spin().template squared_rate<Number>()),
        rate_b_(b.spin().template squared_rate<Number>()),
        scale_(turn_a_.scale() * turn_b_.scale()),
        x_(vector_of<Number>(x)),
        y_(vector_of<Number>(y)),
        way_(way_between<Number, order_of_way>(a.path, b.path, epoch)) {}

  Once constant(const Number& number) const {
    Once f{};
    f.p[0][0].c[0] = scale_ * number;
    return f;
  }

  /// u . v, of a vector of a and one of b.
  Once product(const VectorOf<Number>& u, const VectorOf<Number>& v) const {
    Once f{};
    add_product(f, turn_a_(u), turn_b_(v));
    return f;
  }

  /// u . d, of a vector of a.
  Once of_a(const VectorOf<Number>& u) const {
    const TurnedVector<Number> turned = turn_a_(u);
    Once f{};
    add_product(f, turned, turn_b_(y_));
    for (std::size_t i = 0; i < 3; ++i) f.p[i][0] = f.p[i][0] + along(turned[i] * turn_b_.scale(), way_);
    f.p[0][0].c[0] = f.p[0][0].c[0] - scale_ * dot(u, x_);
    return f;
  }

  /// v . d, of a vector of b.
  Once of_b(const VectorOf<Number>& v) const {
    const TurnedVector<Number> turned = turn_b_(v);
    Once f{};
    add_product(f, turn_a_(x_ * Number(-1.0)), turned);
    for (std::size_t j = 0; j < 3; ++j) f.p[0][j] = f.p[0][j] + along(turned[j] * turn_a_.scale(), way_);
    f.p[0][0].c[0] = f.p[0][0].c[0] + scale_ * dot(v, y_);
    return f;
  }

  /// d . d = way . way + 2 way . (y - x) + x . x + y . y - 2 x . y.
  Once square() const {
    const TurnedVector<Number> x = turn_a_(x_ * Number(-2.0));
    const TurnedVector<Number> y = turn_b_(y_);
    Once f{};
    add_product(f, x, y);
    for (std::size_t i = 0; i < 3; ++i) {
      f.p[i][0] = f.p[i][0] + along(x[i] * turn_b_.scale(), way_);
      f.p[0][i] = f.p[0][i] + along(y[i] * (turn_a_.scale() + turn_a_.scale()), way_);
    }
    auto& still = f.p[0][0].c;
    for (std::size_t n = 0; n <= Order; ++n) {
      for (std::size_t k = n > order_of_way ? n - order_of_way : 0; k <= std::min<std::size_t>(n, order_of_way); ++k) {
        for (const auto& p : way_) still[n] = still[n] + scale_ * p.c[k] * p.c[n - k];
      }
    }
    still[0] = still[0] + scale_ * (dot(x_, x_) + dot(y_, y_));
    return f;
  }

  /// (u x v) . d = (u x v) . way + u . (v x y) + (u x x) . v.
  Once triple(const VectorOf<Number>& u, const VectorOf<Number>& v) const {
    const TurnedVector<Number> turned_u = turn_a_(u), turned_v = turn_b_(v);
    Once f{};
    add_product(f, turned_u, turn_b_(cross(v, y_)));
    add_product(f, turn_a_(cross(u, x_)), turned_v);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) f.p[i][j] = f.p[i][j] + along(cross(turned_u[i], turned_v[j]), way_);
    }
    return f;
  }

  /// Adds f g.
  void add(Twice& sum, const Once& f, const Once& g) const { add_product(sum, f, g, rate_a_, rate_b_); }
  void subtract(Twice& sum, const Once& f, const Once& g) const {
    Twice product{};
    add(product, f, g);
    add_multiple(sum, product, Number(-1.0));
  }
  /// Adds f times a number.
  static void add_multiple(Twice& sum, const Twice& f, const Number& factor) {
    for (std::size_t i = 0; i < f.size; ++i) {
      for (std::size_t j = 0; j < f.size; ++j) {
        for (std::size_t k = 0; k <= Order; ++k) sum.p[i][j].c[k] = sum.p[i][j].c[k] + f.p[i][j].c[k] * factor;
      }
    }
  }
  static Once difference(const Once& f, const Once& g) {
    Once result = f;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) result.p[i][j] = f.p[i][j] - g.p[i][j];
    }
    return result;
  }

 private:
  Turner<Number> turn_a_, turn_b_;
  Number rate_a_, rate_b_;  ///< squared
  Number scale_;
  VectorOf<Number> x_, y_;
  VectorOf<Polynomial<order_of_way, Number>> way_;
};

/// The same at one time: Number is Ball<double>, with the scale 1, or Ball<DoubleDouble>, with that of SummedProducts.
///
/// Error bound: Rotation and ExtendedPose bound the error of a turned vector, as a part of its length. The vector's own
/// radii are added to that. Everything else is computed in balls, which bound their errors themselves.
template <class Number>
class ProductsNow {
  static constexpr bool quick = std::is_same_v<Number, Ball<double>>;
  using Turn = std::conditional_t<quick, Rotation, ExtendedPose>;
  using Vector = VectorOf<Number>;

 public:
  using Value = Number;
  using Once = Number;
  using Twice = Number;

  template <int Degree>
  ProductsNow(const RigidMotion<Degree>& a, const Eigen::Vector3d& x, const RigidMotion<Degree>& b,
              const Eigen::Vector3d& y, double t)
      : turn_a_(turn_of(a, t)), turn_b_(turn_of(b, t)) {
    if constexpr (!quick) {
      // Scales are known to 8 units of a double-double, their product to 17.
      const DoubleDouble both = turn_a_.scale() * turn_b_.scale();
      scale_ = {both, usual(turn_a_.scale().high) && usual(turn_b_.scale().high)
                          ? 32 * extended_unit * both.high
                          : std::numeric_limits<double>::infinity()};
    }
    const Vector in_a = turned(turn_a_, vector_of<Number>(x)), in_b = turned(turn_b_, vector_of<Number>(y));
    const Vector o_a = origin(a, turn_a_, t), o_b = origin(b, turn_b_, t);
    for (std::size_t k = 0; k < 3; ++k) d_[k] = (o_b[k] - o_a[k]) + (in_b[k] - in_a[k]);
  }

  Number constant(const Number& number) const { return scaled(number); }
  Number product(const Vector& u, const Vector& v) const { return scaled(dot(turned(turn_a_, u), turned(turn_b_, v))); }
  Number of_a(const Vector& u) const { return scaled(dot(turned(turn_a_, u), d_)); }
  Number of_b(const Vector& v) const { return scaled(dot(turned(turn_b_, v), d_)); }
  Number square() const { return scaled(dot(d_, d_)); }
  Number triple(const Vector& u, const Vector& v) const {
    return scaled(dot(cross(turned(turn_a_, u), turned(turn_b_, v)), d_));
  }
  static void add(Number& sum, const Number& f, const Number& g) { sum = sum + f * g; }
  static void subtract(Number& sum, const Number& f, const Number& g) { sum = sum - f * g; }
  static void add_multiple(Number& sum, const Number& f, const Number& factor) { sum = sum + f * factor; }
  static Number difference(const Number& f, const Number& g) { return f - g; }

 private:
  static bool usual(double scale) { return scale >= 0x1p-200 && scale <= 0x1p200; }

  template <int Degree>
  static Turn turn_of(const RigidMotion<Degree>& motion, double t) {
    if constexpr (quick) {
      return motion.rotation(t);
    } else {
      return ExtendedPose(motion, t);
    }
  }
  template <int Degree>
  static Vector origin(const RigidMotion<Degree>& motion, const Turn& turn, double t) {
    Vector result;
    if constexpr (quick) {
      const BoundedVector o = motion.origin(t);
      for (std::size_t k = 0; k < 3; ++k) result[k] = {o.vector[static_cast<Eigen::Index>(k)], o.error};
    } else {
      for (std::size_t k = 0; k < 3; ++k) result[k] = {turn.origin()[k], turn.origin_error()};
    }
    return result;
  }

  /// v rotated. The error of v is a vector whose length is at most the sum of the radii; a rotation keeps lengths. Its
  /// own error is a part of the length of what it turns: of the middle of v, and of that error.
  static Vector turned(const Turn& turn, const Vector& v) {
    const double radii = v[0].radius + v[1].radius + v[2].radius;
    Vector result;
    if constexpr (quick) {
      const Eigen::Vector3d middle(v[0].middle, v[1].middle, v[2].middle);
      const Eigen::Vector3d there = turn(middle);
      const double error = turn.error() * (magnitude_sum(middle) + radii) + radii * (1 + 0x1p-40) + 0x1p-600;
      for (std::size_t k = 0; k < 3; ++k) result[k] = {there[static_cast<Eigen::Index>(k)], error};
    } else {
      const ExtendedVector middle{v[0].middle, v[1].middle, v[2].middle};
      const ExtendedVector there = turn(middle);
      const double error = turn.error() * (magnitude_sum(middle) + radii) + radii * (1 + 0x1p-40) + 0x1p-600;
      for (std::size_t k = 0; k < 3; ++k) result[k] = {there[k], error};
    }
    return result;
  }
  Number scaled(const Number& x) const {
    if constexpr (quick) {
      return x;
    } else {
      return x * scale_;
    }
  }

  Turn turn_a_, turn_b_;
  Number scale_{1.0};
  Vector d_;
};

}  // namespace kds::certificates
