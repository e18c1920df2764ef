// Bodies of the library as bodies of the exact oracle.
#pragma once

#include "collision/world.hpp"
#include "tests/support/exact_oracle.hpp"

#include <variant>

namespace accuracy {

/// Spheres and boxes. A box is the one that its quaternion means, exactly.
template <int Degree>
oracle::Body exact_body(const kds::collision::BodyDescription<Degree>& body) {
  using namespace kds::collision;
  oracle::Body result;
  if (const auto* sphere = std::get_if<Sphere>(&body.shape)) {
    result.shape = oracle::Sphere{sphere->radius};
  } else {
    const auto& h = std::get<Box>(body.shape).half_extents;
    const auto& q = body.orientation;
    result.shape = oracle::Box{{h[0], h[1], h[2]}, oracle::rotation({q.w(), q.x(), q.y(), q.z()})};
  }
  for (const auto& piece : body.motion) {
    oracle::Piece exact_piece{piece.start, {}};
    for (const auto& c : piece.coefficients) exact_piece.coefficients.push_back({c[0], c[1], c[2]});
    result.motion.push_back(exact_piece);
  }
  return result;
}

}  // namespace accuracy
