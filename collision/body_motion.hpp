// How bodies move: what a world needs of a type of motion.
#pragma once

#include "certificates/point_motion.hpp"

#include <algorithm>
#include <concepts>
#include <type_traits>

namespace kds::collision {

namespace detail {
struct AnyArchive {};  ///< stands for archives in a concept
}  // namespace detail

/// A motion that the bodies of a world may have: the path of the centre, which is a polynomial, and anything else that
/// moves.
///
/// 1. path_of(motion), found where the motion is declared, is the path of the centre: the point about which shapes are
///    placed. It starts when the whole motion does, which is valid from then on. The path of a PointMotion is the
///    motion itself.
/// 2. finite(): all numbers are finite, and they describe a motion.
/// 3. restarted(t) starts at t and continues this one, up to the rounding of its numbers; its path is the path of this
///    one restarted, bit for bit.
/// 4. Two motions that compare equal have the same values at all times, bit for bit.
/// 5. archive_members() writes and reads all numbers (kds/framework/snapshot.hpp).
template <class Motion>
concept BodyMotion = std::default_initializable<Motion> && std::copyable<Motion> &&
    requires(const Motion& motion, Motion& changed, detail::AnyArchive& archive, double t) {
  requires std::same_as<decltype(Motion::degree), const int>;  // of the path
  { path_of(motion) } -> std::same_as<const certificates::PointMotion<Motion::degree>&>;
  { motion.finite() } -> std::same_as<bool>;
  { motion.restarted(t) } -> std::same_as<Motion>;
  { motion == motion } -> std::same_as<bool>;
  archive_members(archive, changed);
};

/// The path of a body's centre.
template <class Motion>
using PathOf = certificates::PointMotion<Motion::degree>;

/// Whether bodies with this type of motion may turn. Those of a PointMotion keep their orientation, and the motion is
/// the path.
template <class Motion>
inline constexpr bool turns = !std::is_same_v<Motion, PathOf<Motion>>;

/// A motion as another type, bit for bit where both have the same terms. Terms of the path and a turning that `To` does
/// not have are left out; those that `From` does not have are zero.
template <class To, class From>
To motion_as(const From& from) {
  const auto& given = path_of(from).coefficients;
  PathOf<To> path;
  std::copy_n(given.begin(), std::min(given.size(), path.coefficients.size()), path.coefficients.begin());
  path.start = path_of(from).start;
  if constexpr (turns<To>) {
    To to;
    to.path = path;
    if constexpr (turns<From>) {
      to.orientation = from.orientation;
      to.angular_velocity = from.angular_velocity;
    }
    return to;
  } else {
    return path;
  }
}

}  // namespace kds::collision
