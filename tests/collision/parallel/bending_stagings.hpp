// Random scenes of all that is divided, with meshes that bend.
#pragma once

#include "tests/collision/parallel/stagings.hpp"
#include "tests/collision/sample_sheets.hpp"

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace kds::collision::tests {

/// The scenes of StageMaker, and sheets that bend: that stand, move or jump by scripts, are sensors, meet themselves,
/// or, where bodies pass through each other, move by themselves.
template <class Motion>
class BendingStageMaker {
  using Vector = Eigen::Vector3d;

 public:
  explicit BendingStageMaker(std::uint64_t seed) : stages_(seed), random_(1000 + seed) {}

  Staging<Motion> scene() {
    Staging<Motion> scene = stages_.scene();
    std::vector<BasicBodyDescription<Motion>> sheets;
    for (int left = random_.integer(1, 4); left > 0; --left) sheets.push_back(sheet(scene.options));
    const auto fill = [=, before = scene.fill](BasicWorld<Motion>& world) {
      for (const auto& description : sheets) world.add_body(description);
      before(world);
    };
    return {scene.options, fill, scene.end_time, scene.what + " and " + std::to_string(sheets.size()) + " sheets"};
  }
  Manner manner(std::size_t most_domains) { return stages_.manner(most_domains); }

 private:
  BasicBodyDescription<Motion> sheet(const WorldOptions& options) {
    const samples::Sheet flat(3);
    const double size = random_.between(0.5, 2);
    const bool may_meet_itself = random_.one_in(3);
    std::vector<MeshScript::Keyframe> keyframes;
    double time = random_.between(-0.5, 0.5);
    for (int left = random_.integer(1, 5); left > 0; --left) {
      auto positions = flat.positions;
      for (Vector& p : positions) p = size * (p + vector(may_meet_itself ? 0.75 : 0.3));
      keyframes.push_back({time, positions});
      time += random_.between(0.1, 0.8);
    }
    BasicBodyDescription<Motion> sheet;
    sheet.shape = BendingMesh{std::make_shared<const MeshScript>(std::move(keyframes), flat.triangles)};
    sheet.motion = {Motion{}};
    path(sheet.motion[0]).coefficients[0] = Vector::Constant(2) + vector(3);
    sheet.self_contacts = may_meet_itself;
    sheet.sensor = random_.one_in(5);
    sheet.fixed = sheet.sensor || options.response != Response::none || random_.one_in(2);
    // What moves would press others against walls.
    if (!options.walls && random_.one_in(2)) path(sheet.motion[0]).coefficients[1] = vector(1);
    if (random_.one_in(2)) sheet.restitution = random_.between(0.5, 1);
    if (!options.walls && random_.one_in(3)) {
      Motion next{};
      path(next).start = random_.between(0.2, 1);
      path(next).coefficients[0] = path_of(sheet.motion[0]).position(path(next).start);
      if (random_.one_in(2)) path(next).coefficients[0] += vector(0.5);
      path(next).coefficients[1] = vector(1);
      sheet.motion.push_back(next);
    }
    return sheet;
  }
  Vector vector(double most) {
    const double x = random_.between(-most, most), y = random_.between(-most, most), z = random_.between(-most, most);
    return {x, y, z};
  }
  static auto& path(Motion& motion) {
    if constexpr (turns<Motion>) {
      return motion.path;
    } else {
      return motion;
    }
  }

  StageMaker<Motion> stages_;
  Random random_;
};

/// As compare_stagings(); by hand KDS_BENDING_SEEDS.
template <class Motion>
void compare_bending_stagings(std::initializer_list<Seeds> seeds, Seen& seen) {
  compare_seeds<BendingStageMaker<Motion>>("KDS_BENDING_SEEDS", seeds, seen);
}

}  // namespace kds::collision::tests
