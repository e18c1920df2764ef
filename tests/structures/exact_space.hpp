// Moving points of space, with weights or without, and what is exactly true of them at an instant.
#pragma once

#include "certificates/point_motion.hpp"
#include "certificates/weighted_point.hpp"
#include "kds/framework/moving_set.hpp"
#include "tests/support/exact_algebra.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace kds::tests {

/// Points just after a time, exactly. Shares no code with the library. Values at that time decide where they are not
/// zero; polynomials where they are.
class ExactSpace {
 public:
  template <class Path>
  ExactSpace(const MovingSet<Path>& set, double now) : now_(oracle::rational(now)) {
    for (const Id id : set.ids()) {
      Point& p = points_[id];
      const auto put = [&](std::size_t i, const auto& motion) {
        p.path[i] = oracle::Polynomial::motion({motion.position.c.begin(), motion.position.c.end()}, motion.start);
      };
      for (int d = 0; d < 3; ++d) put(static_cast<std::size_t>(d), set[id].axis(d));
      p.path[3] = p.path[0] * p.path[0] + p.path[1] * p.path[1] + p.path[2] * p.path[2];
      if constexpr (certificates::Weighted<Path>) {
        put(4, set[id].weight());
        p.path[3] = p.path[3] - p.path[4];
      }
      for (std::size_t i = 0; i < 4; ++i) p.value[i] = p.path[i](now_);
      ids_.push_back(id);
    }
  }
  const std::vector<Id>& ids() const { return ids_; }

  /// > 0 if a, b, c turn counter-clockwise seen from d.
  int orientation(Id a, Id b, Id c, Id d) const {
    return sign([&](auto&& at) {
      const auto u = from(at, a, b), v = from(at, a, c), w = from(at, a, d);
      return u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
             u[2] * (v[0] * w[1] - v[1] * w[0]);
    });
  }
  /// < 0 if the lifted point of e is below the hyperplane through those of a, b, c, d, which are positively oriented;
  /// if it stays on it, as if heights were larger by numbers that are infinitely small, more so for greater ids.
  int above(const std::array<Id, 4>& abcd, Id e) const {
    const std::array<Id, 5> p{abcd[0], abcd[1], abcd[2], abcd[3], e};
    const int plain = sign([&](auto&& at) {
      // Height by height, each times the volume of the other four.
      auto sum = at(p[0], 3) * volume(at, p[1], p[2], p[3], p[4]);
      sum = sum - at(p[1], 3) * volume(at, p[0], p[2], p[3], p[4]);
      sum = sum + at(p[2], 3) * volume(at, p[0], p[1], p[3], p[4]);
      sum = sum - at(p[3], 3) * volume(at, p[0], p[1], p[2], p[4]);
      return sum + at(p[4], 3) * volume(at, p[0], p[1], p[2], p[3]);
    });
    if (plain != 0) return plain;
    std::array<Id, 5> order = p;
    std::sort(order.begin(), order.end());
    for (const Id id : order) {
      std::vector<Id> rest;
      int parity = 1;
      for (std::size_t i = 0; i < 5; ++i) {
        if (p[i] == id) parity = i % 2 == 0 ? 1 : -1;
        if (p[i] != id) rest.push_back(p[i]);
      }
      if (const int s = orientation(rest[0], rest[1], rest[2], rest[3])) return s * parity;
    }
    return 0;
  }

 private:
  struct Point {
    std::array<oracle::Polynomial, 5> path;
    std::array<oracle::Rational, 4> value;
  };
  template <class At>
  static auto from(At&& at, Id a, Id b) {
    return std::array{at(b, 0) - at(a, 0), at(b, 1) - at(a, 1), at(b, 2) - at(a, 2)};
  }
  template <class At>
  static auto volume(At&& at, Id a, Id b, Id c, Id d) {
    const auto u = from(at, a, b), v = from(at, a, c), w = from(at, a, d);
    return u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0]);
  }
  template <class Formula>
  int sign(Formula&& formula) const {
    const oracle::Rational value = formula([&](Id id, std::size_t i) { return points_.at(id).value[i]; });
    if (value.sign() != 0) return value.sign();
    const oracle::Polynomial f = formula([&](Id id, std::size_t i) { return points_.at(id).path[i]; });
    return f.sign_after(now_);
  }

  oracle::Rational now_;
  std::map<Id, Point> points_;
  std::vector<Id> ids_;
};

/// The regular triangulation by brute force: all tetrahedra that no point is inside the sphere of. Corners ascending.
inline std::set<std::array<Id, 4>> regular_triangulation(const ExactSpace& space) {
  std::set<std::array<Id, 4>> result;
  const auto& ids = space.ids();
  for (std::size_t i = 0; i < ids.size(); ++i) {
    for (std::size_t j = i + 1; j < ids.size(); ++j) {
      for (std::size_t k = j + 1; k < ids.size(); ++k) {
        for (std::size_t l = k + 1; l < ids.size(); ++l) {
          std::array<Id, 4> corners{ids[i], ids[j], ids[k], ids[l]};
          const int side = space.orientation(corners[0], corners[1], corners[2], corners[3]);
          if (side == 0) continue;
          if (side < 0) std::swap(corners[0], corners[1]);
          const bool empty = std::all_of(ids.begin(), ids.end(), [&](Id e) {
            return std::find(corners.begin(), corners.end(), e) != corners.end() || space.above(corners, e) > 0;
          });
          std::sort(corners.begin(), corners.end());
          if (empty) result.insert(corners);
        }
      }
    }
  }
  return result;
}

/// Compares a structure with brute force: the number of tetrahedra that are there and should not be, or the other way
/// round, and of points that are neither vertices nor hidden.
template <class Rule, class Path>
int check_space(const Rule& rule, const MovingSet<Path>& set, double now) {
  const ExactSpace space(set, now);
  std::set<std::array<Id, 4>> found;
  int wrong = 0;
  for (std::uint32_t t = 0; t < rule.mesh().end_tetrahedron(); ++t) {
    if (!rule.mesh().in_use(t) || !rule.mesh().finite(t)) continue;
    auto corners = rule.mesh().corners(t);
    std::sort(corners.begin(), corners.end());
    wrong += !found.insert(corners).second;
  }
  const auto expected = regular_triangulation(space);
  for (const auto& corners : found) wrong += !expected.contains(corners);
  for (const auto& corners : expected) wrong += !found.contains(corners);
  wrong += rule.flat() != expected.empty();
  for (const Id id : set.ids()) wrong += !rule.flat() && rule.mesh().contains(id) == rule.hidden().contains(id);
  return wrong;
}

}  // namespace kds::tests
