// When certificates fail that several pairs of triangles share.
#pragma once

#include "certificates/turning/edge_edge_separation.hpp"
#include "certificates/turning/vertex_face_separation.hpp"
#include "kds/turning/turning_failure_time.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace kds::collision {

/// Remembers failure times. Where two edges of meshes meet the two triangles on either side of each do, too, and with a
/// vertex all that are around it: of all these pairs one certificate says when.
///
/// Law: answers are those of kds::failure_time and kds::sign_after. A certificate that first fails at T, seen from t,
/// is positive just after each double from t on, and negative just after T.
class SharedFailures {
 public:
  template <class C>
  double failure_time(const C& certificate, double t, double until) {
    return kds::failure_time(certificate, t, until);
  }
  template <int Degree>
  double failure_time(const certificates::EdgeEdgeSeparation<Degree>& certificate, double t, double until) {
    return remembered(certificate, t, until);
  }
  template <int Degree>
  double failure_time(const certificates::VertexFaceSeparation<Degree>& certificate, double t, double until) {
    return remembered(certificate, t, until);
  }

  template <class C>
  int sign_after(const C& certificate, double t) const {
    return kds::sign_after(certificate, t);
  }
  template <int Degree>
  int sign_after(const certificates::EdgeEdgeSeparation<Degree>& certificate, double t) const {
    return remembered_sign(certificate, t);
  }
  template <int Degree>
  int sign_after(const certificates::VertexFaceSeparation<Degree>& certificate, double t) const {
    return remembered_sign(certificate, t);
  }

 private:
  /// What a certificate is made of, apart from the two motions of the pair.
  struct Key {
    const void* first_motion;
    std::array<double, 12> coordinates;
    friend bool operator==(const Key&, const Key&) = default;
  };
  struct Failure {
    Key key;
    double from, time;  ///< it is the first from then on
  };

  static void put(Key& key, std::size_t place, const Eigen::Vector3d& x) {
    for (std::size_t d = 0; d < 3; ++d) key.coordinates[3 * place + d] = x[static_cast<Eigen::Index>(d)];
  }
  template <int Degree>
  static Key key_of(const certificates::VertexFaceSeparation<Degree>& c) {
    Key key{&c.a, {}};
    put(key, 0, c.vertex);
    for (std::size_t i = 0; i < 3; ++i) put(key, 1 + i, c.corners[i]);
    return key;
  }
  /// With both edges the other way round it is the same function.
  template <int Degree>
  static Key key_of(const certificates::EdgeEdgeSeparation<Degree>& c) {
    Key key{&c.a, {}};
    const auto& u = c.edge_a;
    const bool swap = std::lexicographical_compare(u[1].data(), u[1].data() + 3, u[0].data(), u[0].data() + 3);
    for (std::size_t i = 0; i < 2; ++i) {
      put(key, i, c.edge_a[swap ? 1 - i : i]);
      put(key, 2 + i, c.edge_b[swap ? 1 - i : i]);
    }
    return key;
  }

  const Failure* find(const Key& key, double t) const {
    for (const Failure& known : known_) {
      if (known.from <= t && t <= known.time && known.key == key) return &known;
    }
    return nullptr;
  }

  template <class C>
  double remembered(const C& certificate, double t, double until) {
    constexpr std::size_t most = 8;
    const Key key = key_of(certificate);
    if (const Failure* const known = find(key, t)) return known->time <= until ? known->time : never;
    const double time = kds::failure_time(certificate, t, until);
    if (time == never) return never;
    if (known_.size() < most) {
      known_.push_back({key, t, time});
    } else {
      known_[oldest_++ % most] = {key, t, time};
    }
    return time;
  }

  template <class C>
  int remembered_sign(const C& certificate, double t) const {
    if (!known_.empty()) {
      if (const Failure* const known = find(key_of(certificate), t)) return t < known->time ? 1 : -1;
    }
    return kds::sign_after(certificate, t);
  }

  std::vector<Failure> known_;
  std::size_t oldest_ = 0;
};

}  // namespace kds::collision
