#include "io/scene_reader.hpp"

#include "certificates/turning/turned_orientation.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "io/checksum.hpp"
#include "io/scene_file/body_checks.hpp"
#include "io/scene_file/json_node.hpp"
#include "io/scene_file/material_reader.hpp"
#include "io/scene_file/mesh_reader.hpp"
#include "io/scene_file/pivot.hpp"
#include "io/scene_file/shape_reader.hpp"
#include "io/scene_file/table_reader.hpp"
#include "kds/number_text.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <variant>

namespace kds::io {
namespace {

using nlohmann::json;

/// `vertices`: keyframes of the vertices of the body's mesh, which then bends.
void read_vertices(const JsonNode& node, SceneBody& body, Response response) {
  const auto* const shape = std::get_if<kds::collision::MeshShape>(&body.shape);
  if (!shape) node.fail("is for meshes only");
  if (shape->scale != 1) node.fail("is for meshes without a scale: positions are as they are given");
  if (response == Response::elastic && !body.sensor && !body.fixed) {
    node.fail("contacts do not move a mesh that bends: \"fixed\": true for this body, or \"sensor\": true");
  }
  const std::size_t count = shape->mesh->vertices().size();
  std::vector<kds::collision::MeshScript::Keyframe> keyframes;
  for (const JsonNode& each : node.elements()) {
    each.object({"time", "positions"});
    kds::collision::MeshScript::Keyframe keyframe{each["time"].number(), {}};
    if (!keyframes.empty() && !(keyframe.time > keyframes.back().time)) {
      each["time"].fail("must be later than that of the keyframe before, " + number_text(keyframes.back().time));
    }
    const std::vector<JsonNode> positions = each["positions"].elements();
    if (positions.size() != count) {
      each["positions"].fail("has " + std::to_string(positions.size()) + " positions, and the mesh has " +
                             std::to_string(count) + " vertices");
    }
    for (const JsonNode& position : positions) keyframe.positions.push_back(position.vector());
    keyframes.push_back(std::move(keyframe));
  }
  if (keyframes.empty()) node.fail("must have at least one keyframe");
  const auto triangles = shape->mesh->triangles();
  body.bent = shape->mesh;
  body.shape = kds::collision::BendingMesh{std::make_shared<const kds::collision::MeshScript>(
      std::move(keyframes), std::vector<kds::collision::Mesh::Triangle>(triangles.begin(), triangles.end()))};
}

/// `start` and `position` of a piece.
kds::certificates::PointMotion<2> read_path(const JsonNode& node) {
  kds::certificates::PointMotion<2> path;
  path.start = node["start"].number();
  const JsonNode position = node["position"];
  const std::vector<JsonNode> coefficients = position.elements();
  if (coefficients.empty()) position.fail("must have at least one coefficient");
  if (coefficients.size() > path.coefficients.size()) {
    position.fail("has " + std::to_string(coefficients.size()) +
                  " coefficients; at most 3 (position, velocity, half the acceleration) are supported");
  }
  path.coefficients.fill(Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < coefficients.size(); ++i) path.coefficients[i] = coefficients[i].vector();
  return path;
}

/// A piece goes on with the orientation that the one before has led to, unless it has its own.
std::vector<MotionPiece> read_motion(const JsonNode& node, const Eigen::Quaterniond& orientation, Response response) {
  const std::vector<JsonNode> pieces = node.elements();
  if (pieces.empty()) node.fail("must have at least one piece");
  std::vector<MotionPiece> motion;
  for (const JsonNode& each : pieces) {
    each.object({"start", "position", "orientation", "angular_velocity", "pivot"});
    MotionPiece piece{read_path(each), orientation};
    if (!motion.empty()) {
      if (!(motion.back().start() < piece.start())) {
        each["start"].fail("must be later than the start of the piece before, " + number_text(motion.back().start()));
      }
      piece.orientation =
          kds::certificates::turned_orientation(motion.back().orientation, motion.back().spin(), piece.start());
    }
    if (each.has("orientation")) {
      if (motion.empty()) each["orientation"].fail("the first piece begins with the \"orientation\" of the body");
      piece.orientation = read_orientation(each["orientation"]);
    }
    if (each.has("angular_velocity")) piece.angular_velocity = each["angular_velocity"].vector();
    motion.push_back(piece);
  }
  if (motion.size() > 1 && response == Response::elastic) {
    pieces[1].fail("with \"response\": \"elastic\" a body has only one piece of motion");
  }
  return motion;
}

/// Whether anything is said of how the body turns.
bool speaks_of_turning(const JsonNode& node) {
  const std::vector<JsonNode> pieces = node["motion"].elements();
  const auto turns = [](const JsonNode& piece) {
    return piece.has("angular_velocity") || piece.has("orientation") || piece.has("pivot");
  };
  return node.has("inertia") || std::any_of(pieces.begin(), pieces.end(), turns);
}

SceneBody read_body(const JsonNode& node, const Scene& scene, const SurfaceNumbers& of_scene) {
  node.object({"name", "shape", "vertices", "orientation", "mass", "inertia", "fixed", "sensor", "self_contacts",
               "restitution", "friction", "tangential_restitution", "rolling_friction", "motion"});
  SceneBody body;
  body.name = node["name"].string();
  body.shape = read_shape(node["shape"], scene.meshes);
  if (node.has("orientation")) body.orientation = read_orientation(node["orientation"]);
  if (node.has("mass")) body.mass = node["mass"].positive();
  if (node.has("inertia")) {
    const auto inertia = read_inertia(node["inertia"]);
    if (const auto* moment = std::get_if<double>(&inertia)) body.inertia = *moment;
    if (const auto* tensor = std::get_if<Eigen::Matrix3d>(&inertia)) body.inertia_tensor = *tensor;
  }
  if (node.has("fixed")) body.fixed = node["fixed"].boolean();
  if (node.has("sensor")) body.sensor = node["sensor"].boolean();
  if (node.has("self_contacts")) {
    if (!node.has("vertices")) node["self_contacts"].fail("is for meshes that bend");
    body.self_contacts = node["self_contacts"].boolean();
  }
  if (node.has("vertices")) read_vertices(node["vertices"], body, scene.response);
  const SurfaceNumbers surface = read_surface(node, of_scene);
  body.restitution = surface.restitution, body.friction = surface.friction;
  body.tangential_restitution = surface.tangential_restitution, body.rolling_friction = surface.rolling_friction;
  body.motion = read_motion(node["motion"], body.orientation, scene.response);
  if (const auto pivot = read_pivot(node["motion"])) {
    const JsonNode at = node["motion"].elements().front()["pivot"];
    if (scene.response == Response::elastic && !body.fixed && !body.sensor) {
      at.fail("a body that contacts move turns about its centre of mass: make it fixed, or a sensor");
    }
    body.shape = about_pivot(body.shape, *pivot, at);
  }
  return body;
}

Domain read_domain(const JsonNode& node, const SurfaceNumbers& of_scene) {
  node.object({"min", "max", "walls", "restitution"});
  Domain domain;
  domain.min = node["min"].vector();
  domain.max = node["max"].vector();
  const std::vector<JsonNode> ends = node["max"].elements();
  for (std::size_t d = 0; d < 3; ++d) {
    const auto i = static_cast<Eigen::Index>(d);
    if (!(domain.min[i] < domain.max[i])) ends[d].fail("must be > domain.min[" + std::to_string(d) + "]");
  }
  domain.reflects = node["walls"].choice({"open", "reflect"}) == 1;
  domain.restitution = read_surface(node, of_scene).restitution;
  return domain;
}

/// Which process reads.
struct Reader {
  std::size_t rank = 0, processes = 1;
};

/// Makes a scene, whose bodies are all that are in no table, the share of a process. Returns, for each table, which of
/// its rows are in the share.
std::vector<TableRows> begin_share(const std::vector<JsonNode>& tables, const std::filesystem::path& folder,
                                   const Reader& reader, Scene& scene) {
  Share& share = scene.share;
  for (const SceneBody& body : scene.bodies) share.names.push_back(body.name);
  share.all = share.names.size();
  for (const JsonNode& table : tables) {
    share.tables.emplace_back(table["prefix"].string(), rows_of_table(table, folder));
    share.all += share.tables.back().second;
  }
  share.first = share.all * reader.rank / reader.processes;
  const std::size_t end = share.all * (reader.rank + 1) / reader.processes;
  const auto place = [&](std::size_t number) {
    return scene.bodies.begin() + static_cast<std::ptrdiff_t>(std::min(number, share.names.size()));
  };
  scene.bodies.erase(place(end), scene.bodies.end());
  scene.bodies.erase(scene.bodies.begin(), place(share.first));
  std::vector<TableRows> rows;
  std::size_t first = share.names.size();
  for (const auto& [prefix, count] : share.tables) {
    const std::size_t begin = std::clamp(share.first, first, first + count) - first;
    rows.push_back({begin, std::clamp(end, first, first + count) - first - begin});
    first += count;
  }
  return rows;
}

Scene read_document(const JsonNode& root, const SceneSource& text, const std::filesystem::path& folder,
                    std::optional<double> until, const Reader& reader) {
  root.object({"scene", "end_time", "response", "restitution", "friction", "tangential_restitution", "rolling_friction",
               "domain", "meshes", "bodies", "tables"});
  if (!root["scene"].is(1)) root["scene"].fail("must be 1, the only format there is");
  Scene scene;
  scene.sources.push_back(text);
  scene.end_time = root["end_time"].number();
  if (root.has("response")) {
    scene.response = root["response"].choice({"none", "elastic"}) == 1 ? Response::elastic : Response::none;
  }
  const SurfaceNumbers surface = read_surface(root, {});
  if (root.has("domain")) scene.domain = read_domain(root["domain"], surface);
  if (root.has("meshes")) read_meshes(root["meshes"], folder, scene);
  // With tables no others are needed.
  const bool listed = root.has("bodies") || !root.has("tables");
  const std::vector<JsonNode> bodies = listed ? root["bodies"].elements() : std::vector<JsonNode>{};
  std::map<std::string, std::string> names;
  for (const JsonNode& node : bodies) {
    scene.bodies.push_back(read_body(node, scene, surface));
    const auto [entry, is_new] = names.try_emplace(scene.bodies.back().name, node.path());
    if (!is_new) node["name"].fail('"' + entry->first + "\" is the name of " + entry->second + " too");
    scene.turning = scene.turning || speaks_of_turning(node);
  }
  const std::vector<JsonNode> named = root.has("tables") ? root["tables"].elements() : std::vector<JsonNode>{};
  const std::vector<TableRows> rows =
      reader.processes > 1 ? begin_share(named, folder, reader, scene) : std::vector<TableRows>(named.size());
  const std::size_t first_listed = std::min(scene.share.first, bodies.size()), listed_here = scene.bodies.size();
  std::vector<ReadTable> tables;
  for (std::size_t i = 0; i < named.size(); ++i) {
    tables.push_back(read_table(named[i], folder, surface, rows[i], scene));
  }
  check_names(tables, names);
  for (const SceneBody& body : scene.bodies) {  // made by pivots
    const auto mesh = mesh_of(body.shape);
    const auto is_it = [&](const SceneMesh& known) { return known.mesh == mesh; };
    if (!mesh || std::any_of(scene.meshes.begin(), scene.meshes.end(), is_it)) continue;
    scene.meshes.push_back({body.name, "", mesh});
  }
  const auto each_body = [&](const auto& check) {
    for (std::size_t i = 0; i < listed_here; ++i) {
      const std::string path = bodies[first_listed + i].path();
      check(scene.bodies[i], [&](const std::string& member) { return member.empty() ? path : path + '.' + member; });
    }
    for (const ReadTable& table : tables) {
      for (std::size_t i = 0; i < table.rows_read; ++i) {
        check(scene.bodies[table.first + i],
              [&](const std::string& member) { return table.member_path(table.first_row + i, member); });
      }
    }
  };
  if (scene.turning) {
    TurningCheck turning(scene);
    each_body([&](const SceneBody& body, const MemberPath& path) { turning.check(body, path); });
  } else {
    refuse_friction(root, bodies);
    for (const ReadTable& table : tables) {
      if (table.has_friction) throw JsonError(table.path + ".file", table.file + ": has friction: " + nothing_turns);
    }
  }

  if (!scene.bodies.empty()) scene.begin_time = scene.bodies.front().motion.front().start();
  for (const SceneBody& body : scene.bodies) scene.begin_time = std::min(scene.begin_time, body.motion.front().start());
  if (!scene.is_share() && scene.end_time < scene.begin_time) {
    root["end_time"].fail("must be >= " + number_text(scene.begin_time) + ", where the motion begins");
  }
  scene.end_time = until.value_or(scene.end_time);
  each_body([&](const SceneBody& body, const MemberPath& path) {
    check_fixed(body, path);
    check_motion(body, scene, path);
  });
  return scene;
}

Scene parse(std::string_view json_text, const std::filesystem::path& file, std::optional<double> until,
            const Reader& reader) {
  try {
    const json document = parse_json(json_text);
    const SceneSource text{"", file.string(), checksum_of(json_text)};
    Scene scene = read_document(JsonNode(document, ""), text, file.parent_path(), until, reader);
    for (std::string& warning : scene.warnings) warning.insert(0, file.string() + ": ");
    return scene;
  } catch (const JsonError& error) {
    throw SceneError(file.string(), error.where, error.what());
  }
}

std::string text_of(const std::filesystem::path& file) {
  const auto fail = [&](const std::string& why) { throw SceneError(file.string(), "file", "cannot be read: " + why); };
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) fail("Is a directory");
  std::ifstream in(file, std::ios::binary);
  if (!in) fail(std::strerror(errno));
  std::ostringstream content;
  if (in.peek() != std::ifstream::traits_type::eof()) content << in.rdbuf();
  if (in.bad() || !content) fail("read error");
  return std::move(content).str();
}

}  // namespace

Scene parse_scene(std::string_view json_text, const std::filesystem::path& file, std::optional<double> until) {
  return parse(json_text, file, until, {});
}

Scene read_scene(const std::filesystem::path& file, std::optional<double> until) {
  return parse(text_of(file), file, until, {});
}

Scene read_share(const std::filesystem::path& file, std::optional<double> until, std::size_t rank,
                 std::size_t processes) {
  return parse(text_of(file), file, until, {rank, processes});
}

void complete(Scene& share, const std::filesystem::path& file, kds::collision::Team& team) {
  if (!share.is_share()) return;
  // Each process has read files of its own machine.
  std::uint64_t own = first_chain;
  for (const SceneSource& source : share.sources) own = source.in_shares ? own : chained(own, source.checksum);
  if (!team.all(team.of_first(own) == own)) {
    throw SceneError(file.string(), "file", "is not the same, or its meshes are not, in all processes");
  }
  std::vector<std::uint64_t> sums;
  for (const SceneSource& source : share.sources) sums.push_back(source.in_shares ? source.checksum : 0);
  std::array<double, 2> greatest{share.bodies.empty() ? -kds::never : -share.begin_time,
                                 static_cast<double>(share.degree())};
  team.combine(sums, greatest);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (share.sources[i].in_shares) share.sources[i].checksum = sums[i];
  }
  share.begin_time = -greatest[0] + 0.0;
  share.share.degree = static_cast<int>(greatest[1]);
  if (share.end_time >= share.begin_time) return;
  throw SceneError(file.string(), "end_time",
                   "must be >= " + number_text(share.begin_time) + ", where the motion begins");
}

}  // namespace kds::io
