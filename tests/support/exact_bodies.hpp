// Bodies of the library as bodies of the exact oracle.
#pragma once

#include "collision/world.hpp"
#include "tests/support/exact_oracle.hpp"

#include <variant>

namespace oracle {

/// Spheres and boxes. A box is the one that its quaternion means, exactly.
template <int Degree>
Body exact_body(const kds::collision::BodyDescription<Degree>& body) {
  Body result;
  if (const auto* sphere = std::get_if<kds::collision::Sphere>(&body.shape)) {
    result.shape = Sphere{sphere->radius};
  } else {
    const auto& h = std::get<kds::collision::Box>(body.shape).half_extents;
    const auto& q = body.orientation;
    result.shape = Box{{h[0], h[1], h[2]}, rotation({q.w(), q.x(), q.y(), q.z()})};
  }
  for (const auto& piece : body.motion) {
    Piece exact_piece{piece.start, {}};
    for (const auto& c : piece.coefficients) exact_piece.coefficients.push_back({c[0], c[1], c[2]});
    result.motion.push_back(exact_piece);
  }
  return result;
}

}  // namespace oracle
