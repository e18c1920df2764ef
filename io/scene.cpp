#include "io/scene.hpp"

#include "io/checksum.hpp"
#include "io/one_line.hpp"

namespace kds::io {

int Scene::degree() const {
  if (share.degree == 2) return 2;
  for (const SceneBody& body : bodies) {
    for (const MotionPiece& piece : body.motion) {
      if (!piece.path.coefficients[2].isZero(0)) return 2;
    }
  }
  return 1;
}

std::string Scene::name_of(std::size_t number) const {
  if (!is_share()) return bodies[number].name;
  if (number < share.names.size()) return share.names[number];
  number -= share.names.size();
  auto table = share.tables.begin();
  while (number >= table->second) number -= table->second, ++table;
  return table->first + std::to_string(number);
}

std::uint64_t fingerprint(const Scene& scene) {
  std::uint64_t all = first_chain;
  for (const SceneSource& source : scene.sources) all = chained(all, source.checksum);
  return all;
}

SceneError::SceneError(const std::string& file, const std::string& where, const std::string& what)
    : std::runtime_error(one_line(file + ": " + where + ": " + what)) {}

}  // namespace kds::io
