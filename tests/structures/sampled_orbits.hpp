// Points on circles of which a structure knows samples only, and a Delaunay triangulation of them held against the
// truth.
#pragma once

#include "certificates/in_circle.hpp"
#include "certificates/plane_motion.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/uncertain.hpp"
#include "structures/delaunay.hpp"
#include "tests/support/random_numbers.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <vector>

namespace kds::tests {

/// Points that go round, slowly, each about a centre of its own.
class Orbits {
 public:
  Orbits(Random& random, Id n) : orbits_(n) {
    for (Orbit& o : orbits_) {
      o = {random.between(-1, 1), random.between(-1, 1), random.between(0, 0.1), random.between(-0.5, 0.5)};
    }
  }

  std::size_t size() const { return orbits_.size(); }
  std::array<double, 2> position(Id id, double t) const {
    const auto [x, y, r, w] = orbits_[id];
    return {x + r * std::cos(w * t), y + r * std::sin(w * t)};
  }
  std::array<double, 2> velocity(Id id, double t) const {
    const auto [x, y, r, w] = orbits_[id];
    return {-r * w * std::sin(w * t), r * w * std::cos(w * t)};
  }
  double speed(Id id) const { return orbits_[id].radius * std::abs(orbits_[id].frequency); }
  double acceleration(Id id) const { return speed(id) * std::abs(orbits_[id].frequency); }

 private:
  struct Orbit {
    double x, y, radius, frequency;
  };
  std::vector<Orbit> orbits_;
};

/// In-circle tests of a triangulation of samples: all of them, those that are guaranteed, and those of them that fail.
struct InCircleTests {
  int all = 0, guaranteed = 0, wrong = 0;

  template <class Sample>
  void count(const Kinetic<structures::DelaunayRule<Sample>>& delaunay, const MovingSet<Sample>& samples,
             const Orbits& truth, double t) {
    MovingSet<certificates::PlaneMotion<0>> real;  // at rest, as they are at t
    for (Id id = 0; id < truth.size(); ++id) {
      const auto [x, y] = truth.position(id, t);
      real.insert(id, {{{{{x}}, {{y}}}}, t}, t);
    }
    for (Slot slot = 0; slot < 4 * delaunay.rule().mesh().end_triangle(); ++slot) {
      kds::detail::with_certificate(delaunay.rule().certificate(slot, samples), [&](const auto& certificate) {
        using C = std::remove_cvref_t<decltype(certificate)>;
        if constexpr (std::is_same_v<C, certificates::InCircle<Sample>>) {
          ++all;
          if (sign_after(Conservative<C>{certificate}, t) < 0) return;
          ++guaranteed;
          const auto now = [&](const Sample& p) -> const auto& { return real[static_cast<Id>(&p - &samples[0])]; };
          const certificates::InCircle<certificates::PlaneMotion<0>> test{now(certificate.a), now(certificate.b),
                                                                          now(certificate.c), now(certificate.d)};
          wrong += sign_after(test, t) < 0;
        }
      });
    }
  }
};

}  // namespace kds::tests
