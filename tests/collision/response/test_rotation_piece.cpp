#include "collision/response/rotation_piece.hpp"

#include "collision/vectors.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "tests/collision/response/random_rotation.hpp"
#include "tests/support/random_numbers.hpp"
#include "tests/support/random_vectors.hpp"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

namespace test_rotation_piece {
namespace {

using namespace kds::collision;
using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::never;
using kds::collision::tests::random_rotation;
using kds::tests::Random;
using kds::tests::random_vector;

/// How far a piece is off the free rotation at most, at 64 times.
double farthest(const PrincipalInertia& inertia, const RotationState& state, const Quaterniond& from, double t,
                const RotationPiece& piece) {
  double result = 0;
  for (int i = 0; i <= 64; ++i) {
    const double time = t + (piece.end - t) * i / 64;
    const Vector3d turn = piece.angular_velocity * (time - t);
    const Quaterniond moves(AngleAxisd(turn.norm(), turn.norm() > 0 ? Vector3d(turn.normalized()) : Vector3d::UnitX()));
    result = std::max(result, (moves * from).angularDistance(orientation_at(inertia, state, time)));
  }
  return result;
}

}  // namespace

TEST_CASE("rotation piece: the rate between two orientations leads from one to the other") {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const Quaterniond from = random_rotation(random);
    const double angle =
        seed % 3 == 0 ? random.between(0, 3.14) : std::ldexp(random.between(1, 2), -static_cast<int>(seed % 50));
    const Vector3d axis = random_vector(random).normalized();
    const Quaterniond to = Quaterniond(AngleAxisd(angle, axis)) * from;
    const double scale = seed % 2 == 0 ? 1 : -3;  // quaternions of any length and sign
    const Vector3d rate = rate_between(from, Quaterniond(scale * to.coeffs()), 0.5);
    CHECK((0.5 * rate - angle * axis).norm() < 1e-15 + 0x1p-48 * angle);
    CHECK(std::abs(angle_between(from, to) - angle) < 1e-15 + 0x1p-48 * angle);
  }
  const Quaterniond half(0, 0, 1, 0);
  CHECK((rate_between(Quaterniond::Identity(), half, 2) - Vector3d(0, std::acos(-1.0) / 2, 0)).norm() < 1e-15);
  CHECK(rate_between(half, half, 1) == Vector3d::Zero());
}

TEST_CASE("rotation piece: never off the free rotation by more than it may be") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    Vector3d moments(random.between(0.1, 1), random.between(0.1, 1), 0);
    moments[2] = random.between(std::abs(moments[0] - moments[1]), moments[0] + moments[1]);
    if (seed % 4 == 1) moments[2] = moments[0] + moments[1];
    if (seed % 4 == 2) moments[1] = moments[0];
    if (seed % 4 == 3) moments = Vector3d(1e-3, 1, random.between(1 - 1e-3, 1 + 1e-3));
    const PrincipalInertia inertia = principal_inertia(moments.asDiagonal());
    Vector3d velocity = random_vector(random) * std::ldexp(1.0, static_cast<int>(seed % 40) - 20);
    if (seed % 5 == 0) velocity[0] *= 1e-3, velocity[2] *= 1e-4;  // nearly about one axis
    const Quaterniond orientation = random_rotation(random);
    RotationState state{angular_momentum(inertia, orientation, velocity), orientation, 0};
    for (const double bulge : {1e-1, 1e-2, 1e-3, 1e-6}) {
      CAPTURE(bulge);
      RotationState here = state;
      Quaterniond from = here.orientation;
      double t = 0;
      for (int i = 0; i < 4; ++i) {
        if (inertia.symmetry >= 0) REQUIRE(orientation_at(inertia, here, t).coeffs() == from.coeffs());
        const RotationPiece piece = rotation_piece(inertia, here, t, from, from, bulge);
        REQUIRE(piece.end > t);
        REQUIRE(piece.angular_velocity.norm() * (piece.end - t) < longest_turn * 1.25);
        REQUIRE(farthest(inertia, here, from, t, piece) <= bulge + 1e-15);
        t = piece.end, from = piece.orientation;
        if (inertia.symmetry < 0) here.orientation = piece.orientation, here.time = t;
      }
      // And from where a contact has left it.
      const double off = 4 * bulge;
      const Quaterniond elsewhere =
          Quaterniond(AngleAxisd(off, random_vector(random).normalized())) * state.orientation;
      const RotationPiece back = rotation_piece(inertia, state, 0, state.orientation, elsewhere, bulge);
      REQUIRE(farthest(inertia, state, elsewhere, 0, back) <= off * (1 + 0x1p-6));
      REQUIRE(back.orientation.angularDistance(orientation_at(inertia, state, back.end)) < 1e-14);
    }
  }
}

TEST_CASE("rotation piece: what turns about a principal axis needs one piece") {
  const PrincipalInertia inertia = principal_inertia(Vector3d(1, 2, 3).asDiagonal());
  const Quaterniond upright = Quaterniond::Identity();
  const RotationState state{Vector3d(0, 4, 0), upright, 3};
  const RotationPiece piece = rotation_piece(inertia, state, 3, upright, upright, 1e-3);
  CHECK(piece.end == never);
  CHECK(piece.angular_velocity == Vector3d(0, 2, 0));
  // One that a contact has left turned otherwise goes back first.
  const Quaterniond elsewhere(AngleAxisd(1e-3, Vector3d::UnitX()));
  CHECK(rotation_piece(inertia, state, 3, upright, elsewhere, 1e-3).end == 3.5);
  CHECK(rotation_piece(inertia, {Vector3d::Zero(), upright, 3}, 3, upright, elsewhere, 1e-3).end == never);
}

TEST_CASE("rotation piece: a clock that is too coarse is refused") {
  const PrincipalInertia inertia = principal_inertia(Vector3d(1, 2, 3).asDiagonal());
  const RotationState state{Vector3d(0x1p60, 0x1p60, 0), Quaterniond::Identity(), 1};
  CHECK_THROWS_AS(rotation_piece(inertia, state, 1, state.orientation, state.orientation, 1e-3), std::runtime_error);
}

TEST_CASE("pieces in a row are those of one after the other") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    PrincipalInertia inertia{.moments = {1, 1, random.between(0.6, 1.9)}, .symmetry = 2};
    if (seed % 2 == 0) inertia.moments[1] = random.between(0.7, 1.4), inertia.symmetry = -1;
    RotationState state{.momentum = 3 * random_vector(random), .orientation = random_rotation(random), .time = 0.5};
    const double bulge = 1e-3;
    RotationPiece piece = rotation_piece(inertia, state, state.time, state.orientation, state.orientation, bulge);
    if (piece.end == never) continue;  // about a principal axis
    const RotationState first = state;
    const RotationPiece before = piece;
    const double start_of_row = piece.end;
    for (const double until : {start_of_row, 1.0, 3.0}) {
      RotationState in_a_row = first;
      const PiecesInARow row = pieces_until(until, inertia, in_a_row, start_of_row, before.orientation, bulge);
      std::size_t count = 0;
      double start = start_of_row, end = start_of_row;
      Quaterniond from = before.orientation;
      state = first, piece = before;
      do {
        from = piece.orientation, start = end;
        if (inertia.symmetry < 0) state.orientation = from, state.time = start;
        piece = rotation_piece(inertia, state, start, from, from, bulge);
        end = piece.end;
        ++count;
      } while (end < until);
      CHECK(row.count == count);
      CHECK(row.start == start);
      CHECK(row.from.coeffs() == from.coeffs());
      CHECK(row.last.end == end);
      CHECK(row.last.orientation.coeffs() == piece.orientation.coeffs());
      CHECK(row.last.angular_velocity == piece.angular_velocity);
      CHECK(in_a_row == state);
    }
  }
}

}  // namespace test_rotation_piece
