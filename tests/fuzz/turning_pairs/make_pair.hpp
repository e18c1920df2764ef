// Pairs of bodies that turn, at random and where errors are likely.
#pragma once

#include "certificates/turning/rigid_motion.hpp"
#include "collision/shapes/shape.hpp"
#include "tests/fuzz/turning_pairs/oracle.hpp"

#include <array>
#include <cstdint>

namespace turning_pairs {

inline constexpr std::array family_names{"random",
                                         "parallel edges and faces",
                                         "shared spin axis",
                                         "separated along the spin axis",
                                         "one without spin",
                                         "flat",
                                         "grazing",
                                         "interlocked meshes",
                                         "starts far in the past"};
inline constexpr std::size_t families = family_names.size();

struct RandomPair {
  std::size_t family;
  double horizon;
  kds::collision::Shape shape_a, shape_b;
  kds::certificates::RigidMotion<2> a, b;
  std::vector<Piece> pieces_a, pieces_b;
};

/// With capsules, one of the two is one in place of what it would have been, or both are, and some of the others are
/// hulls: in the family "grazing" what turns is, in place of a box. With half-spaces the first is one, which does not
/// turn, and may move; some of the second are capsules or hulls. With compounds one of the two, or both, get more
/// parts, boxes, hulls and triangles; some of the others are capsules or half-spaces.
enum class Kinds { usual, capsules, half_spaces, compounds };

/// A function of the seed and the kinds alone.
RandomPair make_pair(std::uint64_t seed, Kinds kinds);

}  // namespace turning_pairs
