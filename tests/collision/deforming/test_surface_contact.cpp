#include "collision/deforming/deforming_mesh.hpp"
#include "collision/deforming/surface_contact.hpp"
#include "tests/collision/deforming/exact_surfaces.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace test_surface_contact {
namespace {

using namespace kds;
using namespace kds::collision;
using namespace kds::tests;
using Eigen::Vector3d;

/// How random surfaces are made.
enum class Family { soup, in_plane, sliding, thin, lattice, far };
constexpr std::array families{Family::soup, Family::in_plane, Family::sliding,
                              Family::thin, Family::lattice,  Family::far};

/// A strip of triangles with random vertices on random paths.
template <int Degree>
BentSurface<Degree> strip(Random& random, Family family, std::uint32_t triangles, const Vector3d& centre) {
  BentSurface<Degree> surface;
  for (std::uint32_t i = 0; i < triangles; ++i) surface.triangles.push_back({i, i + 1, i + 2});
  const auto number = [&](double size) {
    return family == Family::lattice ? random.integer(-4, 4) * size / 4 : random.between(-size, size);
  };
  const auto vector = [&](double size) { return Vector3d(number(size), number(size), number(size)); };
  const Vector3d velocity = -1.5 * centre + vector(0.5);
  for (std::uint32_t v = 0; v < triangles + 2; ++v) {
    Vector3d begin = centre + vector(0.75);
    if (family == Family::thin && v > 1) {  // one corner on the line through two others, or close
      begin = 0.5 * (surface.control[0][v - 1] + surface.control[0][v - 2]) + vector(1e-9) * random.integer(0, 1);
    }
    Vector3d end = begin + velocity + vector(family == Family::sliding ? 0 : 0.5);
    if (family == Family::in_plane) begin[2] = end[2] = 0;
    if (family == Family::sliding && v < 3) begin[2] = end[2] = 0;  // the first triangle stays in a plane
    if (family == Family::far) {
      begin = (begin * 1024).array().round() / 1024 + 1e9;
      end = (end * 1024).array().round() / 1024 + 1e9;
    }
    surface.control[0].push_back(begin);
    surface.control[Degree].push_back(end);
    if constexpr (Degree == 2) {
      Vector3d middle = 0.5 * (begin + end) + vector(0.5);
      if (family == Family::in_plane) middle[2] = 0;
      if (family == Family::far) middle = (middle * 1024).array().round() / 1024;
      surface.control[1].push_back(middle);
    }
  }
  return surface;
}

template <int Degree>
DeformingMesh<Degree> mesh_of(const BentSurface<Degree>& bent, double t0, double t1) {
  DeformingMesh<Degree> mesh(bent.control[0], bent.triangles);
  std::array<std::span<const Vector3d>, std::size_t{Degree} + 1> control;
  for (std::size_t i = 0; i <= Degree; ++i) control[i] = bent.control[i];
  mesh.set_control_points(t0, t1, control);
  mesh.surface().audit();
  return mesh;
}

struct Tally {
  std::map<std::string, int> complaints;
  int asked = 0, touching = 0, reported = 0;

  std::string text() const {
    std::string all = std::to_string(asked) + " asked, " + std::to_string(touching) + " touch, " +
                      std::to_string(reported) + " reported; ";
    for (const auto& [what, count] : complaints) all += what + ": " + std::to_string(count) + "; ";
    return all;
  }
};

}  // namespace

TEMPLATE_TEST_CASE_SIG("surfaces that bend: no contact is missed, late, or farther than the tolerance", "[deforming]",
                       ((int Degree), Degree), 1, 2) {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  CAPTURE(Degree, seed);
  Random random(seed);
  Tally tally;
  for (const Family family : families) {
    const std::string where = "family " + std::to_string(static_cast<int>(family));
    for (int i = 0; i < (Degree == 1 ? 6 : 2); ++i) {
      const bool itself = i % 4 == 3;
      const double t0 = i % 3 == 0 ? 0 : 1e6;  // a large clock
      const double t1 = t0 + 0.75;
      const double from = i % 2 == 0 ? t0 : t0 + 0.25;
      const auto a = strip<Degree>(random, family, itself ? 5 : 3, itself ? Vector3d::Zero() : Vector3d(1.5, 0.5, 0));
      const auto b = itself ? a : strip<Degree>(random, family, 3, Vector3d(-1, 0, 0.25));
      const DeformingMesh<Degree> mesh_a = mesh_of(a, t0, t1);
      const DeformingMesh<Degree> mesh_b = mesh_of(b, t0, t1);
      const SurfaceQuery query{.from = from, .overlaps = false};
      const auto found = itself ? first_self_contact(mesh_a.surface(), query)
                                : first_contact(mesh_a.surface(), mesh_b.surface(), query);
      const auto all =
          itself ? all_self_contacts(mesh_a.surface(), query) : all_contacts(mesh_a.surface(), mesh_b.surface(), query);
      const auto truth = first_touch(a, b, itself, t0, t1, from);
      const auto complain = [&](const std::string& what) { ++tally.complaints[what + ": " + where]; };
      ++tally.asked;
      tally.touching += truth.has_value();
      tally.reported += found.has_value();
      if (truth && !found) complain("missed");
      if (found.has_value() == all.empty()) complain("first and all differ");
      if (!found) continue;
      if (truth && truth->compare(oracle::rational(found->contact.time)) < 0) complain("late");
      if (all.front().contact.time != found->contact.time || all.front().vertices != found->vertices ||
          all.front().contact.feature_a != found->contact.feature_a) {
        complain("first and all differ");
      }
      for (const SurfaceContact& contact : all) {
        const double clock = t0 > 0 ? 4e-9 : 0;  // what moves while it goes on by some spacings
        const std::string what = complaint(contact, a, b, t0, t1, 1e-7 * 12 + clock);
        if (!what.empty()) complain(what);
      }
    }
  }
  INFO(tally.text());
  CHECK(tally.complaints.empty());
  CHECK(tally.touching > tally.asked / 4);
}

}  // namespace test_surface_contact
