// The filters of boxes with boxes and balls change no answer: the same by exact signs alone, of all certificates.
#include "certificates/conjunction.hpp"
#include "certificates/feature_separation.hpp"
#include "certificates/plane_separation.hpp"
#include "collision/narrow_phase/box_and_box.hpp"
#include "collision/narrow_phase/convex_contact.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace test_convex_contact {
namespace {

using namespace kds;
using namespace kds::collision;
using certificates::FeatureSeparation;
using certificates::PlaneSeparation;
using certificates::PointMotion;
using Eigen::Vector3d;
using kds::tests::Random;

/// All certificates of a convex piece.
template <int Degree>
struct Piece {
  std::vector<PlaneSeparation<Degree>> planes;
  std::vector<FeatureSeparation<Degree>> curved;

  std::span<const PlaneSeparation<Degree>> all_planes() const { return planes; }
  std::span<const FeatureSeparation<Degree>> all_curved() const { return curved; }
};

template <int Degree>
std::vector<Piece<Degree>> box_and_ball(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b) {
  const Vector3d h = std::get<Box>(a.shape.shape).half_extents;
  const double r = std::get<Sphere>(b.shape.shape).radius;
  std::array<Vector3d, 3> axes;
  for (int d = 0; d < 3; ++d) axes[static_cast<std::size_t>(d)] = a.shape.rotation.col(d);
  std::vector<Piece<Degree>> pieces;
  // By axis: 0 between the faces, 1 between them grown, 2 and 3 around one of them.
  for (int code = 0; code < 64; ++code) {
    const std::array<int, 3> place{code % 4, code / 4 % 4, code / 16};
    const auto grown = std::count(place.begin(), place.end(), 1);
    const auto around = std::count_if(place.begin(), place.end(), [](int p) { return p >= 2; });
    if (!((grown == 1 && around == 0) || (grown == 0 && around >= 2))) continue;
    Piece<Degree> piece;
    std::array<double, 3> offset{};
    std::array<bool, 3> used{};
    for (std::size_t d = 0; d < 3; ++d) {
      const double half = h[static_cast<int>(d)];
      if ((used[d] = place[d] >= 2)) {
        offset[d] = place[d] == 2 ? -half : half;
      } else {
        for (const double side : {1.0, -1.0}) {
          piece.planes.push_back({a.motion, b.motion, axes[d], side, {}, {half, place[d] == 1 ? r : 0.0}});
        }
      }
    }
    if (around > 0) piece.curved.push_back({a.motion, b.motion, axes, offset, used, r});
    pieces.push_back(piece);
  }
  return pieces;
}

template <int Degree>
std::vector<Piece<Degree>> pieces_of(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b) {
  if (std::holds_alternative<Sphere>(b.shape.shape)) return box_and_ball(a, b);
  Piece<Degree> piece;
  const auto& u = a.shape.half_axes;
  const auto& w = b.shape.half_axes;
  every_box_axis(a.shape, b.shape, [&](const Vector3d& axis, int) {
    for (const double side : {1.0, -1.0}) {
      piece.planes.push_back({a.motion, b.motion, axis, side, {&u[0], &u[1], &u[2], &w[0], &w[1], &w[2]}, {}});
    }
    return true;
  });
  return {piece};
}

template <int Degree>
bool all_inside(const std::vector<Piece<Degree>>& pieces, double t) {
  return std::any_of(pieces.begin(), pieces.end(), [t](const auto& piece) {
    return certificates::all_broken(t, piece.all_planes(), piece.all_curved());
  });
}

template <int Degree>
double first_inside(const std::vector<Piece<Degree>>& pieces, double t, double horizon) {
  double first = never;
  for (const auto& piece : pieces) {
    first = std::min(first, certificates::first_all_broken(t, horizon, piece.all_planes(), piece.all_curved()));
  }
  return first;
}

template <int Degree>
double first_outside(const std::vector<Piece<Degree>>& pieces, double t, double horizon) {
  for (bool moved = true; moved && t != never;) {
    moved = false;
    for (const auto& piece : pieces) {
      if (t == never || !certificates::all_broken(t, piece.all_planes(), piece.all_curved())) continue;
      t = certificates::first_any_holds(t, horizon, piece.all_planes(), piece.all_curved());
      moved = true;
    }
  }
  return t;
}

/// Pairs of many scales, and of coarse numbers, with which things touch, graze and meet at one time.
class Pairs {
 public:
  Pairs(Random& random, bool with_ball) : random_(random), coarse_(random.one_in(2)), with_ball_(with_ball) {
    static constexpr std::array scales{1.0, 1e-9, 1e3, 1e9};
    size_ = coarse_ ? 1 : random.one_in(2) ? 1 : scales[random.below(4)];
    speed_ = coarse_ ? 1 : random.one_in(2) ? 1 : scales[random.below(4)];
    place_ = !coarse_ && random.one_in(4) ? 1e8 : 0;
    clock_ = random.one_in(4) ? 0x1p30 : 0;
  }

  PlacedShape box() {
    const Eigen::Quaterniond turned = Eigen::Quaterniond(number(0, 1), number(-1, 1), number(-1, 1), 1).normalized();
    return place(Box{{length(), length(), length()}}, random_.one_in(3) ? Eigen::Quaterniond::Identity() : turned);
  }
  PlacedShape other() { return with_ball_ ? placed_ball(length()) : box(); }

  template <int Degree>
  PointMotion<Degree> path() {
    PointMotion<Degree> path;
    path.start = clock_ - duration() * number(0, 1);
    path.coefficients[0] = Vector3d::Constant(place_ * size_) + vector(2) * size_;
    path.coefficients[1] = vector(2) * speed_;
    if constexpr (Degree == 2) {
      path.coefficients[2] = vector(1) * (random_.one_in(4) ? 0.0 : speed_ / duration());
    }
    return path;
  }

  double duration() const { return size_ / speed_; }
  double start() { return clock_ + (random_.one_in(2) ? 0.0 : duration() * number(0, 1)); }
  double horizon() {
    const double times = random_.one_in(6) ? 1e12 : 1 + number(0, 3);
    return random_.one_in(6) ? never : clock_ + duration() * times;
  }

 private:
  double number(double low, double high) {
    return coarse_ ? 0.5 * random_.integer(static_cast<int>(2 * low), static_cast<int>(2 * high))
                   : random_.between(low, high);
  }
  double length() { return size_ * number(0.5, 1); }
  Vector3d vector(double size) {
    const double x = number(-size, size);
    const double y = number(-size, size);
    return {x, y, number(-size, size)};
  }

  Random& random_;
  bool coarse_;
  bool with_ball_;
  double size_, speed_, place_, clock_;
};

}  // namespace

TEMPLATE_TEST_CASE_SIG("Filtered contacts of boxes are those of exact signs alone", "[convex_contact]",
                       ((int Degree), Degree), 1, 2) {
  constexpr int rounds = 6000;
  int contacts = 0, meetings = 0, partings = 0, estimates = 0;
  std::vector<std::uint64_t> wrong;  // seeds
  for (std::uint64_t seed = 1; seed <= rounds; ++seed) {
    Random random(seed);
    Pairs pairs(random, seed % 2 == 0);
    const PlacedShape box = pairs.box();
    const PlacedShape other = pairs.other();
    const auto path_a = pairs.path<Degree>();
    const auto path_b = pairs.path<Degree>();
    const TranslatingShape<Degree> a{box, path_a};
    const TranslatingShape<Degree> b{other, path_b};
    const double t0 = pairs.start();
    const double horizon = pairs.horizon();
    const auto pieces = pieces_of(a, b);
    const bool inside = all_inside(pieces, t0);
    const double first = first_inside(pieces, t0, horizon);
    const bool ordered = random.one_in(2);  // balls may come first
    const auto& x = ordered ? a : b;
    const auto& y = ordered ? b : a;
    PairMemory memory;
    if (random.one_in(2)) memory.axis = static_cast<std::uint8_t>(random.below(15));
    const ContactEstimate estimate = estimated_first_contact(x, y, t0, horizon, ContactMode::transparent, memory);
    bool right = in_contact(x, y, t0) == inside &&
                 first_contact(x, y, t0, horizon, ContactMode::transparent) == first &&
                 (estimate.exact ? estimate.time == first : estimate.time > t0 && estimate.time <= first);
    estimates += !estimate.exact;
    contacts += inside;
    meetings += first > t0 && first != never;
    if (first != never) {
      const double last = first_outside(pieces, first, horizon);
      right = right && in_contact(x, y, first) && first_separation(x, y, first, horizon) == last;
      partings += last != never;
    }
    if (!right) wrong.push_back(seed);
  }
  CAPTURE(Degree, contacts, meetings, partings, estimates);
  CHECK(wrong == std::vector<std::uint64_t>{});
  CHECK(contacts > 30);
  CHECK(meetings > 100);
  CHECK(partings > 100);
  CHECK(estimates > 100);
}

}  // namespace test_convex_contact
