// Laws of contact, and random scenes whose bodies respond by them.
#pragma once

#include "collision/response/contact_law.hpp"
#include "tests/collision/parallel/stagings.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <utility>

namespace kds::collision::tests {

/// One of several laws, or another at each moment.
class SampleLaw final : public ContactLaw {
 public:
  enum class Kind { swaps, rubs, wades, lets_pass, shoots, varies, sticks };
  /// Bodies that stick and are pressed together by accelerations would meet again and again.
  template <class Motion>
  static constexpr std::size_t kinds = Motion::degree == 1 && !turns<Motion> ? 7 : 6;

  explicit SampleLaw(Kind kind) : kind_(kind) {}

  void respond(const Meeting& meeting, Velocities& a, Velocities& b) const override {
    Kind kind = kind_;
    if (kind == Kind::varies) {  // By bits of the time that differ from contact to contact.
      kind = static_cast<Kind>(static_cast<std::uint64_t>(std::fmod(meeting.time, 1) * 0x1p20) % 5);
    }
    const double mass = meeting.a.inverse_mass + meeting.b.inverse_mass;
    const bool fixed = meeting.a.inverse_mass * meeting.b.inverse_mass == 0;
    const Eigen::Vector3d apart = b.linear - a.linear;
    const double approach = -apart.dot(meeting.normal);
    const auto push = [&](const Eigen::Vector3d& change) {
      a.linear -= change * (meeting.a.inverse_mass / mass);
      b.linear += change * (meeting.b.inverse_mass / mass);
    };
    if (kind == Kind::swaps && !fixed) std::swap(a.linear, b.linear);
    if (kind == Kind::swaps && fixed) push(2 * approach * meeting.normal);
    if (kind == Kind::swaps && !fixed && a.angular != b.angular) std::swap(a.angular, b.angular);
    if (kind == Kind::rubs) push((1 + 0.75) * approach * meeting.normal - 0.25 * (apart + approach * meeting.normal));
    if (kind == Kind::wades) push(-0.5 * (apart + approach * meeting.normal));
    if (kind == Kind::sticks) {
      const Eigen::Vector3d common = (a.linear * meeting.b.inverse_mass + b.linear * meeting.a.inverse_mass) / mass;
      a.linear = meeting.a.inverse_mass == 0 ? a.linear : meeting.b.inverse_mass == 0 ? b.linear : common;
      b.linear = meeting.b.inverse_mass == 0 ? b.linear : a.linear;
    }
    // Whatever is lighter is thrown off, faster than before: the news of it go far.
    if (kind == Kind::shoots) push((2 * approach + 0.5) * meeting.normal);
  }

 private:
  Kind kind_;
};

/// The scenes of StageMaker, in mode `callback`.
template <class Motion>
class LawStageMaker {
 public:
  explicit LawStageMaker(std::uint64_t seed)
      : stages_(seed), law_(static_cast<SampleLaw::Kind>(seed % SampleLaw::kinds<Motion>)) {}

  Staging<Motion> scene() {
    Staging<Motion> scene = stages_.scene();
    scene.options.response = Response::callback;
    scene.options.law = &law_;
    return scene;
  }
  Manner manner(std::size_t most_domains) { return stages_.manner(most_domains); }

 private:
  StageMaker<Motion> stages_;
  SampleLaw law_;
};

/// As compare_stagings(); by hand KDS_LAW_SEEDS.
template <class Motion>
void compare_laws(std::initializer_list<Seeds> seeds, Seen& seen) {
  compare_seeds<LawStageMaker<Motion>>("KDS_LAW_SEEDS", seeds, seen);
}

}  // namespace kds::collision::tests
