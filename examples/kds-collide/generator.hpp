// Scenes of many bodies from a seed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace kds_collide {

/// Of bodies that turn, rad/s: about a turn in the run, in which a body goes about as far as its bounding radius.
inline constexpr double most_turning = 6;

inline constexpr double default_density = 0.01;
inline constexpr double default_end_time = 1;  ///< s

struct GeneratorOptions {
  std::string kind = "rings";  ///< see generator_kinds()
  std::size_t bodies = 1000;   ///< 1 to 10 000 000
  /// Volume of all bounding balls over the volume of the domain, 1e-12 to 0.3: default_density unless given. None may
  /// be given unless has_density().
  std::optional<double> density{};
  std::uint64_t seed = 1;
  /// s: default_end_time unless given, and 8 of crates.
  std::optional<double> end_time{};
  /// The name of an HDF5 file that is to hold the bodies, in columns; empty: they are in the scene.
  std::string table;
};

/// A scene and the files it names, as what is to be written.
struct GeneratedScene {
  struct File {
    std::string name;
    std::string text;
  };
  std::string json;
  std::vector<File> meshes;
  std::string table;  ///< bytes; empty if none was asked for
};

/// rings: [Coming06] section 5, tori of 64 triangles. models: [Coming06] Figure 6, closed models of over 6 000
/// triangles. spheres; boxes. spinners: cubes, rods and plates that turn about fixed axes, as bodies of equal moments
/// of inertia do. spinning-rings, rods, plates, capsules: these precess, since their moments are those of their shapes.
/// sheet: one of 1 152 triangles on which waves run, and the bodies, balls that fly through it. crates: these, boards
/// and rods that fall into a box and come to rest, a dozen in some 4 s.
std::vector<std::string_view> generator_kinds();

/// Whether bodies of a kind are strewn over a domain. Those of sheet and crates have places of their own.
bool has_density(std::string_view kind);

/// The scene of [Coming06] section 5 with any shape: bounding radii uniform in 0.5-1.5, speeds uniform in 0.5-1.5 times
/// their mean in random directions, random orientations, positions uniform where bounding balls do not overlap, in a
/// cube with reflecting walls. The kinds from spinners to capsules turn besides, at up to most_turning about axes in
/// random directions. One seed gives one text, on every compiler and machine. Throws std::invalid_argument for options
/// out of range, and where no room is left for a body.
GeneratedScene generate_scene(const GeneratorOptions& options);

}  // namespace kds_collide
