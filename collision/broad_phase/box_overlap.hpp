// The certificates by which two kinetic boxes overlap.
#pragma once

#include "certificates/order.hpp"
#include "collision/broad_phase/kinetic_box.hpp"
#include "kds/motion.hpp"

#include <array>
#include <cstddef>

namespace kds::collision {

/// The six certificates by which two boxes overlap, as coordinates in order: a.min <= b.max and b.min <= a.max, axis by
/// axis. All broken in the opposite sense means overlap.
template <int Degree>
class BoxOverlap {
 public:
  using Apart = certificates::Order<Degree>;

  BoxOverlap(const KineticBox<Degree>& a, const KineticBox<Degree>& b) {
    for (int d = 0; d < 3; ++d) {
      ends_[static_cast<std::size_t>(d)] = {a.min.axis(d), a.max.axis(d), b.min.axis(d), b.max.axis(d)};
    }
  }
  BoxOverlap(const BoxOverlap&) = delete;
  BoxOverlap& operator=(const BoxOverlap&) = delete;

  /// "a lies left of b" and "b lies left of a" on each axis; the boxes overlap where all six are broken.
  std::array<Apart, 6> separations() const {
    return {Apart{ends_[0].a_max, ends_[0].b_min}, Apart{ends_[0].b_max, ends_[0].a_min},
            Apart{ends_[1].a_max, ends_[1].b_min}, Apart{ends_[1].b_max, ends_[1].a_min},
            Apart{ends_[2].a_max, ends_[2].b_min}, Apart{ends_[2].b_max, ends_[2].a_min}};
  }

 private:
  struct Ends {
    Motion<Degree> a_min, a_max, b_min, b_max;
  };
  std::array<Ends, 3> ends_;
};

}  // namespace kds::collision
