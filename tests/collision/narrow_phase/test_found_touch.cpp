// What the search for a contact hands on to its description, and what it leaves out, changes nothing.
#include "collision/narrow_phase/convex_touch.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "tests/collision/narrow_phase/random_pairs.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <vector>

namespace test_found_touch {
namespace {

using namespace kds;
using namespace kds::collision;
using samples::Random;

bool same(const Contact& x, const Contact& y) {
  return x.time == y.time && x.point == y.point && x.normal == y.normal && x.feature_a == y.feature_a &&
         x.feature_b == y.feature_b;
}

PlacedTriangle random_triangle(Random& random) { return {{random.vector(1), random.vector(1), random.vector(1)}}; }

}  // namespace

TEMPLATE_TEST_CASE_SIG("A contact is described alike with and without what was found", "[found_touch]",
                       ((int Degree), Degree), 1, 2) {
  int found_ones = 0, met = 0, again = 0;
  std::vector<std::uint64_t> wrong;  // seeds
  for (std::uint64_t seed = 1; seed <= 8000; ++seed) {
    Random random(seed);
    const double clock = random.below(4) == 0 ? 0x1p20 : 0.0;
    const PlacedShape mesh = samples::shape_of_kind(random, random.below(2), samples::Cubes::facing);
    const PlacedShape other = samples::shape_of_kind(random, random.below(5), samples::Cubes::facing);
    auto path_a = samples::random_path<Degree>(random, clock, 1);
    auto path_b = samples::random_path<Degree>(random, clock, 1);
    path_b.coefficients[1] += path_a.coefficients[0] - path_b.coefficients[0];
    if (random.below(4) != 0) path_b.coefficients[0] -= 2 * path_b.coefficients[1];
    const bool swapped = random.below(2) == 0;
    const TranslatingShape<Degree> a{swapped ? other : mesh, path_a};
    const TranslatingShape<Degree> b{swapped ? mesh : other, path_b};
    const ContactMode mode = random.below(2) == 0 ? ContactMode::transparent : ContactMode::resolved;
    double from = clock;
    for (int turn = 0; turn < 6; ++turn) {
      FoundTouch found;
      const double time = first_contact(a, b, from, never, mode, &found);
      if (time == never) break;
      ++met;
      if (found.time != never) {
        ++found_ones;
        again += turn > 0;
        if (found.time != time || !same(contact_at(a, b, time, found), contact_at(a, b, time))) wrong.push_back(seed);
      }
      const Contact contact = contact_at(a, b, time, found);
      if (mode == ContactMode::resolved) {
        path_a = path_a.restarted(time);
        path_b = path_b.restarted(time);
        // b slides along a, parting or not.
        const Eigen::Vector3d slide = random.vector(1);
        path_b.coefficients[1] =
            path_a.coefficients[1] + slide +
            (random.below(2) * 0.1 * random.uniform(0, 1) - slide.dot(contact.normal)) * contact.normal;
        from = time;
      } else {
        from = first_separation(a, b, time, never);
        if (from == never) break;
      }
    }
  }
  CAPTURE(Degree);
  CHECK(wrong == std::vector<std::uint64_t>{});
  CHECK(met > 1000);
  CHECK(found_ones > met / 3);
  CHECK(again > 20);
}

TEST_CASE("Within a window two triangles touch as they do at all", "[found_touch]") {
  int touched = 0, apart = 0, at_begin = 0;
  std::vector<std::uint64_t> wrong;  // seeds
  for (std::uint64_t seed = 1; seed <= 60000; ++seed) {
    Random random(seed);
    const PlacedTriangle a = random_triangle(random);
    PlacedTriangle b = random_triangle(random);
    if (random.below(4) == 0) b = a;  // nothing but ties
    RelativeMotion<1> motion;
    motion.coefficients = {random.vector(3), random.vector(3)};
    if (random.below(8) == 0) motion.coefficients[1].setZero();
    const ContactGap<1> gap = contact_gap(motion, 4);
    const bool sharp = random.below(2) == 0;
    const ConvexTouch<1, PlacedTriangle> whole(a, b, motion, gap, sharp);
    TimeWindow window{random.uniform(0, 2), 0};
    window.end = window.begin + random.uniform(0, 3);
    const double first = whole.first_inside(0);
    if (first < window.begin && whole.first_inside(window.begin) != window.begin) continue;  // against the precondition
    const ConvexTouch<1, PlacedTriangle> part(a, b, motion, gap, sharp, window);
    const double wanted = whole.first_inside(window.begin);
    const double got = part.first_inside(window.begin);
    if (wanted > window.end) {
      ++apart;
      if (!(got > window.end)) wrong.push_back(seed);
    } else {
      ++touched;
      at_begin += wanted == window.begin;
      if (got != wanted || part.approaching(got) != whole.approaching(wanted)) wrong.push_back(seed);
    }
  }
  CHECK(wrong == std::vector<std::uint64_t>{});
  CHECK(touched > 500);
  CHECK(at_begin > 100);
  CHECK(apart > 500);
}

}  // namespace test_found_touch
