// Signs of certificates that are asked for again and again, and when they change.
#pragma once

#include "certificates/turning/edge_edge_separation.hpp"
#include "certificates/turning/normal_along_edge.hpp"
#include "certificates/turning/vertex_face_separation.hpp"
#include "kds/turning/turning_certificate.hpp"
#include "kds/turning/turning_failure_time.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace kds::collision {

/// Remembers the signs of certificates that were asked for. Where two edges of meshes meet, so do the triangles on both
/// sides of each, and where a vertex meets a triangle, so do all triangles around it: one certificate tells the time
/// for all these pairs. And each pair asks for it several times: whether the two penetrate, when they part, where they
/// touch.
///
/// Law: answers are those of kds::sign_after, failure_time and recovery_time. These tell for all doubles of a stretch
/// which sign a certificate has just after them. One that is zero just after a time is zero at all times, which costs
/// the most to tell, and is remembered apart. All certificates are of the same two motions, which must stay at their
/// addresses.
class RememberedSigns {
 public:
  template <class C>
  int sign_after(const C& certificate, double t) {
    if constexpr (!is_shared<C>()) {
      return new_sign(certificate, t);
    } else {
      const Key key = key_of(certificate);
      if (const Stretch* const known = find(key, t)) return known->sign;
      const int sign = new_sign(certificate, t);
      if (sign != 0) remember({key, t, t, sign, false});
      return sign;
    }
  }

  template <class C>
  bool vanishes(const C& certificate) {
    if (is_known_zero(certificate)) return true;
    if (!kds::vanishes(certificate)) return false;
    remember_zero(certificate);
    return true;
  }

  template <class C>
  double failure_time(const C& certificate, double t, double until) {
    return change(certificate, 1, t, until);
  }
  template <class C>
  double recovery_time(const C& certificate, double t, double until) {
    return change(certificate, -1, t, until);
  }

 private:
  enum class Kind : unsigned char { vertex_and_face, two_edges, normal_and_edge };
  /// What a certificate is made of, apart from the two motions of the pair.
  template <std::size_t Points>
  struct KeyOf {
    Kind kind;  ///< two bodies may have points of the same coordinates
    const void* first_motion;
    std::array<double, 3 * Points> coordinates;
    friend bool operator==(const KeyOf&, const KeyOf&) = default;
  };
  using Key = KeyOf<4>;
  /// Of a certificate that is zero, in whatever order its points are named.
  using ZeroKey = KeyOf<5>;
  /// Of a certificate from one time to another.
  struct Stretch {
    Key key;
    double from, to;
    int sign;      ///< just after each double before the last
    bool changes;  ///< just after the last it is the other; else it is this, too
    bool holds(double t) const { return from <= t && (changes ? t < to : t <= to); }
  };

  template <std::size_t Points>
  static void put(KeyOf<Points>& key, std::size_t place, const Eigen::Vector3d& x) {
    for (std::size_t d = 0; d < 3; ++d) key.coordinates[3 * place + d] = x[static_cast<Eigen::Index>(d)];
  }
  template <int Degree>
  static Key key_of(const certificates::VertexFaceSeparation<Degree>& c) {
    Key key{Kind::vertex_and_face, &c.a, {}};
    put(key, 0, c.vertex);
    for (std::size_t i = 0; i < 3; ++i) put(key, 1 + i, c.corners[i]);
    return key;
  }
  /// With both edges the other way round it is the same function.
  template <int Degree>
  static Key key_of(const certificates::EdgeEdgeSeparation<Degree>& c) {
    Key key{Kind::two_edges, &c.a, {}};
    const auto& u = c.edge_a;
    const bool swap = std::lexicographical_compare(u[1].data(), u[1].data() + 3, u[0].data(), u[0].data() + 3);
    for (std::size_t i = 0; i < 2; ++i) {
      put(key, i, c.edge_a[swap ? 1 - i : i]);
      put(key, 2 + i, c.edge_b[swap ? 1 - i : i]);
    }
    return key;
  }

  /// Points in the order of their coordinates.
  template <std::size_t Points>
  static void put_sorted(ZeroKey& key, std::size_t place, std::array<Eigen::Vector3d, Points> points) {
    std::sort(points.begin(), points.end(), [](const Eigen::Vector3d& x, const Eigen::Vector3d& y) {
      return std::lexicographical_compare(x.data(), x.data() + 3, y.data(), y.data() + 3);
    });
    for (const Eigen::Vector3d& x : points) put(key, place++, x);
  }
  template <int Degree>
  static ZeroKey zero_key_of(const certificates::VertexFaceSeparation<Degree>& c) {
    ZeroKey key{Kind::vertex_and_face, &c.a, {}};
    put(key, 0, c.vertex);
    put_sorted(key, 1, c.corners);
    return key;
  }
  template <int Degree>
  static ZeroKey zero_key_of(const certificates::EdgeEdgeSeparation<Degree>& c) {
    ZeroKey key{Kind::two_edges, &c.a, {}};
    put_sorted(key, 0, c.edge_a);
    put_sorted(key, 2, c.edge_b);
    return key;
  }
  template <int Degree>
  static ZeroKey zero_key_of(const certificates::NormalAlongEdge<Degree>& c) {
    ZeroKey key{Kind::normal_and_edge, &c.a, {}};
    put_sorted(key, 0, c.corners);
    put_sorted(key, 3, c.edge);
    return key;
  }
  template <class C>
  static constexpr bool zeros_are_kept() {
    return requires(const C& certificate) { zero_key_of(certificate); };
  }
  template <class C>
  bool is_known_zero(const C& certificate) const {
    if constexpr (zeros_are_kept<C>()) {
      return !zeros_.empty() && std::find(zeros_.begin(), zeros_.end(), zero_key_of(certificate)) != zeros_.end();
    }
    return false;
  }
  template <class C>
  void remember_zero(const C& certificate) {
    if constexpr (zeros_are_kept<C>()) {
      constexpr std::size_t most = 256;
      if (zeros_.size() < most) {
        zeros_.push_back(zero_key_of(certificate));
      } else {
        zeros_[oldest_zero_++ % most] = zero_key_of(certificate);
      }
    }
  }

  template <class C>
  static constexpr bool is_shared() {
    return requires(const C& certificate) { key_of(certificate); };
  }

  Stretch* find(const Key& key, double t) {
    for (Stretch& known : known_) {
      if (known.holds(t) && known.key == key) return &known;
    }
    return nullptr;
  }

  /// Of what is not remembered, unless it is zero.
  template <class C>
  int new_sign(const C& certificate, double t) {
    if (is_known_zero(certificate)) return 0;
    const int sign = kds::sign_after(certificate, t);
    if (sign == 0) remember_zero(certificate);
    return sign;
  }

  void remember(const Stretch& stretch) {
    constexpr std::size_t most = 16;
    if (known_.size() < most) {
      known_.push_back(stretch);
    } else {
      known_[oldest_++ % most] = stretch;
    }
  }

  /// The first double in [t, until] just after which the sign is not `side`, but the other; or `never`.
  template <class C>
  double change(const C& certificate, int side, double t, double until) {
    if (!(t <= until)) return never;
    const int sign = sign_after(certificate, t);
    if (sign != side) return sign == 0 ? never : t;
    if constexpr (!is_shared<C>()) {
      return kds::change_of_sign(certificate, side, t, until);
    } else {
      const Key key = key_of(certificate);
      Stretch& known = *find(key, t);
      if (known.changes) return known.to <= until ? known.to : never;
      if (known.to >= until) return never;
      const double time = kds::change_of_sign(certificate, side, known.to, until);
      known.to = std::min(time, until);
      known.changes = time != never;
      if (known.changes) remember({key, time, time, -side, false});
      return time;
    }
  }

  std::vector<Stretch> known_;
  std::size_t oldest_ = 0;
  std::vector<ZeroKey> zeros_;
  std::size_t oldest_zero_ = 0;
};

}  // namespace kds::collision
