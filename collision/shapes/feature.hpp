// The part of a shape that takes part in a contact.
#pragma once

#include <compare>
#include <cstdint>
#include <ostream>
#include <string>

namespace kds::collision {

/// A vertex, an edge or a face of a shape. Indices count from 0; an edge is named by its two vertices, lower first.
/// Those of a mesh are indices into its vertices and triangles. Of a box, in its own orientation, vertex i has
/// coordinate d at +half extent where bit d of i is set; face 2 d is the one at -half extent on axis d, face 2 d + 1
/// the opposite one. Those of a hull are indices into the points that were given, and into the faces of HullStructure.
/// Of a capsule, vertex 0 is the end at -half_length, vertex 1 the other, and its only edge its side.
struct Feature {
  enum class Kind : std::uint8_t { none, vertex, edge, face };  ///< none: the shape has no such parts

  Kind kind = Kind::none;
  std::uint32_t first = 0;   ///< the vertex or face; of an edge its lower vertex
  std::uint32_t second = 0;  ///< of an edge its higher vertex, else 0

  static constexpr Feature vertex(std::uint32_t index) { return {Kind::vertex, index, 0}; }
  static constexpr Feature edge(std::uint32_t a, std::uint32_t b) {
    return a < b ? Feature{Kind::edge, a, b} : Feature{Kind::edge, b, a};
  }
  static constexpr Feature face(std::uint32_t index) { return {Kind::face, index, 0}; }

  friend constexpr auto operator<=>(const Feature&, const Feature&) = default;
};

template <class Archive>
void archive_members(Archive& archive, Feature& feature) {
  archive(feature.kind, feature.first, feature.second);
}

/// "-" for none, else "v12", "e3-17", "f40".
inline std::string to_string(const Feature& feature) {
  switch (feature.kind) {
    case Feature::Kind::vertex:
      return "v" + std::to_string(feature.first);
    case Feature::Kind::edge:
      return "e" + std::to_string(feature.first) + "-" + std::to_string(feature.second);
    case Feature::Kind::face:
      return "f" + std::to_string(feature.first);
    case Feature::Kind::none:
      break;
  }
  return "-";
}

inline std::ostream& operator<<(std::ostream& out, const Feature& feature) { return out << to_string(feature); }

}  // namespace kds::collision
