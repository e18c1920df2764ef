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
#include <optional>
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

/// Where a piece leads that starts at t.
Quaterniond end_of(const Quaterniond& from, double t, const RotationPiece& piece) {
  const Vector3d turn = piece.angular_velocity * (piece.end - t);
  return Quaterniond(AngleAxisd(turn.norm(), turn.normalized())) * from;
}

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

/// The one that follows, with all that is known forgotten.
RotationPiece next_piece(const PrincipalInertia& inertia, RotationState& state, const RotationPiece& before,
                         double error) {
  std::optional<TopPieces> known;
  const PiecesInARow row = pieces_until(kds::next_up(before.end), inertia, state, before.end, before, error, known);
  CHECK(row.count == 1);
  CHECK(row.start == before.end);
  return row.last;
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
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    Vector3d moments(random.between(0.1, 1), random.between(0.1, 1), 0);
    moments[2] = random.between(std::abs(moments[0] - moments[1]), moments[0] + moments[1]);
    if (seed % 4 == 1) moments[2] = moments[0] + moments[1];
    if (seed % 4 == 2) moments[1] = moments[0], moments[2] = random.between(0.1, 2) * moments[0];
    if (seed % 4 == 3) moments = Vector3d(1e-3, 1, random.between(1 - 1e-3, 1 + 1e-3));
    const PrincipalInertia inertia = principal_inertia(moments.asDiagonal());
    Vector3d velocity = random_vector(random) * std::ldexp(1.0, static_cast<int>(seed % 40) - 20);
    if (seed % 5 == 0) velocity[0] *= 1e-3, velocity[2] *= 1e-4;  // nearly about one axis
    const Quaterniond orientation = random_rotation(random);
    RotationState state{angular_momentum(inertia, orientation, velocity), orientation, 0};
    for (const double error : {1e-1, 1e-2, 1e-3, 1e-6}) {
      CAPTURE(error);
      const RotationPiece first = leading_piece(inertia, state, state.orientation, error);
      REQUIRE(farthest(inertia, state, state.orientation, 0, first) <= error);
      RotationState here = state;
      RotationPiece before = first;
      double before_t = 0;
      Quaterniond before_from = state.orientation;
      for (int i = 0; i < 8 && before.end < never; ++i) {
        const double t = before.end;
        const RotationPiece piece = next_piece(inertia, here, before, error);
        REQUIRE(piece.end > t);
        REQUIRE(piece.from.angularDistance(end_of(before_from, before_t, before)) < 1e-13 * (1 + t));
        if (piece.end < never) REQUIRE(piece.angular_velocity.norm() * (piece.end - t) < longest_turn * 1.25);
        const RotationState then{state.momentum, orientation_at(inertia, here, t), t};
        if (piece.end < never) REQUIRE(farthest(inertia, then, piece.from, t, piece) <= error + 1e-15);
        before = piece, before_t = t, before_from = piece.from;
      }
      // And from where a contact has left it.
      for (const double off : {error, 1.75 * error}) {
        const Quaterniond elsewhere =
            Quaterniond(AngleAxisd(off, random_vector(random).normalized())) * state.orientation;
        const RotationPiece back = leading_piece(inertia, state, elsewhere, error);
        REQUIRE(farthest(inertia, state, elsewhere, 0, back) <= off * (1 + 0x1p-6));
        REQUIRE(back.to.angularDistance(orientation_at(inertia, state, back.end)) < 1e-14);
      }
    }
  }
}

TEST_CASE("rotation piece: pieces are as long as they may be") {
  // Rods, and a box: of a curve of which B is 2 e, halfway between its ends, a piece that leans is off by e.
  for (const Vector3d& moments : {Vector3d(0.1, 1, 1), Vector3d(1, 2, 2.5)}) {
    const PrincipalInertia inertia = principal_inertia(moments.asDiagonal());
    const Quaterniond upright = Quaterniond::Identity();
    RotationState state{angular_momentum(inertia, upright, {1, 0.5, 0.25}), upright, 0};
    const double error = 1e-4;
    RotationPiece before = next_piece(inertia, state, leading_piece(inertia, state, upright, error), error);
    for (int i = 0; i < 20; ++i) {
      const double t = before.end;
      const RotationPiece piece = next_piece(inertia, state, before, error);
      const RotationState then{state.momentum, orientation_at(inertia, state, t), t};
      const double off = farthest(inertia, then, piece.from, t, piece);
      CHECK(off <= error);
      CHECK(off > 0.96 * error);
      const double halfway = t + (piece.end - t) / 2;
      const Vector3d turn = piece.angular_velocity * (halfway - t);
      const Quaterniond moves = Quaterniond(AngleAxisd(turn.norm(), turn.normalized())) * piece.from;
      CHECK(moves.angularDistance(orientation_at(inertia, then, halfway)) > 0.8 * error);
      before = piece;
    }
  }
}

TEST_CASE("rotation piece: those of a top are equally long, counted from one time") {
  const PrincipalInertia inertia = principal_inertia(Vector3d(1, 1, 1.75).asDiagonal());
  RotationState state{Vector3d(0.5, 0.25, 1), Quaterniond::Identity(), 1};
  const RotationPiece first = leading_piece(inertia, state, state.orientation, 1e-3);
  const RotationPiece away = next_piece(inertia, state, first, 1e-3);
  RotationPiece piece = next_piece(inertia, state, away, 1e-3);
  CHECK(state.time == first.end);
  const RotationState counted = state;
  const double span = piece.end - away.end;
  for (int i = 1; i < 1000; ++i) {
    piece = next_piece(inertia, state, piece, 1e-3);
    REQUIRE(state == counted);
    REQUIRE(std::abs(piece.end - (away.end + (i + 1) * span)) < 1e-11);
  }
  // On a clock that is so coarse that their spans differ each is counted from the one before.
  RotationState late{state.momentum, state.orientation, 0x1p36};
  piece = leading_piece(inertia, late, late.orientation, 1e-3);
  for (int i = 0; i < 100; ++i) {
    const double t = piece.end;
    const Quaterniond to = piece.to;
    piece = next_piece(inertia, late, piece, 1e-3);
    REQUIRE(late.time == t);
    REQUIRE(piece.from.angularDistance(to) < 1e-15);
    REQUIRE(farthest(inertia, late, piece.from, t, piece) <= 1.05e-3);
  }
}

TEST_CASE("rotation piece: what turns about a principal axis needs one piece") {
  const PrincipalInertia inertia = principal_inertia(Vector3d(1, 2, 3).asDiagonal());
  const Quaterniond upright = Quaterniond::Identity();
  const RotationState state{Vector3d(0, 4, 0), upright, 3};
  const RotationPiece piece = leading_piece(inertia, state, upright, 1e-3);
  CHECK(piece.end == never);
  CHECK(piece.angular_velocity == Vector3d(0, 2, 0));
  // One that a contact has left turned otherwise goes back first.
  const Quaterniond elsewhere(AngleAxisd(1e-3, Vector3d::UnitX()));
  CHECK(leading_piece(inertia, state, elsewhere, 1e-3).end == 3.5);
  CHECK(leading_piece(inertia, {Vector3d::Zero(), upright, 3}, elsewhere, 1e-3).end == never);
}

TEST_CASE("rotation piece: a clock that is too coarse is refused") {
  for (const double third : {3.0, 2.0}) {
    const PrincipalInertia inertia = principal_inertia(Vector3d(1, 2, third).asDiagonal());
    const RotationState state{Vector3d(0x1p60, 0x1p60, 0), Quaterniond::Identity(), 1};
    CHECK_THROWS_AS(leading_piece(inertia, state, state.orientation, 1e-3), std::runtime_error);
  }
}

TEST_CASE("pieces in a row are those of one after the other") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    PrincipalInertia inertia{.moments = {1, 1, random.between(0.6, 1.9)}, .symmetry = 2};
    if (seed % 2 == 0) inertia.moments[1] = random.between(0.7, 1.4), inertia.symmetry = -1;
    const double begin = seed % 8 == 7 ? 0x1p36 : 0.5;  // the clock is coarse then
    RotationState state{.momentum = 3 * random_vector(random), .orientation = random_rotation(random), .time = begin};
    const double error = 1e-3;
    const RotationPiece first = leading_piece(inertia, state, state.orientation, error);
    if (first.end == never) continue;  // about a principal axis
    const RotationState at_first = state;
    std::optional<TopPieces> known;
    for (const double until : {0.0, first.end - begin, 1.0, 3.0, 20.0}) {
      RotationState in_a_row = at_first;
      if (seed % 3 == 0) known.reset();
      const PiecesInARow row = pieces_until(begin + until, inertia, in_a_row, first.end, first, error, known);
      std::size_t count = 0;
      RotationPiece piece = first;
      double start = first.end;
      state = at_first;
      do {
        start = piece.end;
        piece = next_piece(inertia, state, piece, error);
        ++count;
      } while (piece.end < begin + until);
      CHECK(row.count == count);
      CHECK(row.start == start);
      CHECK(row.last.from.coeffs() == piece.from.coeffs());
      CHECK(row.last.end == piece.end);
      CHECK(row.last.to.coeffs() == piece.to.coeffs());
      CHECK(row.last.ahead.coeffs() == piece.ahead.coeffs());
      CHECK(row.last.angular_velocity == piece.angular_velocity);
      CHECK(in_a_row == state);
    }
  }
}

}  // namespace test_rotation_piece
