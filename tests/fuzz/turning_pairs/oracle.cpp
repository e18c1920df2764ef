#include "tests/fuzz/turning_pairs/oracle.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace turning_pairs {
namespace {

constexpr Number infinity = std::numeric_limits<Number>::infinity();
constexpr int most_steps = 20000;

Number dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector sum(const Vector& a, const Vector& b, Number f = 1) {
  return {a[0] + f * b[0], a[1] + f * b[1], a[2] + f * b[2]};
}
Number length(const Vector& a) { return std::sqrt(dot(a, a)); }
Vector unit(const Vector& a) { return sum({0, 0, 0}, a, 1 / length(a)); }
Vector vector(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

/// A number of 113 bits, for times far from the start of a motion.
#ifdef __SIZEOF_FLOAT128__
__extension__ typedef __float128 Long;
#else
using Long = long double;
#endif

/// A motion with what does not change of it.
class Mover {
 public:
  explicit Mover(const Body& body) : body_(body) {
    const Eigen::Quaterniond& q = body.orientation;
    const Number w = q.w(), x = q.x(), y = q.y(), z = q.z(), n = w * w + x * x + y * y + z * z;
    first_ = {Vector{(w * w + x * x - y * y - z * z) / n, 2 * (x * y + w * z) / n, 2 * (x * z - w * y) / n},
              Vector{2 * (x * y - w * z) / n, (w * w - x * x + y * y - z * z) / n, 2 * (y * z + w * x) / n},
              Vector{2 * (x * z + w * y) / n, 2 * (y * z - w * x) / n, (w * w - x * x - y * y + z * z) / n}};
    spin_ = vector(body.angular_velocity);
    Long square = 0;
    for (int d = 0; d < 3; ++d) square += static_cast<Long>(body.angular_velocity[d]) * body.angular_velocity[d];
    rate_ = length(spin_);
    if (rate_ > 0) {  // one step of Newton's method
      const Long root = rate_;
      long_rate_ = (root + square / root) / 2;
    }
  }

  void look(Number t) {
    const Long elapsed = static_cast<Long>(t) - static_cast<Long>(body_.start);
    for (std::size_t d = 0; d < 3; ++d) {
      const auto i = static_cast<Eigen::Index>(d);
      const Long c0 = body_.path[0][i], c1 = body_.path[1][i], c2 = body_.path[2][i];
      origin[d] = static_cast<Number>(c0 + elapsed * (c1 + elapsed * c2));
      velocity[d] = static_cast<Number>(c1 + 2 * elapsed * c2);
    }
    axes = first_;
    if (!(rate_ > 0)) return;
    static const Long two_pi = (static_cast<Long>(0x1.921fb54442d18p+2) + static_cast<Long>(0x1.1a62633145c07p-52)) -
                               static_cast<Long>(0x1.f1976b7ed8fbcp-108);
    Long angle = long_rate_ * elapsed;
    angle -= two_pi * static_cast<Long>(std::floor(static_cast<Number>(angle / two_pi)));
    const Number c = std::cos(static_cast<Number>(angle)), s = std::sin(static_cast<Number>(angle));
    const Vector k = unit(spin_);
    for (Vector& v : axes) v = sum(sum(sum({0, 0, 0}, v, c), cross(k, v), s), k, dot(k, v) * (1 - c));
  }

  Vector turned(const Vector& x) const { return sum(sum(sum({0, 0, 0}, axes[0], x[0]), axes[1], x[1]), axes[2], x[2]); }
  const Vector& spin() const { return spin_; }
  Number rate() const { return rate_; }
  Number acceleration() const { return 2 * length(vector(body_.path[2])); }

  Vector origin{}, velocity{};
  std::array<Vector, 3> axes{};

 private:
  const Body& body_;
  std::array<Vector, 3> first_{};
  Vector spin_{};
  Number rate_ = 0;
  Long long_rate_ = 0;
};

/// A piece where it is, about the origin of its body.
struct Seen {
  std::vector<Vector> points, normals, edges;
};

void see(Seen& seen, const Piece& piece, const Mover& mover) {
  const auto turn = [&](std::vector<Vector>& to, const std::vector<Vector>& from) {
    to.clear();
    for (const Vector& x : from) to.push_back(mover.turned(x));
  };
  turn(seen.points, piece.points), turn(seen.normals, piece.normals), turn(seen.edges, piece.edges);
}

/// The point of a triangle or of a box (eight points) that is nearest to x.
Vector nearest(const Seen& piece, const Vector& x) {
  Vector middle{};
  for (const Vector& p : piece.points) middle = sum(middle, p, Number(1) / static_cast<Number>(piece.points.size()));
  if (piece.points.size() == 8) {
    Vector result = middle;
    for (const Vector& n : piece.normals) {
      Number half = 0;
      for (const Vector& p : piece.points) half = std::max(half, dot(n, sum(p, middle, -1)));
      result = sum(result, n, std::clamp(dot(n, sum(x, middle, -1)), -half, half));
    }
    return result;
  }
  const auto& p = piece.points;
  bool inside = true;
  Number best = infinity;
  Vector result = p[0];
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector e = sum(p[(k + 1) % 3], p[k], -1), d = sum(x, p[k], -1);
    inside = inside && dot(cross(piece.normals[0], e), d) >= 0;
    const Vector on = sum(p[k], e, std::clamp(dot(d, e) / dot(e, e), Number(0), Number(1)));
    if (const Number distance = length(sum(x, on, -1)); distance < best) best = distance, result = on;
  }
  return inside ? sum(x, piece.normals[0], -dot(piece.normals[0], sum(x, p[0], -1))) : result;
}

/// Two pieces at one time.
class Pair {
 public:
  Pair(const Body& a, const Body& b) : a_(a), b_(b), acceleration_(a_.acceleration() + b_.acceleration()) {}

  struct Look {
    Number width;  ///< the greatest gap, or less than nothing: how deep they are in each other
    Number wait;   ///< for so long they are surely no deeper than the error
  };
  Look look(const Piece& a, const Piece& b, Number t, Number limit) {
    if (t != time_) a_.look(t), b_.look(t), time_ = t;
    see(seen_a_, a, a_), see(seen_b_, b, b_);
    way_ = sum(b_.origin, a_.origin, -1);
    radii_ = a.radius + b.radius;
    const Number of_a = radius_of(a), of_b = radius_of(b);
    error_ = 0x1p-50L * (length(way_) + of_a + of_b + radii_);
    bend_ = acceleration_ + a_.rate() * a_.rate() * of_a + b_.rate() * b_.rate() * of_b;
    best_ = {-infinity, {}};
    if (a.is_half_space) {
      const Vector& n = seen_a_.normals[0];
      Number low = infinity;
      for (const Vector& x : seen_b_.points) low = std::min(low, dot(n, x));
      return {dot(n, way_) + low - dot(n, seen_a_.points[0]) - radii_, wait_along(n, limit)};
    }
    // Often the middles tell enough.
    consider(sum(sum(way_, middle(seen_b_)), middle(seen_a_), -1));
    if (best_.width > 0) {
      if (const Number wait = wait_along(best_.n, limit); wait >= limit) return {best_.width, wait};
    }
    for (const Vector& n : seen_a_.normals) consider(n);
    for (const Vector& n : seen_b_.normals) consider(n);
    for (const Vector& u : seen_a_.edges) {
      for (const Vector& v : seen_b_.edges) consider(cross(u, v));
    }
    const auto is_hull = [](const Piece& piece) { return piece.counts == Piece::Counts::with_solids; };
    const bool ball_and_hull = (a.points.size() == 1 && is_hull(b)) || (b.points.size() == 1 && is_hull(a));
    if (a.points.size() == 2 || b.points.size() == 2 || ball_and_hull) {
      consider_ways(a, b);
    } else if (b.points.size() == 1) {
      const Vector centre = sum(way_, seen_b_.points[0]);
      consider(a.points.size() == 1 ? centre : sum(centre, nearest(seen_a_, centre), -1));
    } else if (a.points.size() == 1) {
      const Vector centre = sum(seen_a_.points[0], way_, -1);
      consider(sum(nearest(seen_b_, centre), centre, -1));
    }
    return {best_.width, wait_along(best_.n, limit)};
  }
  Number error() const { return error_; }
  /// How fast points of the two may move past each other.
  Number speed(const Piece& a, const Piece& b) const {
    return length(a_.velocity) + length(b_.velocity) + a_.rate() * radius_of(a) + b_.rate() * radius_of(b);
  }

 private:
  struct Best {
    Number width;
    Vector n;
  };

  static Number radius_of(const Piece& piece) {
    Number radius = 0;
    for (const Vector& x : piece.points) radius = std::max(radius, length(x));
    return radius;
  }
  static Vector middle(const Seen& piece) {
    Vector sum_of{};
    for (const Vector& p : piece.points) sum_of = sum(sum_of, p, Number(1) / static_cast<Number>(piece.points.size()));
    return sum_of;
  }

  void consider(const Vector& direction) {
    const Number size = length(direction);
    if (!(size > 0)) return;  // of edges that are nearly parallel it is off by more, and as good a proof
    Vector n = sum({0, 0, 0}, direction, 1 / size);
    Number low_a = infinity, high_a = -infinity, low_b = infinity, high_b = -infinity;
    for (const Vector& x : seen_a_.points) low_a = std::min(low_a, dot(n, x)), high_a = std::max(high_a, dot(n, x));
    for (const Vector& x : seen_b_.points) low_b = std::min(low_b, dot(n, x)), high_b = std::max(high_b, dot(n, x));
    const Number between = dot(n, way_);
    const Number forward = between + low_b - high_a - radii_, back = low_a - high_b - between - radii_;
    if (back > forward) n = sum({0, 0, 0}, n, -1);
    if (const Number width = std::max(forward, back); width > best_.width) best_ = {width, n};
  }

  /// Between corners, and between corners and edges.
  void consider_ways(const Piece& a, const Piece& b) {
    for (const Vector& x : seen_a_.points) {
      const Vector from = sum(way_, x, -1);
      for (const Vector& y : seen_b_.points) consider(sum(from, y));
      for (const auto& [i, j] : b.segments)
        consider(across(sum(from, seen_b_.points[i]), sum(from, seen_b_.points[j])));
    }
    for (const Vector& y : seen_b_.points) {
      const Vector to = sum(way_, y);
      for (const auto& [i, j] : a.segments) {
        consider(across(sum(to, seen_a_.points[i], -1), sum(to, seen_a_.points[j], -1)));
      }
    }
  }
  /// The point of the line through p and q that is nearest to the origin.
  static Vector across(const Vector& p, const Vector& q) {
    const Vector u = sum(q, p, -1);
    return sum(p, u, -dot(p, u) / dot(u, u));
  }

  Number wait_along(const Vector& n, Number limit) const {
    const Number base = dot(n, way_) - radii_ + error_;
    const Number rate = dot(n, sum(b_.velocity, a_.velocity, -1));
    const Vector by_a = cross(n, a_.spin()), by_b = cross(n, b_.spin());
    Number wait = limit;
    for (const Vector& x : seen_a_.points) {
      const Number gap_a = base - dot(n, x), rate_a = rate - dot(by_a, x);
      for (const Vector& y : seen_b_.points) {
        const Number g = gap_a + dot(n, y), r = rate_a + dot(by_b, y);
        if (!(g > 0)) return 0;
        if (g + wait * (r - wait * bend_ / 2) > 0) continue;
        wait = std::min(wait, 2 * g / (std::sqrt(r * r + 2 * g * bend_) - r));
      }
    }
    return wait;
  }

  Mover a_, b_;
  Number acceleration_;
  Number time_ = -infinity;
  Seen seen_a_, seen_b_;
  Vector way_{};
  Number radii_ = 0, error_ = 0, bend_ = 0;
  Best best_{};
};

}  // namespace

Piece half_space_piece(const Eigen::Vector3d& normal, double offset) {
  const Vector n = unit(vector(normal));
  Piece piece;
  piece.points = {sum({0, 0, 0}, n, offset)};
  piece.normals = {n};
  piece.is_half_space = true;
  return piece;
}

Piece ball_piece(double radius) {
  Piece piece;
  piece.points = {{0, 0, 0}};
  piece.radius = radius;
  return piece;
}

Piece capsule_piece(double radius, double half_length) {
  Piece piece;
  piece.points = {{0, 0, -half_length}, {0, 0, half_length}};
  piece.edges = {{0, 0, 1}};
  piece.radius = radius;
  piece.segments = {{0, 1}};
  return piece;
}

Piece box_piece(const Eigen::Vector3d& half) {
  Piece piece;
  for (int i = 0; i < 8; ++i) {
    piece.points.push_back({i & 1 ? half[0] : -half[0], i & 2 ? half[1] : -half[1], i & 4 ? half[2] : -half[2]});
  }
  piece.normals = piece.edges = {Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{0, 0, 1}};
  for (std::size_t i = 0; i < 8; ++i) {
    for (const std::size_t bit : {1, 2, 4}) {
      if (!(i & bit)) piece.segments.push_back({i, i | bit});
    }
  }
  return piece;
}

Piece polytope_piece(const std::vector<Eigen::Vector3d>& corners, const std::vector<Eigen::Vector3d>& normals,
                     const std::vector<std::array<std::size_t, 2>>& edges) {
  Piece piece;
  for (const Eigen::Vector3d& x : corners) piece.points.push_back(vector(x));
  for (const Eigen::Vector3d& n : normals) piece.normals.push_back(vector(n));
  for (const auto& [i, j] : edges) piece.edges.push_back(unit(sum(piece.points[j], piece.points[i], -1)));
  piece.segments = edges;
  return piece;
}

Piece triangle_piece(const std::array<Eigen::Vector3d, 3>& corners) {
  Piece piece;
  for (std::size_t k = 0; k < 3; ++k) {
    piece.points.push_back(vector(corners[k]));
    piece.edges.push_back(unit(sum(vector(corners[(k + 1) % 3]), vector(corners[k]), -1)));
    piece.segments.push_back({k, (k + 1) % 3});
  }
  piece.normals = {unit(cross(piece.edges[0], piece.edges[1]))};
  return piece;
}

Verdict check(const Body& a, const Body& b, double t0, double horizon, double contact, int* steps) {
  const bool meets = contact <= horizon;
  const Number end = meets ? contact : horizon;
  Pair pair(a, b);
  Number nearest_at_contact = infinity, allowed = 0;
  for (const Piece& x : a.pieces) {
    for (const Piece& y : b.pieces) {
      if (!x.meets(y) || !y.meets(x)) continue;
      // Up to the double before: contact is the first one just after which they penetrate.
      const Number until = meets ? std::nextafter(contact, -std::numeric_limits<double>::infinity()) : horizon;
      for (Number t = t0; t < until;) {
        if (++*steps > most_steps) return Verdict::undecided;
        const auto look = pair.look(x, y, t, until - t);
        if (!(look.wait > 0)) return Verdict::late;
        const Number next = t + look.wait;
        t = next > t ? next : std::nextafter(t, infinity);
      }
      if (!meets) continue;
      const auto look = pair.look(x, y, end, 0);
      nearest_at_contact = std::min(nearest_at_contact, look.width);
      allowed = std::max(allowed, 2 * pair.error() + 0x1p-52L * std::abs(end) * pair.speed(x, y));
    }
  }
  return meets && nearest_at_contact > allowed ? Verdict::early : Verdict::right;
}

}  // namespace turning_pairs
