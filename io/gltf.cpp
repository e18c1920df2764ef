#include "io/gltf.hpp"

#include "certificates/turning/turned_orientation.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "collision/shapes/shape_forms.hpp"
#include "io/base64.hpp"
#include "io/pictures/body_surface.hpp"
#include "io/pictures/compound_surface.hpp"
#include "io/pictures/half_space_patch.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

namespace kds::io {
namespace {

using Eigen::Vector3d;
using nlohmann::json;

constexpr double most_keys = 1e8;

/// The format's numbers for types of components and of data.
constexpr int as_float = 5126, as_uint32 = 5125, as_vertices = 34962, as_indices = 34963;

/// The parts of the document, and the bytes that they name.
class Document {
 public:
  json root = {{"asset", {{"version", "2.0"}, {"generator", "kds-collide"}}}};

  /// Appends to an array of the document, and returns the place.
  std::size_t add(const char* array, json part) {
    root[array].push_back(std::move(part));
    return root[array].size() - 1;
  }
  /// Numbers, `width` a row, as data of a mesh (`target`) or of an animation (0).
  std::size_t floats(const std::vector<float>& values, std::size_t width, int target) {
    std::vector<float> low(width, INFINITY), high(width, -INFINITY);
    for (std::size_t i = 0; i < values.size(); ++i) {
      low[i % width] = std::min(low[i % width], values[i]), high[i % width] = std::max(high[i % width], values[i]);
    }
    for (const float value : values) append(std::bit_cast<std::uint32_t>(value));
    const char* const type = width == 1 ? "SCALAR" : width == 3 ? "VEC3" : "VEC4";
    return add("accessors", {{"bufferView", view(4 * values.size(), target)},
                             {"componentType", as_float},
                             {"count", values.size() / width},
                             {"type", type},
                             {"min", low},
                             {"max", high}});
  }
  std::size_t indices(const std::vector<std::uint32_t>& values) {
    for (const std::uint32_t value : values) append(value);
    return add("accessors", {{"bufferView", view(4 * values.size(), as_indices)},
                             {"componentType", as_uint32},
                             {"count", values.size()},
                             {"type", "SCALAR"}});
  }
  std::string text() {
    if (!bytes_.empty()) {
      add("buffers",
          {{"byteLength", bytes_.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes_)}});
    }
    return root.dump(-1, ' ', false, json::error_handler_t::replace);
  }

 private:
  void append(std::uint32_t bits) {  // least byte first, on every machine
    for (int k = 0; k < 4; ++k) bytes_.push_back(static_cast<std::uint8_t>(bits >> (8 * k)));
  }
  std::size_t view(std::size_t length, int target) {
    json part = {{"buffer", 0}, {"byteOffset", bytes_.size() - length}, {"byteLength", length}};
    if (target != 0) part["target"] = target;
    return add("bufferViews", std::move(part));
  }

  std::vector<std::uint8_t> bytes_;
};

/// What an animation changes of one body: keys.
struct Keys {
  std::vector<float> times, values;

  /// Times have to ascend: where a body jumps its new place is one float later.
  void add(double time, const auto& value) {
    auto t = static_cast<float>(time);
    if (!times.empty() && t <= times.back()) t = std::nextafter(times.back(), INFINITY);
    times.push_back(t);
    for (const double x : value) values.push_back(static_cast<float>(x));
  }
};

/// Colours of bodies that move, and numbers of those of others.
constexpr std::size_t colours = 8, of_fixed = 8, of_sensors = 9;

class Exporter {
 public:
  Exporter(const Scene& scene, const Record& record, double rate) : scene_(scene), record_(record), rate_(rate) {}

  std::string make(const std::string& title) {
    check_length();
    // The format's y axis points up.
    const double half = std::sqrt(0.5);
    document_.add("nodes", {{"name", title}, {"rotation", {-half, 0, 0, half}}});
    for (std::uint32_t place = 0; place < scene_.bodies.size(); ++place) add_body(place);
    document_.add("scenes", {{"name", title}, {"nodes", {0}}});
    document_.root["scene"] = 0;
    if (!channels_.empty()) {
      document_.add("animations", {{"name", title}, {"channels", channels_}, {"samplers", samplers_}});
    }
    return document_.text();
  }

 private:
  double length() const { return scene_.end_time - scene_.begin_time; }

  void check_length() const {
    const double keys = length() * rate_ * static_cast<double>(scene_.bodies.size());
    if (keys > most_keys)
      throw std::length_error("glTF: more than a hundred million keys: ask for fewer frames a second");
  }

  void add_body(std::uint32_t place) {
    const SceneBody& body = scene_.bodies[place];
    const Vector3d scale = surface_scale(body.shape);
    const auto pieces = record_.drawn(scene_, place);
    const Eigen::Quaterniond& q = body.orientation;
    json node = {{"name", body.name},
                 {"mesh", mesh_of_body(body)},
                 {"scale", {scale[0], scale[1], scale[2]}},
                 {"rotation", {q.x(), q.y(), q.z(), q.w()}}};
    if (!pieces.empty()) {
      const Vector3d x = pieces[0].path.position(std::max(pieces[0].start(), scene_.begin_time));
      node["translation"] = {x[0], x[1], x[2]};
    }
    const std::size_t number = document_.add("nodes", std::move(node));
    document_.root["nodes"][0]["children"].push_back(number);
    animate(number, body, pieces, record_.end(place), scale);
  }

  void animate(std::size_t node, const SceneBody& body, const std::vector<RecordedPiece>& pieces, double end,
               const Vector3d& scale) {
    const double last = std::min(end, scene_.end_time);
    Keys places, turns, sizes;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const RecordedPiece& piece = pieces[i];
      const double from = std::max(piece.start(), scene_.begin_time);
      const double to = i + 1 < pieces.size() ? std::min(pieces[i + 1].start(), last) : last;
      if (!(to >= from)) continue;
      const bool turning = !piece.angular_velocity.isZero(0);
      const bool curved = turning || piece.terms() > 2;
      const double parts = curved ? std::ceil((to - from) * rate_) : 1;
      // The end of a piece is the beginning of the next, unless that is elsewhere.
      const bool goes_on = i + 1 < pieces.size() && pieces[i + 1].start() <= last &&
                           (pieces[i + 1].path.position(to) - piece.path.position(to)).norm() <=
                               1e-6 * (scale.norm() + piece.path.position(to).norm());
      for (double k = 0; k <= parts - (goes_on ? 1 : 0); ++k) {
        const double t = parts > 0 ? from + (to - from) * k / parts : from;
        places.add(t - scene_.begin_time, piece.path.position(t));
        if (!scene_.turning) continue;
        const Eigen::Quaterniond q = kds::certificates::turned_orientation(piece.orientation, piece.spin(), t);
        turns.add(t - scene_.begin_time, Eigen::Vector4d(q.coeffs().normalized()));
      }
    }
    const double first = pieces.empty() ? scene_.end_time : pieces[0].start();
    if (first > scene_.begin_time || end < scene_.end_time) {
      if (first > scene_.begin_time) sizes.add(0, Vector3d(Vector3d::Zero()));
      sizes.add(std::max(0.0, first - scene_.begin_time), scale);
      if (end < scene_.end_time) sizes.add(end - scene_.begin_time, Vector3d(Vector3d::Zero()));
    }
    if (places.times.size() > 1) channel(node, "translation", places, 3, "LINEAR");
    if (turns.times.size() > 1) channel(node, "rotation", turns, 4, "LINEAR");
    if (sizes.times.size() > 1) channel(node, "scale", sizes, 3, "STEP");
    const auto* const script = script_of(body.shape);
    if (!script || script->keyframes().size() < 2) return;
    const auto keyframes = script->keyframes();
    Keys weights;
    std::vector<double> one(keyframes.size() - 1);
    for (std::size_t k = 0; k < keyframes.size(); ++k) {
      std::fill(one.begin(), one.end(), 0.0);
      if (k > 0) one[k - 1] = 1;
      weights.add(std::max(0.0, keyframes[k].time - scene_.begin_time), one);
    }
    channel(node, "weights", weights, 1, "LINEAR");
  }

  void channel(std::size_t node, const char* path, const Keys& keys, std::size_t width, const char* between) {
    samplers_.push_back({{"input", document_.floats(keys.times, 1, 0)},
                         {"output", document_.floats(keys.values, width, 0)},
                         {"interpolation", between}});
    channels_.push_back({{"sampler", samplers_.size() - 1}, {"target", {{"node", node}, {"path", path}}}});
  }

  /// One mesh for all bodies of a shape and colour.
  std::size_t mesh_of_body(const SceneBody& body) {
    const std::size_t colour = body.sensor ? of_sensors : body.fixed ? of_fixed : body_count_++ % colours;
    if (const auto* script = script_of(body.shape)) return add_bending(*script, material(colour));
    const auto [known, is_new] = meshes_.try_emplace(std::pair(surface_key(body.shape), colour), 0);
    if (is_new) {
      known->second = add_mesh(surface_of(body.shape), material(colour), json::array());
    }
    return known->second;
  }

  std::size_t add_mesh(const Surface& surface, std::size_t material, json targets) {
    json attributes = {{"POSITION", document_.floats(surface.places, 3, as_vertices)}};
    if (!surface.normals.empty()) attributes["NORMAL"] = document_.floats(surface.normals, 3, as_vertices);
    json primitive = {
        {"attributes", attributes}, {"indices", document_.indices(surface.triangles)}, {"material", material}};
    if (!targets.empty()) primitive["targets"] = std::move(targets);
    return document_.add("meshes", {{"primitives", {primitive}}});
  }

  std::size_t add_bending(const kds::collision::MeshScript& script, std::size_t material) {
    const Surface surface = surface_of(script);
    const auto& base = script.keyframes()[0].positions;
    json targets = json::array();
    for (std::size_t k = 1; k < script.keyframes().size(); ++k) {
      std::vector<float> moved;
      for (std::size_t v = 0; v < base.size(); ++v) append_floats(moved, script.keyframes()[k].positions[v] - base[v]);
      targets.push_back({{"POSITION", document_.floats(moved, 3, as_vertices)}});
    }
    return add_mesh(surface, material, std::move(targets));
  }

  /// Quiet blues and greens. One looks through what is fixed, which is grey, and through sensors, which are violet.
  std::size_t material(std::size_t colour) {
    const auto [known, is_new] = materials_.try_emplace(colour, 0);
    if (!is_new) return known->second;
    const double part = static_cast<double>(colour) / static_cast<double>(colours);
    json look = {{"pbrMetallicRoughness",
                  {{"baseColorFactor", {0.1 + 0.15 * part, 0.45 - 0.25 * part, 0.35 + 0.25 * part, 1}},
                   {"metallicFactor", 0},
                   {"roughnessFactor", 0.6}}},
                 {"doubleSided", true}};
    if (colour >= colours) {
      auto& rgba = look["pbrMetallicRoughness"]["baseColorFactor"];
      rgba = colour == of_fixed ? json{0.5, 0.5, 0.5, 0.3} : json{0.35, 0.15, 0.6, 0.25};
      look["alphaMode"] = "BLEND";
    }
    return known->second = document_.add("materials", std::move(look));
  }

  const Scene& scene_;
  const Record& record_;
  double rate_;
  Document document_;
  json channels_ = json::array(), samplers_ = json::array();
  std::map<std::pair<SurfaceKey, std::size_t>, std::size_t> meshes_;
  std::map<std::size_t, std::size_t> materials_;
  std::size_t body_count_ = 0;
};

}  // namespace

std::string to_gltf(const Scene& scene, const Record& record, const std::string& title, double frames_per_second) {
  if (has_compounds(scene)) return to_gltf(with_surfaces(scene), record, title, frames_per_second);
  if (has_half_spaces(scene)) return to_gltf(with_patches(scene), record, title, frames_per_second);
  if (!(frames_per_second > 0 && std::isfinite(frames_per_second))) {
    throw std::invalid_argument("glTF: frames a second: must be finite and > 0");
  }
  return Exporter(scene, record, frames_per_second).make(title);
}

}  // namespace kds::io
