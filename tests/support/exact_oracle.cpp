#include "tests/support/exact_oracle.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace oracle {
namespace {

/// Motion of b's centre relative to a's.
using Path = std::array<Polynomial, 3>;

template <class A, class B>
auto dot(const std::array<A, 3>& a, const std::array<B, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector cross(const Vector& a, const Vector& b) {
  return {Rational(a[1] * b[2] - a[2] * b[1]), Rational(a[2] * b[0] - a[0] * b[2]),
          Rational(a[0] * b[1] - a[1] * b[0])};
}

Vector column(const Matrix& m, std::size_t j) { return {m[0][j], m[1][j], m[2][j]}; }

bool is_zero(const Vector& v) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

/// The path seen from a box; entry i along its axis i.
template <class T>
std::array<T, 3> in_frame(const Matrix& orientation, const std::array<T, 3>& path) {
  std::array<T, 3> seen;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector axis = column(orientation, i);
    seen[i] = path[0] * T(axis[0]) + path[1] * T(axis[1]) + path[2] * T(axis[2]);
  }
  return seen;
}

// --- the plain question at one time

Rational square_distance_to_box(const Box& box, const Vector& local) {
  Rational sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Rational beyond = abs(local[i]) - rational(box.half_extents[i]);
    if (beyond > 0) sum += square(beyond);
  }
  return sum;
}

struct Axis {
  Vector direction;
  Rational half_widths;  ///< half the sum of both boxes' widths along it, times its length
};

/// All directions along which two boxes can be separated: face normals and products of edges.
std::vector<Axis> separating_axes(const Box& a, const Box& b) {
  std::vector<Vector> directions;
  for (std::size_t i = 0; i < 3; ++i) directions.push_back(column(a.orientation, i));
  for (std::size_t i = 0; i < 3; ++i) directions.push_back(column(b.orientation, i));
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Vector product = cross(column(a.orientation, i), column(b.orientation, j));
      if (!is_zero(product)) directions.push_back(product);
    }
  }
  std::vector<Axis> axes;
  for (const Vector& direction : directions) {
    Rational half_widths = 0;
    for (const Box* box : {&a, &b}) {
      for (std::size_t i = 0; i < 3; ++i) {
        half_widths += rational(box->half_extents[i]) * Rational(abs(dot(column(box->orientation, i), direction)));
      }
    }
    axes.push_back({direction, half_widths});
  }
  return axes;
}

bool apart(const Axis& axis, const Vector& relative) { return abs(dot(axis.direction, relative)) >= axis.half_widths; }

Rational sum_of_radii(const Sphere& a, const Sphere& b) { return rational(a.radius) + rational(b.radius); }

bool penetrates(const Sphere& a, const Sphere& b, const Vector& r) { return dot(r, r) < square(sum_of_radii(a, b)); }

bool penetrates(const Sphere& ball, const Box& box, const Vector& r) {
  return square_distance_to_box(box, in_frame(box.orientation, r)) < square(rational(ball.radius));
}

bool penetrates(const Box& a, const Sphere& b, const Vector& r) {
  return penetrates(b, a, {Rational(-r[0]), Rational(-r[1]), Rational(-r[2])});
}

bool penetrates(const Box& a, const Box& b, const Vector& r) {
  const std::vector<Axis> axes = separating_axes(a, b);
  return std::none_of(axes.begin(), axes.end(), [&](const Axis& axis) { return apart(axis, r); });
}

// --- the polynomials at whose roots the answer may change

std::vector<Polynomial> critical(const Sphere& a, const Sphere& b, const Path& r) {
  return {dot(r, r) - Polynomial(square(sum_of_radii(a, b)))};
}

/// The squared distance to a box is a sum of squares (q_i -+ h_i)^2, over the axes along which the centre is beyond the
/// faces; which it is changes where q_i = -+ h_i.
std::vector<Polynomial> critical(const Sphere& ball, const Box& box, const Path& r) {
  const Path q = in_frame(box.orientation, r);
  std::vector<Polynomial> result;
  std::array<std::array<Polynomial, 3>, 3> squares;  // of the distance beyond: none, above, below
  for (std::size_t i = 0; i < 3; ++i) {
    const Polynomial h(rational(box.half_extents[i]));
    for (const Polynomial& beyond : {q[i] - h, q[i] + h}) result.push_back(beyond);
    squares[i] = {Polynomial(), (q[i] - h) * (q[i] - h), (q[i] + h) * (q[i] + h)};
  }
  const Polynomial square_of_radius(square(rational(ball.radius)));
  for (std::size_t region = 1; region < 27; ++region) {
    result.push_back(squares[0][region % 3] + squares[1][region / 3 % 3] + squares[2][region / 9] - square_of_radius);
  }
  return result;
}

std::vector<Polynomial> critical(const Box& a, const Sphere& b, const Path& r) {
  const Rational back = -1;
  return critical(b, a, {r[0] * back, r[1] * back, r[2] * back});
}

std::vector<Polynomial> critical(const Box& a, const Box& b, const Path& r) {
  std::vector<Polynomial> result;
  for (const Axis& axis : separating_axes(a, b)) {
    const Polynomial along = r[0] * axis.direction[0] + r[1] * axis.direction[1] + r[2] * axis.direction[2];
    result.push_back(along - axis.half_widths);
    result.push_back(along + axis.half_widths);
  }
  return result;
}

// --- motions

const Piece& piece_at(const Body& body, const Rational& t) {
  assert(!body.motion.empty());
  const Piece* piece = &body.motion.front();
  for (const Piece& next : body.motion) {
    if (rational(next.start) <= t) piece = &next;
  }
  return *piece;
}

Path path(const Body& body, const Rational& t) {
  const Piece& piece = piece_at(body, t);
  Path result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> coefficients;
    for (const auto& c : piece.coefficients) coefficients.push_back(c[axis]);
    result[axis] = Polynomial::motion(coefficients, piece.start);
  }
  return result;
}

Path relative_path(const Body& a, const Body& b, const Rational& t) {
  const Path pa = path(a, t);
  const Path pb = path(b, t);
  return {pb[0] - pa[0], pb[1] - pa[1], pb[2] - pa[2]};
}

Vector at(const Path& path, const Rational& t) { return {path[0](t), path[1](t), path[2](t)}; }

/// A ball of this radius holds the shape.
Rational bounding_radius(const Shape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return rational(sphere->radius);
  Rational sum = 0;
  for (const double h : std::get<Box>(shape).half_extents) sum += rational(h);
  return sum;
}

Condition penetration(const Shape& a, const Shape& b, const Path& r) {
  return {std::visit([&](const auto& x, const auto& y) { return critical(x, y, r); }, a, b),
          [&a, &b, r](const Rational& t) { return penetrate(a, b, at(r, t)); }};
}

/// Whether the shapes come near enough to be worth the full question.
bool come_near(const Shape& a, const Shape& b, const Path& r, const Rational& start,
               const std::optional<Rational>& end) {
  const Polynomial room = dot(r, r) - Polynomial(square(bounding_radius(a) + bounding_radius(b)));
  return first_negative(room, start, end).has_value();
}

double square_root(const Rational& x) { return std::sqrt(approximate(x)); }

/// sqrt(square) - length, without cancellation.
double difference_of_lengths(const Rational& square_of_first, const Rational& second) {
  const double sum = square_root(square_of_first) + approximate(second);
  return sum > 0 ? approximate(square_of_first - square(second)) / sum : 0;
}

double gap_between(const Sphere& a, const Sphere& b, const Vector& r) {
  return difference_of_lengths(dot(r, r), sum_of_radii(a, b));
}

double gap_between(const Sphere& ball, const Box& box, const Vector& r) {
  const Vector q = in_frame(box.orientation, r);
  const Rational outside = square_distance_to_box(box, q);
  if (outside > 0) return difference_of_lengths(outside, rational(ball.radius));
  Rational inside = abs(q[0]) - rational(box.half_extents[0]);
  for (std::size_t i = 1; i < 3; ++i) {
    inside = std::max(inside, Rational(abs(q[i]) - rational(box.half_extents[i])));
  }
  return approximate(inside - rational(ball.radius));
}

double gap_between(const Box& a, const Sphere& b, const Vector& r) {
  return gap_between(b, a, {Rational(-r[0]), Rational(-r[1]), Rational(-r[2])});
}

double gap_between(const Box& a, const Box& b, const Vector& r) {
  double widest = -std::numeric_limits<double>::infinity();
  for (const Axis& axis : separating_axes(a, b)) {
    const Rational along = abs(dot(axis.direction, r)) - axis.half_widths;
    widest = std::max(widest, approximate(along) / square_root(dot(axis.direction, axis.direction)));
  }
  return widest;
}

}  // namespace

Matrix identity() { return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}; }

Matrix rotation(const std::array<double, 4>& wxyz) {
  const Rational w = rational(wxyz[0]);
  const Rational x = rational(wxyz[1]);
  const Rational y = rational(wxyz[2]);
  const Rational z = rational(wxyz[3]);
  const Rational norm = w * w + x * x + y * y + z * z;
  assert(norm != 0);
  Matrix m{{{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
            {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
            {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}}};
  for (Vector& row : m) {
    for (Rational& entry : row) entry /= norm;
  }
  return m;
}

bool penetrate(const Shape& a, const Shape& b, const Vector& relative) {
  return std::visit([&](const auto& x, const auto& y) { return penetrates(x, y, relative); }, a, b);
}

double gap(const Body& a, const Body& b, const Rational& t) {
  const Vector r = at(relative_path(a, b, t), t);
  return std::visit([&](const auto& x, const auto& y) { return gap_between(x, y, r); }, a.shape, b.shape);
}

std::vector<Stretch> contacts(const Body& a, const Body& b, double begin, double end) {
  std::vector<double> seams{begin};
  for (const Body* body : {&a, &b}) {
    for (const Piece& piece : body->motion) {
      if (piece.start > begin && piece.start <= end && &piece != &body->motion.front()) seams.push_back(piece.start);
    }
  }
  std::sort(seams.begin(), seams.end());
  seams.erase(std::unique(seams.begin(), seams.end()), seams.end());

  Watch watch;
  for (std::size_t i = 0; i < seams.size(); ++i) {
    const bool last = i + 1 == seams.size();
    const Rational from = rational(seams[i]);
    const std::optional<Rational> to = last ? time_end(end) : time_end(seams[i + 1]);
    const Path r = relative_path(a, b, from);
    if (come_near(a.shape, b.shape, r, from, to)) {
      watch.look(penetration(a.shape, b.shape, r), from, to, last);
    } else {
      watch.look({{}, [](const Rational&) { return false; }}, from, to, last);
    }
  }
  return watch.stretches();
}

std::optional<Instant> first_contact(const Body& a, const Body& b, double from, double until) {
  const std::vector<Stretch> found = contacts(a, b, from, until);
  return found.empty() ? std::nullopt : std::optional(found.front().begin);
}

std::vector<PairContact> all_contacts(std::span<const Body> bodies, double begin, double end) {
  std::vector<PairContact> result;
  for (std::size_t a = 0; a < bodies.size(); ++a) {
    for (std::size_t b = a + 1; b < bodies.size(); ++b) {
      for (Stretch& stretch : contacts(bodies[a], bodies[b], begin, end)) result.push_back({a, b, std::move(stretch)});
    }
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const PairContact& x, const PairContact& y) { return x.stretch.begin < y.stretch.begin; });
  return result;
}

}  // namespace oracle
