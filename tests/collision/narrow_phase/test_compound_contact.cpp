// Contacts of bodies of several parts, against those of each pair of parts by itself.
#include "collision/narrow_phase/compound_contact.hpp"
#include "collision/narrow_phase/pair_tests.hpp"
#include "collision/narrow_phase/part_pairs.hpp"
#include "collision/shapes/compound.hpp"
#include "tests/collision/sample_compounds.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace kds::collision::test_compound_contact {
namespace {

using namespace tests;

using Stretch = std::pair<double, double>;  // contact, separation or `never`

/// All contacts of two shapes from 0 to the end.
template <int Degree>
std::vector<Stretch> contacts_of(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b, double end) {
  std::vector<Stretch> found;
  for (double t = 0;;) {
    const double begin = first_contact(a, b, t, end, ContactMode::transparent);
    if (begin == never) return found;
    t = first_separation(a, b, begin, end);
    found.emplace_back(begin, t);
    if (t == never) return found;
  }
}

/// The times at which some pair of parts is in contact, each pair tested by itself.
template <int Degree>
std::vector<Stretch> contacts_of_parts(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b,
                                       double end) {
  std::vector<Stretch> all;
  for (const PlacedShape& part_a : parts_of(a.shape)) {
    for (const PlacedShape& part_b : parts_of(b.shape)) {
      const auto found =
          contacts_of(TranslatingShape<Degree>{part_a, a.motion}, TranslatingShape<Degree>{part_b, b.motion}, end);
      all.insert(all.end(), found.begin(), found.end());
    }
  }
  std::sort(all.begin(), all.end());
  std::vector<Stretch> joined;
  for (const Stretch& each : all) {
    if (!joined.empty() && each.first <= joined.back().second) {
      joined.back().second = std::max(joined.back().second, each.second);
    } else {
      joined.push_back(each);
    }
  }
  return joined;
}

template <int Degree>
std::size_t compare_with_parts(std::uint64_t seed, Parts kinds) {
  Random random(seed);
  SceneOptions options;
  options.shapes = kinds == Parts::all ? Shapes::mixture : Shapes::turned_boxes;
  options.bodies = 8;
  options.side = 5;
  const auto scene = compound_scene<Degree>(random, options, kinds, 6);
  std::vector<PlacedShape> placed;
  for (const auto& b : scene.bodies) placed.push_back(place(b.shape, b.orientation));
  std::size_t contacts = 0;
  for (std::size_t i = 0; i < placed.size(); i += 2) {
    for (std::size_t j = 0; j < placed.size(); ++j) {
      if (i == j) continue;
      const TranslatingShape<Degree> a{placed[i], scene.bodies[i].motion[0]};
      const TranslatingShape<Degree> b{placed[j], scene.bodies[j].motion[0]};
      INFO("seed " << seed << ", bodies " << i << " and " << j);
      const auto found = contacts_of(a, b, 4.0);
      const bool same = found == contacts_of_parts(a, b, 4.0);
      CHECK(same);
      contacts += found.size();
      PairMemory memory;
      const auto& of_pair = pair_tests<certificates::PointMotion<Degree>>(a.shape, b.shape);
      const double apart = of_pair.apart_until(a, b, 0, 4, memory);
      CHECK(apart <= (found.empty() ? never : found[0].first));
      for (const auto& [begin, end] : found) {
        if (begin > 0) CHECK(!in_contact(a, b, next_down(begin)));
        CHECK(in_contact(a, b, begin));
        if (end != never) CHECK((!in_contact(a, b, end) && in_contact(a, b, next_down(end))));
      }
    }
  }
  return contacts;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("compounds are in contact exactly while some of their parts are", "[compound]",
                       ((int Degree), Degree), 1, 2) {
  std::size_t contacts = 0;
  for (const Parts kinds : {Parts::boxes, Parts::solids, Parts::all}) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) contacts += compare_with_parts<Degree>(seed, kinds);
  }
  CHECK(contacts > 200);
}

TEST_CASE("parts that cannot meet in the time are not looked at", "[compound]") {
  std::vector<CompoundPart> row;
  for (int i = 0; i < 50; ++i) row.push_back({Box{{0.5, 0.5, 0.5}}, {i - 24.5, 0, 0}, Eigen::Quaterniond::Identity()});
  const PlacedShape placed = place(compound(row), Eigen::Quaterniond::Identity());
  const PlacedShape ball = placed_ball(0.25);
  const certificates::PointMotion<1> still{{Vector3d(0, 0, 0), Vector3d(0, 0, 0)}};
  const certificates::PointMotion<1> falling{{Vector3d(3.5, 0, 9), Vector3d(0, 0, -1)}};
  const TranslatingShape<1> a{placed, still}, b{ball, falling};
  CHECK(PartPairs<1>(a, b, 0, 20).in_time().size() == 1);
  CHECK(PartPairs<1>(a, b, 0, 8).in_time().empty());
  CHECK(PartPairs<1>(a, b, 0, never).in_time().size() == 1);
  CHECK(first_contact(a, b, 0, never, ContactMode::resolved) == 8.25);
}

TEST_CASE("a box cut in two is in contact when the whole one is, to the bit", "[compound]") {
  std::size_t contacts = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Random random(seed);
    SceneOptions options;
    options.shapes = seed % 2 == 0 ? Shapes::spheres : Shapes::boxes;
    options.numbers = seed % 3 == 0 ? Numbers::coarse : Numbers::fine;
    options.bodies = 5;
    options.side = 4;
    SceneMaker maker(random, options);
    const auto scene = maker.scene<2>();
    const Vector3d half(0.5 + 0.125 * random.integer(0, 4), 0.75, 0.125 * random.integer(2, 9));
    const PlacedShape whole = place(Box{half}, Eigen::Quaterniond::Identity());
    const PlacedShape cut = place(cut_box(half, 0.25 * random.integer(-3, 3)), Eigen::Quaterniond::Identity());
    const auto path = maker.path<2>(0);
    for (const auto& other : scene.bodies) {
      const PlacedShape shape = place(other.shape, Eigen::Quaterniond::Identity());
      const TranslatingShape<2> b{shape, other.motion[0]};
      INFO("seed " << seed);
      const auto found = contacts_of(TranslatingShape<2>{cut, path}, b, 4.0);
      const bool same = found == contacts_of(TranslatingShape<2>{whole, path}, b, 4.0);
      CHECK(same);
      contacts += found.size();
    }
  }
  CHECK(contacts > 60);
}

TEST_CASE("the place of a contact is that of the parts that touch and approach", "[compound]") {
  // An angle: a plate to stand on, and a wall on its right.
  const std::vector<CompoundPart> parts{{Box{{2, 2, 0.5}}, {0, 0, -0.5}}, {Box{{0.5, 2, 2}}, {2.5, 0, 1}}};
  const PlacedShape angle = place(compound(parts), Eigen::Quaterniond::Identity());
  const PlacedShape ball = placed_ball(0.5);
  const certificates::PointMotion<1> still{{zero, zero}};
  const TranslatingShape<1> a{angle, still};
  const certificates::PointMotion<1> down{{Vector3d(0, 0, 2), Vector3d(1, 0, -1)}};
  const TranslatingShape<1> b{ball, down};
  const double first = first_contact(a, b, 0, 9, ContactMode::resolved);
  CHECK(first == 1.5);  // both at once, and the plate comes first
  const Contact contact = contact_at(a, b, first);
  CHECK(contact.normal == Vector3d::UnitZ());
  CHECK(contact.point == Vector3d(1.5, 0, 0));
  CHECK(contact.feature_a == Feature::face(contact.feature_a.first));
  // It leaves the plate, and still approaches the wall.
  const certificates::PointMotion<1> along{{down.position(1.5), Vector3d(1, 0, 1)}, 1.5};
  const TranslatingShape<1> turned{ball, along};
  CHECK(first_contact(a, turned, 1.5, 9, ContactMode::resolved) == 1.5);
  CHECK(contact_at(a, turned, 1.5).normal == -Vector3d::UnitX());
  CHECK(contact_at(turned, a, 1.5).normal == Vector3d::UnitX());
  const certificates::PointMotion<1> away{{down.position(1.5), Vector3d(-1, 0, 1)}, 1.5};
  CHECK(first_contact(a, TranslatingShape<1>{ball, away}, 1.5, 9, ContactMode::resolved) == never);
}

}  // namespace kds::collision::test_compound_contact
