#include "collision/ball_touch.hpp"

#include <algorithm>
#include <cmath>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

Vector3d unit(const Vector3d& v) {
  const double largest = v.cwiseAbs().maxCoeff();
  const Vector3d scaled = v / largest;
  return scaled / std::sqrt(dot(scaled, scaled));
}

template <std::size_t Size>
Vector3d at(const std::array<Vector3d, Size>& path, double tau) {
  Vector3d value = path[Size - 1];
  for (std::size_t i = Size - 1; i-- > 0;) value = path[i] + tau * value;
  return value;
}

/// f(tau) = |s(tau)|^2 - g(tau)^2 and its derivatives.
class DistanceQuartic {
 public:
  DistanceQuartic(const std::array<Vector3d, 3>& s, const std::array<double, 3>& g) : s_(s), g_(g) {}

  double value(double tau) const {
    const Vector3d place = at(s_, tau);
    const double reach = g_[0] + tau * (g_[1] + tau * g_[2]);
    const double distance = std::sqrt(dot(place, place));
    return (distance - reach) * (distance + reach);
  }

  double slope(double tau) const {
    const Vector3d velocity = s_[1] + (2 * tau) * s_[2];
    return 2 * (dot(at(s_, tau), velocity) - (g_[0] + tau * (g_[1] + tau * g_[2])) * (g_[1] + 2 * tau * g_[2]));
  }

  double bend(double tau) const { return b_[0] + tau * (b_[1] + tau * b_[2]); }

  /// Where the slope changes sign in (0, horizon), in order.
  struct Points {
    std::array<double, 3> at{};
    std::size_t size = 0;
  };
  Points turning_points(double horizon) const {
    Points bends;  // the slope is monotone between them
    if (b_[2] != 0 || b_[1] != 0) {
      if (b_[1] * b_[1] - 4 * b_[2] * b_[0] > 0) {
        const auto [falling, rising] = quadratic_roots(b_[0], b_[1], b_[2]);
        for (const double root : {std::min(falling, rising), std::max(falling, rising)}) {
          if (root > 0 && root < horizon) bends.at[bends.size++] = root;
        }
      }
    }
    return crossings([this](double tau) { return slope(tau); }, bends, horizon);
  }

  /// A double, at most two roundings after the change, at which g is negative or not as it is at `above`; it is
  /// otherwise at `below`. Regula falsi, Illinois variant, and halving now and then, so that it cannot creep.
  template <class Function>
  static double crossing(const Function& g, double below, double above) {
    constexpr double enough = 4 * 0x1p-53;
    double at_below = g(below);
    double at_above = g(above);
    const bool negative_above = at_above < 0;
    int moved = 0;  // the end that the last step replaced: -1 below, 1 above
    for (int step = 1; above - below > enough * above; ++step) {
      double middle = below + (above - below) * (at_below / (at_below - at_above));
      if (step % 8 == 0 || !(middle > below && middle < above)) middle = below + 0.5 * (above - below);
      if (!(middle > below && middle < above)) break;
      const double value = g(middle);
      if ((value < 0) == negative_above) {
        above = middle;
        at_above = value;
        if (moved == 1) at_below *= 0.5;
        moved = 1;
      } else {
        below = middle;
        at_below = value;
        if (moved == -1) at_above *= 0.5;
        moved = -1;
      }
    }
    return above;
  }

  /// Sign changes of g in (0, horizon), given points between which it is monotone.
  template <class Function>
  static Points crossings(const Function& g, const Points& monotone, double horizon) {
    Points found;
    double below = 0;
    for (std::size_t i = 0; i <= monotone.size && found.size < found.at.size(); ++i) {
      const double above = i < monotone.size ? monotone.at[i] : horizon;
      if ((g(below) < 0) != (g(above) < 0)) found.at[found.size++] = crossing(g, below, above);
      below = above;
    }
    return found;
  }

  /// When f < 0, from tau = 0 to the horizon.
  TimeSpans negative(double horizon) const {
    const Points turns = turning_points(horizon);
    const auto f = [this](double tau) { return value(tau); };
    TimeSpans spans;
    std::size_t n = 0;
    bool inside = f(0) < 0;
    if (inside) spans.begin[0] = -TimeSpans::infinity;
    double below = 0;
    for (std::size_t i = 0; i <= turns.size && n < 2; ++i) {
      const double above = i < turns.size ? turns.at[i] : horizon;
      if ((f(above) < 0) != inside) {
        const double change = crossing(f, below, above);
        (inside ? spans.end[n++] : spans.begin[n]) = change;
        inside = !inside;
      }
      below = above;
    }
    if (inside && n < 2) spans.end[n] = TimeSpans::infinity;
    return spans;
  }

 private:
  std::array<Vector3d, 3> s_;
  std::array<double, 3> g_;
  /// f'' about tau = 0: to cut the time into stretches, not to decide a sign of f.
  std::array<double, 3> b_{2 * (dot(s_[1], s_[1]) - g_[1] * g_[1] + 2 * (dot(s_[0], s_[2]) - g_[0] * g_[2])),
                           12 * (dot(s_[1], s_[2]) - g_[1] * g_[2]), 12 * (dot(s_[2], s_[2]) - g_[2] * g_[2])};
};

}  // namespace

TimeSpans near_spans(const std::array<Vector3d, 2>& s, const std::array<double, 2>& g, double) {
  const auto [g0, g1] = g;
  const double c2 = dot(s[1], s[1]) - g1 * g1;
  const double half_c1 = dot(s[0], s[1]) - g0 * g1;
  if (!(c2 > 0)) {
    // Moves not at all, or so slowly that the distance is known no better than the margin: along an edge.
    const double distance = std::sqrt(dot(s[0], s[0]));
    return negative_spans((distance - g0) * (distance + g0), 2 * half_c1, c2);
  }
  const double nearest = -half_c1 / c2;
  const Vector3d place = at(s, nearest);
  const double reach = g0 + g1 * nearest;
  const double distance = std::sqrt(dot(place, place));
  if (!(distance < reach)) return {};
  const double half = std::sqrt((reach - distance) * (reach + distance) / c2);
  return TimeSpans::between(nearest - half, nearest + half);
}

TimeSpans near_spans(const std::array<Vector3d, 3>& s, const std::array<double, 3>& g, double horizon) {
  return DistanceQuartic(s, g).negative(horizon);
}

NearestPoint nearest_point(const PlacedTriangle& triangle, const Vector3d& to) {
  const auto& v = triangle.vertices;
  const Vector3d normal = unit(cross(triangle.edge(0), triangle.edge(1)));
  bool inside = true;
  NearestPoint best{v[0], 0, 0};
  double least = TimeSpans::infinity;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d edge = triangle.edge(i);
    const Vector3d d = to - v[i];
    inside = inside && dot(cross(normal, edge), d) > 0;
    const double along = dot(edge, d);
    const double length = dot(edge, edge);
    NearestPoint candidate{v[i], 0, i};
    if (along >= length) {
      candidate = {v[(i + 1) % 3], 0, (i + 1) % 3};
    } else if (along > 0) {
      candidate = {v[i] + (along / length) * edge, 1, i};
    }
    const Vector3d apart = to - candidate.point;
    const double distance = dot(apart, apart);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  if (inside) return {to - dot(normal, to - v[0]) * normal, 2, 0};
  return best;
}

template <int Degree>
BallTouch<Degree>::BallTouch(const PlacedTriangle& triangle, const PlacedBall& ball,
                             const RelativeMotion<Degree>& motion, const ContactGap<Degree>& gap, double horizon,
                             const TimeWindow& interest)
    : triangle_(triangle),
      radius_(ball.radius),
      motion_(motion),
      gap_(gap),
      horizon_(horizon),
      interest_{std::max(interest.begin, 0.0), std::min(interest.end, horizon)} {
  add_face();
  for (std::size_t i = 0; i < 3; ++i) add_edge(i);
  for (std::size_t i = 0; i < 3; ++i) add_vertex(i);
}

template <int Degree>
auto BallTouch<Degree>::from(std::size_t vertex) const -> Path {
  Path path = motion_.coefficients;
  path[0] -= triangle_.vertices[vertex];
  return path;
}

/// What is left of the motion when that along the edge is taken out.
template <int Degree>
auto BallTouch<Degree>::across_edge(std::size_t i) const -> Path {
  const Vector3d along = unit(triangle_.edge(i));
  Path path = from(i);
  for (Vector3d& c : path) c -= dot(along, c) * along;
  return path;
}

/// When normal . r - reach < gap.
template <int Degree>
TimeSpans BallTouch<Degree>::below(const Vector3d& normal, double reach) const {
  const auto& r = motion_.coefficients;
  if constexpr (Degree == 1) {
    return negative_spans(dot(normal, r[0]) - reach - gap_.c[0], dot(normal, r[1]) - gap_.c[1]);
  } else {
    return negative_spans(dot(normal, r[0]) - reach - gap_.c[0], dot(normal, r[1]) - gap_.c[1],
                          dot(normal, r[2]) - gap_.c[2]);
  }
}

/// Whether the path comes near the origin within the window of interest, judged by its chord.
template <int Degree>
bool BallTouch<Degree>::matters(const Path& path) const {
  const double length = interest_.end - interest_.begin;
  const Vector3d begin = at(path, interest_.begin);
  const Vector3d along = at(path, interest_.end) - begin;
  const double square = dot(along, along);
  const double part = square > 0 ? std::clamp(-dot(begin, along) / square, 0.0, 1.0) : 0.0;
  const Vector3d nearest = begin + part * along;
  double reach = radius_ + 4 * gap_(interest_.end);
  if constexpr (Degree == 2) reach += 0.25 * length * length * std::sqrt(dot(path[2], path[2]));
  return !(dot(nearest, nearest) > reach * reach);
}

template <int Degree>
TimeSpans BallTouch<Degree>::within(const Path& path) const {
  std::array<double, Degree + 1> reach = gap_.c;
  reach[0] += radius_;
  return near_spans(path, reach, horizon_);
}

template <int Degree>
void BallTouch<Degree>::add_face() {
  const Vector3d normal = unit(cross(triangle_.edge(0), triangle_.edge(1)));
  Piece piece;
  for (const double side : {1.0, -1.0}) {
    const Vector3d out = side * normal;
    piece.conditions[piece.size++] = below(out, triangle_.project(out).high + radius_);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d out = unit(cross(triangle_.edge(i), normal));
    piece.conditions[piece.size++] =
        below(out, std::max(dot(out, triangle_.vertices[i]), dot(out, triangle_.vertices[(i + 1) % 3])));
  }
  pieces_[size_++] = piece;
}

template <int Degree>
void BallTouch<Degree>::add_edge(std::size_t i) {
  const Vector3d along = unit(triangle_.edge(i));
  Piece piece;
  piece.conditions[piece.size++] = below(along, dot(along, triangle_.vertices[(i + 1) % 3]));
  piece.conditions[piece.size++] = below(-along, -dot(along, triangle_.vertices[i]));
  // The costly condition last, and only if it counts.
  if (!(first_inside_all(piece.spans(), interest_.begin) <= interest_.end)) return;
  const Path path = across_edge(i);
  if (!matters(path)) return;
  piece.conditions[piece.size++] = within(path);
  pieces_[size_++] = piece;
}

template <int Degree>
void BallTouch<Degree>::add_vertex(std::size_t i) {
  const Path path = from(i);
  if (!matters(path)) return;
  Piece piece;
  piece.conditions[piece.size++] = within(path);
  pieces_[size_++] = piece;
}

template <int Degree>
double BallTouch<Degree>::first_inside(double tau) const {
  double first = TimeSpans::infinity;
  for (std::size_t i = 0; i < size_; ++i) first = std::min(first, first_inside_all(pieces_[i].spans(), tau));
  return first;
}

template <int Degree>
double BallTouch<Degree>::enter(double tau) const {
  // Downwards through the pieces that contain the time, as far as they reach.
  double begin = TimeSpans::infinity;
  for (std::size_t i = 0; i < size_; ++i) {
    if (pieces_[i].contains(tau)) begin = std::min(begin, enter_all(pieces_[i].spans(), tau));
  }
  return begin;
}

template <int Degree>
double BallTouch<Degree>::leave(double tau) const {
  for (bool moved = true; moved;) {
    moved = false;
    for (std::size_t i = 0; i < size_; ++i) {
      if (tau == TimeSpans::infinity) return tau;
      if (!pieces_[i].contains(tau)) continue;
      tau = leave_all(pieces_[i].spans(), tau);
      moved = true;
    }
  }
  return tau;
}

template <int Degree>
TouchDirection BallTouch<Degree>::direction(double tau) const {
  const Vector3d centre = motion_.position(tau);
  const Vector3d velocity = motion_.velocity(tau);
  const NearestPoint nearest = nearest_point(triangle_, centre);
  const Vector3d apart = centre - nearest.point;
  const auto speeds = smallest_speeds(motion_);
  if (!(apart.cwiseAbs().maxCoeff() > 0)) {
    // The centre passes through the surface: from now on it moves away.
    const Vector3d normal = unit(cross(triangle_.edge(0), triangle_.edge(1)));
    return {dot(normal, velocity) < 0 ? Vector3d(-normal) : normal, -radius_, false};
  }
  const Vector3d normal = unit(apart);
  const double distance = std::sqrt(dot(apart, apart));
  const double rate = dot(normal, velocity);
  bool approaching = rate < 0;
  if (std::abs(rate) <= speeds[0] + tau * speeds[1]) {
    // Second derivative of the distance: bending towards the surface beats leaving its round.
    Vector3d sideways = velocity - rate * normal;
    if (nearest.dimension == 1) {
      const Vector3d along = unit(triangle_.edge(nearest.index));
      sideways -= dot(along, sideways) * along;
    }
    const double round = nearest.dimension == 2 ? 0.0 : dot(sideways, sideways) / distance;
    approaching = dot(normal, motion_.acceleration()) + round < -speeds[1];
  }
  return {normal, distance - radius_, approaching};
}

template <int Degree>
double BallTouch<Degree>::turning(double tau, double end) const {
  if constexpr (Degree == 2) {
    // Where the distance to a part of the triangle has a maximum while that part is the nearest.
    const auto consider = [&](double top, double distance) {
      if (!(top > tau && top < end)) return;
      const Vector3d centre = motion_.position(top);
      const Vector3d apart = centre - nearest_point(triangle_, centre).point;
      if (distance <= std::sqrt(dot(apart, apart)) + gap_(top) / 4) end = top;
    };
    const auto consider_path = [&](const Path& path) {
      const DistanceQuartic quartic(path, {0, 0, 0});
      const auto points = quartic.turning_points(horizon_);
      for (std::size_t i = 0; i < points.size; ++i) {
        const double top = points.at[i];
        if (quartic.bend(top) < 0) consider(top, at(path, top).norm());
      }
    };
    const Vector3d normal = unit(cross(triangle_.edge(0), triangle_.edge(1)));
    const double p1 = dot(normal, motion_.coefficients[1]);
    const double p2 = dot(normal, motion_.coefficients[2]);
    if (p2 != 0) {
      const double top = -p1 / (2 * p2);
      const double height = dot(normal, motion_.position(top) - triangle_.vertices[0]);
      if ((height > 0) == (p2 < 0)) consider(top, std::abs(height));
    }
    for (std::size_t i = 0; i < 3; ++i) consider_path(across_edge(i));
    for (std::size_t i = 0; i < 3; ++i) consider_path(from(i));
  }
  return end;
}

template class BallTouch<1>;
template class BallTouch<2>;

}  // namespace kds::collision
