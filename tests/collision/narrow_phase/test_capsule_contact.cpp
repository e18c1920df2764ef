// Contacts of capsules with balls, capsules and boxes: those of exact signs alone, of every cell there is, and those of
// distances in long double along the path.
#include "certificates/conjunction.hpp"
#include "certificates/zonotope_separation.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/shapes/rounded_core.hpp"
#include "tests/support/random_numbers.hpp"

#include <Eigen/QR>
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace test_capsule_contact {
namespace {

using namespace kds;
using namespace kds::collision;
using certificates::CellDistance;
using certificates::CellSide;
using certificates::Generator;
using certificates::PointMotion;
using certificates::ZonotopeCell;
using certificates::ZonotopeSide;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::tests::Random;

// ---- By exact signs alone -----------------------------------------------------------------------------------------

/// All certificates of a piece.
template <int Degree>
struct Piece {
  std::vector<ZonotopeSide<Degree>> faces;
  std::vector<CellSide<Degree>> sides;
  std::vector<CellDistance<Degree>> distance;

  bool inside(double t) const { return certificates::all_broken(t, all(faces), all(sides), all(distance)); }
  double first_inside(double t, double horizon) const {
    return certificates::first_all_broken(t, horizon, all(faces), all(sides), all(distance));
  }
  double first_outside(double t, double horizon) const {
    return certificates::first_any_holds(t, horizon, all(faces), all(sides), all(distance));
  }

 private:
  template <class C>
  static std::span<const C> all(const std::vector<C>& certificates) {
    return certificates;
  }
};

/// The pieces of a pair: of all sums of segments and their ends, be they at the surface or not.
template <int Degree>
struct Pieces {
  Pieces(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b) {
    const RoundedCore core_a = rounded_core(a.shape);
    const RoundedCore core_b = rounded_core(b.shape);
    generators.assign(core_a.generators.begin(), core_a.generators.end());
    generators.insert(generators.end(), core_b.generators.begin(), core_b.generators.end());
    const auto n = static_cast<std::uint8_t>(generators.size());
    const auto parallel = [&](std::uint8_t i, std::uint8_t j) {
      const auto minor = [&](int p, int q) {
        const Vector3d& u = generators[i].direction;
        const Vector3d& v = generators[j].direction;
        return (Exact(u[p]) * Exact(v[q]) - Exact(u[q]) * Exact(v[p])).sign() == 0;
      };
      return minor(0, 1) && minor(1, 2) && minor(2, 0);
    };
    Piece<Degree> solid;
    int codes = 1;
    for (std::uint8_t k = 0; k < n; ++k) codes *= 3;
    for (int code = 0; code < codes; ++code) {
      ZonotopeCell cell;
      int digits = code, swept = 0;
      for (std::uint8_t k = 0; k < n; ++k, digits /= 3) {
        cell.end[k] = static_cast<std::int8_t>(digits % 3 - 1);
        if (cell.end[k] == 0 && ++swept <= 2) cell.swept[static_cast<std::size_t>(swept - 1)] = k;
      }
      if (swept > 2 || (swept == 2 && parallel(cell.swept[0], cell.swept[1]))) continue;
      cell.dimension = static_cast<std::uint8_t>(swept);
      Piece<Degree> piece;
      piece.distance.push_back({a.motion, b.motion, generators, cell, {core_a.radius, core_b.radius}});
      for (std::size_t along = 0; along < cell.dimension; ++along) {
        for (const double side : {1.0, -1.0}) {
          piece.sides.push_back({a.motion, b.motion, generators, cell, along, side});
        }
      }
      all.push_back(piece);
    }
    for (std::uint8_t i = 0; i < n; ++i) {
      for (std::uint8_t j = i + 1; j < n; ++j) {
        if (parallel(i, j)) continue;
        for (const double side : {1.0, -1.0}) solid.faces.push_back({a.motion, b.motion, generators, {i, j}, side});
      }
    }
    if (n >= 3) all.push_back(solid);
  }
  Pieces(const Pieces&) = delete;  // certificates refer to the generators
  Pieces& operator=(const Pieces&) = delete;

  bool inside(double t) const {
    return std::any_of(all.begin(), all.end(), [t](const auto& piece) { return piece.inside(t); });
  }
  double first_inside(double t, double horizon) const {
    double first = never;
    for (const auto& piece : all) first = std::min(first, piece.first_inside(t, horizon));
    return first;
  }
  double first_outside(double t, double horizon) const {
    for (bool moved = true; moved && t != never;) {
      moved = false;
      for (const auto& piece : all) {
        if (t == never || !piece.inside(t)) continue;
        t = piece.first_outside(t, horizon);
        moved = true;
      }
    }
    return t;
  }

  std::vector<Generator> generators;
  std::vector<Piece<Degree>> all;
};

// ---- By distances ---------------------------------------------------------------------------------------------------

using Long = long double;
using LongVector = Eigen::Matrix<Long, 3, 1>;

/// The distance of x from the sum of the segments: the least of those from all points that are best where some segments
/// stand at one of their ends and up to three are free, and that are moved into the sum where they are not in it.
Long distance(std::span<const Generator> generators, const LongVector& x) {
  const std::size_t n = generators.size();
  std::vector<LongVector> half;
  for (const Generator& g : generators) half.push_back(g.direction.cast<Long>() * static_cast<Long>(g.length));
  int codes = 1;
  for (std::size_t k = 0; k < n; ++k) codes *= 3;
  Long least = std::numeric_limits<Long>::infinity();
  for (int code = 0; code < codes; ++code) {
    LongVector rest = x;
    std::vector<std::size_t> free;
    for (std::size_t k = 0, digits = static_cast<std::size_t>(code); k < n; ++k, digits /= 3) {
      if (digits % 3 == 1) {
        free.push_back(k);
      } else {
        rest -= (digits % 3 == 0 ? -1 : 1) * half[k];
      }
    }
    if (free.size() > 3) continue;
    if (!free.empty()) {
      Eigen::Matrix<Long, 3, Eigen::Dynamic> sweep(3, free.size());
      for (std::size_t i = 0; i < free.size(); ++i) sweep.col(static_cast<Eigen::Index>(i)) = half[free[i]];
      const Eigen::Matrix<Long, Eigen::Dynamic, 1> best = sweep.colPivHouseholderQr().solve(rest);
      rest -= sweep * best.cwiseMax(Long{-1}).cwiseMin(Long{1});
    }
    least = std::min(least, rest.norm());
  }
  return least;
}

template <int Degree>
LongVector place(const PointMotion<Degree>& path, double t) {
  const Long elapsed = static_cast<Long>(t) - static_cast<Long>(path.start);
  LongVector x = LongVector::Zero();
  for (std::size_t i = Degree + 1; i-- > 0;) x = x * elapsed + path.coefficients[i].template cast<Long>();
  return x;
}

/// How far the surfaces are apart at a time; below zero down to the sum of the radii where they overlap.
template <int Degree>
Long gap_at(const Pieces<Degree>& pieces, const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b,
            double t) {
  const Long radii = static_cast<Long>(rounded_core(a.shape).radius) + static_cast<Long>(rounded_core(b.shape).radius);
  return distance(pieces.generators, place(b.motion, t) - place(a.motion, t)) - radii;
}

// ---- Pairs ----------------------------------------------------------------------------------------------------------

/// Of many scales; of coarse numbers and few orientations, with which things are parallel, touch, graze and meet at one
/// time; and turned nearly alike.
class Pairs {
 public:
  explicit Pairs(Random& random) : random_(random), coarse_(random.one_in(2)) {
    static constexpr std::array scales{1.0, 1e-9, 1e3, 1e9};
    size_ = coarse_ ? 1 : random.one_in(2) ? 1 : scales[random.below(4)];
    speed_ = coarse_ ? 1 : random.one_in(2) ? 1 : scales[random.below(4)];
    place_ = !coarse_ && random.one_in(4) ? 1e6 : 0;
    clock_ = random.one_in(4) ? 0x1p30 : 0;
    common_ = orientation();
  }

  bool coarse() const { return coarse_; }
  PlacedShape capsule() { return collision::place(Capsule{length(), length()}, turned()); }
  PlacedShape other() {
    if (random_.one_in(3)) return placed_ball(length());
    return random_.one_in(2) ? capsule() : collision::place(Box{{length(), length(), length()}}, turned());
  }

  /// Mostly towards the middle.
  template <int Degree>
  PointMotion<Degree> path() {
    PointMotion<Degree> path;
    path.start = clock_ - duration() * number(0, 1);
    const Vector3d from = vector(3);
    path.coefficients[0] = (Vector3d::Constant(place_) + from) * size_;
    path.coefficients[1] = (random_.one_in(4) ? vector(2) : vector(0.5) - 0.5 * from) * speed_;
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
  double length() { return size_ * number(0.5, 1) * (random_.one_in(8) ? 0.125 : 1); }
  Vector3d vector(double size) {
    const double x = number(-size, size);
    const double y = number(-size, size);
    return {x, y, number(-size, size)};
  }
  Quaterniond orientation() {
    if (random_.one_in(3)) return Quaterniond::Identity();
    if (random_.one_in(3)) return {0.5, 0.5, 0.5, random_.one_in(2) ? 0.5 : -0.5};
    return Quaterniond(number(0, 1), number(-1, 1), number(-1, 1), 1).normalized();
  }
  Quaterniond turned() {
    if (random_.one_in(2)) return orientation();
    if (random_.one_in(2)) return common_;
    const double tilt = std::ldexp(1.0, -random_.integer(3, 53));
    return (common_ * Quaterniond(1, tilt, -tilt, tilt)).normalized();
  }

  Random& random_;
  bool coarse_;
  double size_, speed_, place_, clock_;
  Quaterniond common_;
};

}  // namespace

TEMPLATE_TEST_CASE_SIG("Filtered contacts of capsules are those of exact signs alone", "[capsule]",
                       ((int Degree), Degree), 1, 2) {
  constexpr int rounds = 1500;
  int contacts = 0, meetings = 0, partings = 0, estimates = 0;
  std::vector<std::uint64_t> wrong;  // seeds
  for (std::uint64_t seed = 1; seed <= rounds; ++seed) {
    Random random(seed);
    Pairs pairs(random);
    const PlacedShape shape_a = pairs.capsule();
    const PlacedShape shape_b = pairs.other();
    const auto path_a = pairs.path<Degree>();
    const auto path_b = pairs.path<Degree>();
    const TranslatingShape<Degree> a{shape_a, path_a};
    const TranslatingShape<Degree> b{shape_b, path_b};
    const double t0 = pairs.start();
    const double horizon = pairs.horizon();
    const Pieces<Degree> pieces(a, b);
    const bool inside = pieces.inside(t0);
    const double first = pieces.first_inside(t0, horizon);
    const bool ordered = random.one_in(2);
    const auto& x = ordered ? a : b;
    const auto& y = ordered ? b : a;
    PairMemory memory;
    const ContactEstimate estimate = estimated_first_contact(x, y, t0, horizon, ContactMode::transparent, memory);
    bool right = in_contact(x, y, t0) == inside &&
                 first_contact(x, y, t0, horizon, ContactMode::transparent) == first &&
                 (estimate.exact ? estimate.time == first : estimate.time > t0 && estimate.time <= first);
    estimates += !estimate.exact;
    contacts += inside;
    meetings += first > t0 && first != never;
    if (first != never) {
      const double last = pieces.first_outside(first, horizon);
      right = right && in_contact(x, y, first) && first_separation(x, y, first, horizon) == last;
      partings += last != never;
    }
    if (!right) wrong.push_back(seed);
  }
  CAPTURE(Degree, contacts, meetings, partings, estimates);
  CHECK(wrong == std::vector<std::uint64_t>{});
  CHECK(contacts > 100);
  CHECK(meetings > 100);
  CHECK(partings > 100);
  CHECK(estimates > 50);
}

TEMPLATE_TEST_CASE_SIG("Contacts of capsules are where the distances are", "[capsule]", ((int Degree), Degree), 1, 2) {
  constexpr int samples = 60;
  int met = 0, parted = 0, passed = 0;
  for (std::uint64_t seed = 1; seed <= 700; ++seed) {
    Random random(seed);
    Pairs pairs(random);
    const PlacedShape shape_a = pairs.capsule();
    const PlacedShape shape_b = pairs.other();
    const auto path_a = pairs.path<Degree>();
    const auto path_b = pairs.path<Degree>();
    const TranslatingShape<Degree> a{shape_a, path_a};
    const TranslatingShape<Degree> b{shape_b, path_b};
    const Pieces<Degree> pieces(a, b);
    const double t0 = pairs.start();
    const double horizon = t0 + 4 * pairs.duration();
    // What the clock and the oracle do not tell: spacings of doubles at the speeds there are.
    const double scale =
        (place(path_a, horizon).norm() + place(path_b, horizon).norm()) * 0x1p-50L + shape_a.bounding_radius * 0x1p-30;
    const auto speed = path_a.velocity(horizon).norm() + path_b.velocity(horizon).norm() + path_a.velocity(t0).norm() +
                       path_b.velocity(t0).norm();
    const Long rounding = scale + 0x1p-50 * (std::abs(horizon) + 1) * speed;
    const double begin = first_contact(a, b, t0, horizon, ContactMode::transparent);
    INFO("seed " << seed << ", degree " << Degree << ", from " << begin);
    const double until = std::min(begin, horizon);
    bool free = true, held = true;
    for (int i = 0; i < samples; ++i) {
      const double t = t0 + (until - t0) * i / samples;
      free = free && (t >= begin || gap_at(pieces, a, b, t) >= -rounding);
    }
    CHECK(free);
    if (begin == never) {
      ++passed;
      continue;
    }
    if (begin > t0) {
      ++met;
      CHECK(std::abs(gap_at(pieces, a, b, begin)) <= rounding);
      CHECK_FALSE(in_contact(a, b, next_down(begin)));
      const Contact contact = contact_at(a, b, begin);
      const Contact reverse = contact_at(b, a, begin);
      CHECK((contact.normal + reverse.normal).norm() < 1e-6);
      // The point is on both surfaces, and the normal leads from one to the other.
      const auto gap_of_point = [&](const PlacedShape& shape, const PointMotion<Degree>& path) {
        const RoundedCore core = rounded_core(shape);
        const LongVector x = contact.point.cast<Long>() - place(path, begin);
        return distance({core.generators.data(), core.generators.size()}, x) - static_cast<Long>(core.radius);
      };
      CHECK(std::abs(gap_of_point(shape_a, path_a)) <= 4 * rounding);
      CHECK(std::abs(gap_of_point(shape_b, path_b)) <= 4 * rounding);
      CHECK(contact.normal.dot(path_b.velocity(begin) - path_a.velocity(begin)) <= 1e-6 * speed);
    }
    const double end = first_separation(a, b, begin, horizon);
    for (int i = 0; i < samples; ++i) {
      const double t = begin + (std::min(end, horizon) - begin) * i / samples;
      held = held && gap_at(pieces, a, b, t) <= rounding;
    }
    CHECK(held);
    if (end == never || end == begin) continue;
    ++parted;
    CHECK(std::abs(gap_at(pieces, a, b, end)) <= rounding);
    CHECK(in_contact(a, b, next_down(end)));
  }
  CHECK(met > 50);
  CHECK(parted > 50);
  CHECK(passed > 50);
}

}  // namespace test_capsule_contact
