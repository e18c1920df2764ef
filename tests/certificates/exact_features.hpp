// Vertex-face and edge-edge contact over exact numbers: the first touch, and the distance at a time.
#pragma once

#include "tests/support/exact_algebra.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace kds::tests {

using Place = std::array<oracle::Rational, 3>;
using Path = std::array<oracle::Polynomial, 3>;

template <class V>
V minus(const V& a, const V& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class V>
V cross(const V& a, const V& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class V>
auto dot(const V& a, const V& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Four points: a vertex and its face, or two edges.
enum class Features { vertex_face, edge_edge };

/// The place of four moving points.
inline std::array<Place, 4> places(const std::array<Path, 4>& paths, const oracle::Rational& t) {
  std::array<Place, 4> result;
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t d = 0; d < 3; ++d) result[k][d] = paths[k][d](t);
  }
  return result;
}

inline Place along(const Place& a, const Place& ab, const oracle::Rational& x) {
  return {a[0] + ab[0] * x, a[1] + ab[1] * x, a[2] + ab[2] * x};
}
inline oracle::Rational squared_length(const Place& v) { return dot(v, v); }

inline oracle::Rational squared_distance_to_segment(const Place& p, const Place& a, const Place& b) {
  const Place ab = minus(b, a);
  const oracle::Rational length = squared_length(ab);
  oracle::Rational x = 0;
  if (length.sign() > 0) x = std::clamp(dot(minus(p, a), ab) / length, oracle::Rational(0), oracle::Rational(1));
  return squared_length(minus(p, along(a, ab, x)));
}

/// By exhaustion: the feet inside both features, and all distances to their rims.
inline oracle::Rational squared_distance(Features kind, const std::array<Place, 4>& p) {
  const bool face = kind == Features::vertex_face;
  std::vector<oracle::Rational> found;
  if (face) {
    for (std::size_t k = 1; k < 4; ++k) found.push_back(squared_distance_to_segment(p[0], p[k], p[k % 3 + 1]));
  } else {
    found = {squared_distance_to_segment(p[0], p[2], p[3]), squared_distance_to_segment(p[1], p[2], p[3]),
             squared_distance_to_segment(p[2], p[0], p[1]), squared_distance_to_segment(p[3], p[0], p[1])};
  }
  // q = w + x u + y v with q across u and v.
  const Place w = face ? minus(p[0], p[1]) : minus(p[0], p[2]);
  const Place u = face ? minus(p[1], p[2]) : minus(p[1], p[0]);
  const Place v = face ? minus(p[1], p[3]) : minus(p[2], p[3]);
  const Place n = cross(u, v);
  const oracle::Rational n2 = squared_length(n);
  if (n2.sign() > 0) {
    const oracle::Rational x = dot(n, cross(v, w));
    const oracle::Rational y = -dot(n, cross(u, w));
    const bool inside = x.sign() >= 0 && y.sign() >= 0 && (face ? x + y <= n2 : (x <= n2 && y <= n2));
    if (inside) found.push_back(oracle::square(dot(n, w)) / n2);
  }
  return *std::min_element(found.begin(), found.end());
}

/// Sign of g at an instant; exact, also where it is zero.
inline int sign_at(const oracle::Polynomial& g, const oracle::Instant& r) {
  if (r.is_rational()) return g(r.low()).sign();
  if (g.degree() < 0) return 0;
  bool may_vanish = true;
  for (int bits = 60;; bits *= 2) {
    r.narrow(bits);
    if (r.is_rational()) return g(r.low()).sign();
    const auto zeros = oracle::roots(g, r.low(), r.high());
    const int sign = g(r.low()).sign();
    if (zeros.empty() && sign != 0) return sign;
    if (may_vanish && std::any_of(zeros.begin(), zeros.end(), [&](const auto& zero) { return zero == r; })) return 0;
    may_vanish = false;
  }
}

/// Whether and when two features touch, ends of the time included.
class ExactFeatures {
 public:
  ExactFeatures(Features kind, const std::array<Path, 4>& paths) : kind_(kind), p_(paths) {
    const Path ab = minus(p_[1], p_[0]);
    volume_ = dot(cross(ab, minus(p_[2], p_[0])), minus(p_[3], p_[0]));
    if (kind == Features::vertex_face) {
      n_ = cross(minus(p_[2], p_[1]), minus(p_[3], p_[1]));
      for (std::size_t k = 1; k < 4; ++k) sides_.push_back(side(p_[0], p_[k], p_[k % 3 + 1]));
    } else {
      n_ = cross(ab, minus(p_[3], p_[2]));
      sides_ = {side(p_[2], p_[0], p_[1]), side(p_[3], p_[0], p_[1]), side(p_[0], p_[2], p_[3]),
                side(p_[1], p_[2], p_[3])};
    }
    if (kind == Features::vertex_face) {
      for (std::size_t k = 1; k < 4; ++k) segments_.push_back(segment(p_[0], p_[k], p_[k % 3 + 1]));
    } else {
      segments_ = {segment(p_[0], p_[2], p_[3]), segment(p_[1], p_[2], p_[3]), segment(p_[2], p_[0], p_[1]),
                   segment(p_[3], p_[0], p_[1])};
    }
  }

  std::optional<oracle::Instant> first_touch(double t0, double t1) const {
    const oracle::Rational begin = oracle::rational(t0);
    const oracle::Rational end = oracle::rational(t1);
    if (const oracle::Instant start(begin); touch(start)) return start;
    std::vector<oracle::Instant> candidates;
    const auto add = [&](const oracle::Polynomial& g) {
      for (const auto& r : oracle::roots(g, begin, end)) candidates.push_back(r);
    };
    if (volume_.degree() >= 0) {
      add(volume_);
    } else {  // In one plane for ever: a closed set of times begins where something changes.
      for (const auto& g : n_) add(g);
      for (const auto& g : sides_) add(g);
      for (const auto& s : segments_) {
        for (const auto& g : s.across) add(g);
        add(s.between);
      }
    }
    std::sort(candidates.begin(), candidates.end());
    for (const auto& r : candidates) {
      if (touch(r)) return r;
    }
    return std::nullopt;
  }

 private:
  struct Segment {
    Path across;                 // zero while the point is on the line, or the segment is a point
    oracle::Polynomial between;  // not positive then, if it is on the segment
  };

  static Segment segment(const Path& p, const Path& a, const Path& b) {
    const Path pa = minus(p, a);
    return {cross(pa, minus(b, a)), dot(pa, minus(p, b))};
  }
  oracle::Polynomial side(const Path& p, const Path& a, const Path& b) const {
    return dot(n_, cross(minus(b, a), minus(p, a)));
  }

  bool touch(const oracle::Instant& t) const {
    if (sign_at(volume_, t) != 0) return false;
    const bool flat = std::all_of(n_.begin(), n_.end(), [&](const auto& g) { return sign_at(g, t) == 0; });
    if (!flat) {
      std::vector<int> s;
      for (const auto& g : sides_) s.push_back(sign_at(g, t));
      if (kind_ == Features::vertex_face) return *std::min_element(s.begin(), s.end()) >= 0;
      return s[0] * s[1] <= 0 && s[2] * s[3] <= 0;
    }
    return std::any_of(segments_.begin(), segments_.end(), [&](const Segment& s) {
      return std::all_of(s.across.begin(), s.across.end(), [&](const auto& g) { return sign_at(g, t) == 0; }) &&
             sign_at(s.between, t) <= 0;
    });
  }

  Features kind_;
  std::array<Path, 4> p_;
  oracle::Polynomial volume_;
  Path n_;
  std::vector<oracle::Polynomial> sides_;
  std::vector<Segment> segments_;
};

}  // namespace kds::tests
