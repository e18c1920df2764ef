// When spheres and oriented boxes on polynomial paths penetrate each other: exactly, and in another way than the
// library. It never looks for the root it wants: it cuts time at all roots of all polynomials that could matter, asks
// a plain geometric question at a rational time inside each piece, and joins the pieces.
#pragma once

#include "tests/support/exact_algebra.hpp"

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <variant>
#include <vector>

namespace oracle {

using Vector = std::array<Rational, 3>;
using Matrix = std::array<Vector, 3>;  // rows

Matrix identity();
/// The exact rotation of the normalised quaternion w, x, y, z: rational, since its elements hold |q|^2 but not |q|.
/// Precondition: not zero.
Matrix rotation(const std::array<double, 4>& wxyz);

struct Sphere {
  double radius = 1;
};
struct Box {
  std::array<double, 3> half_extents{1, 1, 1};
  Matrix orientation = identity();  ///< from the box's axes to the world's; exactly orthogonal
};
using Shape = std::variant<Sphere, Box>;

/// x(t) = c[0] + c[1] (t - start) + c[2] (t - start)^2 + ..., of any degree.
struct Piece {
  double start = 0;
  std::vector<std::array<double, 3>> coefficients;

  friend bool operator==(const Piece&, const Piece&) = default;
};

/// A piece holds until the next one starts; the first one also before its own start.
struct Body {
  Shape shape;
  std::vector<Piece> motion;  ///< sorted by start, at least one
};

/// Whether the open shapes have a point in common when b's centre is at `relative` from a's: touching is not enough.
bool penetrate(const Shape& a, const Shape& b, const Vector& relative);

/// Signed gap to double precision, of the exact sign: negative if and only if the shapes penetrate. For two boxes apart
/// it is the widest gap along a separating axis, which is at most their distance.
double gap(const Body& a, const Body& b, const Rational& t);

/// When two bodies penetrate each other, for begin <= t <= end. A stretch begins where penetration begins just after:
/// a touch without crossing is none. One that is under way at `begin` starts there and says so.
std::vector<Stretch> contacts(const Body& a, const Body& b, double begin,
                              double end = std::numeric_limits<double>::infinity());

/// The first t in [from, until] just after which the bodies penetrate: what a step of an event loop must find.
std::optional<Instant> first_contact(const Body& a, const Body& b, double from,
                                     double until = std::numeric_limits<double>::infinity());

struct PairContact {
  std::size_t a, b;  ///< a < b
  Stretch stretch;
};

/// All contacts of all pairs by (begin, a, b).
std::vector<PairContact> all_contacts(std::span<const Body> bodies, double begin, double end);

}  // namespace oracle
