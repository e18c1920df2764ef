#include "io/replay.hpp"

#include "certificates/turning/turned_orientation.hpp"
#include "collision/body_motion.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "collision/shapes/shape_forms.hpp"
#include "io/pictures/compound_surface.hpp"
#include "io/pictures/half_space_patch.hpp"
#include "io/replay_page/three_script.hpp"
#include "kds/number_text.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <string_view>
#include <vector>

namespace kds::io {
namespace {

/// The viewer's page, from the files in replay_page/.
constexpr std::string_view page_template =
#include "replay_template.inc"
    ;

/// A picture needs no more than the seven digits of a float.
void append_short(std::string& text, double value) { append_number(text, static_cast<float>(value)); }

/// JSON that may stand inside a <script> element, whose end no string may spell.
std::string quoted(const std::string& name) {
  using nlohmann::json;
  std::string text = json(name).dump(-1, ' ', false, json::error_handler_t::replace);  // a file name may hold any bytes
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) text.replace(at, 1, "\\u003c");
  return text;
}

void append_list(std::string& text, std::initializer_list<double> values) {
  char separator = '[';
  for (const double value : values) {
    text += separator;
    append_short(text, value);
    separator = ',';
  }
  text += ']';
}

void append_vector(std::string& text, const Eigen::Vector3d& v) { append_list(text, {v[0], v[1], v[2]}); }

void append_mesh(std::string& text, const kds::collision::Mesh& mesh) {
  text += "{\"vertices\":[";
  for (const Eigen::Vector3d& v : mesh.vertices()) {
    for (int d = 0; d < 3; ++d) {
      append_short(text, v[d]);
      text += ',';
    }
  }
  text.back() = ']';
  text += ",\"triangles\":[";
  for (const auto& triangle : mesh.triangles()) {
    for (const std::uint32_t i : triangle) {
      append_number(text, i);
      text += ',';
    }
  }
  text.back() = ']';
  text += '}';
}

/// Coefficients without the zeros at the end: a body at rest needs one, one on a straight path two.
void append_path(std::string& text, const RecordedPiece& piece, double begin) {
  text += '[';
  append_number(text, piece.start() - begin);
  for (std::size_t i = 0; i < piece.terms(); ++i) {
    for (int d = 0; d < 3; ++d) {
      text += ',';
      append_short(text, piece.path.coefficients[i][d]);
    }
  }
  text += ']';
}

/// The angular velocity as it is: an error of it grows with time, and there may be many turns.
void append_spin(std::string& text, const RecordedPiece& piece) {
  const Eigen::Quaterniond& q = piece.orientation;
  append_list(text, {q.x(), q.y(), q.z(), q.w()});
  text.pop_back();
  for (int d = 0; d < 3; ++d) {
    text += ',';
    append_number(text, piece.angular_velocity[d]);
  }
  text += ']';
}

/// Whether any piece is turned otherwise than the body was at first.
bool turns(const std::vector<RecordedPiece>& pieces, const Eigen::Quaterniond& orientation) {
  return std::any_of(pieces.begin(), pieces.end(), [&](const RecordedPiece& piece) {
    return !piece.angular_velocity.isZero(0) || piece.orientation.coeffs() != orientation.coeffs();
  });
}

/// As a part of a body's size, how far from its place it may be drawn: bodies in a heap change their motions thousands
/// of times, most of them by less.
constexpr double drawn_within = 0x1p-10;

/// Whether a piece turns as the one before it would go on to, until then.
bool turns_on(const RecordedPiece& before, const RecordedPiece& piece, double until) {
  const Eigen::Quaterniond there =
      kds::certificates::turned_orientation(before.orientation, before.spin(), piece.start());
  const double faster = (piece.angular_velocity - before.angular_velocity).norm();
  return there.angularDistance(piece.orientation) + faster * (until - piece.start()) <= drawn_within;
}

/// Whether the piece before it would lead to the same places until then: at both ends and between them. Of parabolas,
/// which are within 5/4 of what three places show, in one place more, of curves in eleven.
bool goes_on(const RecordedPiece& before, const RecordedPiece& piece, double until, double within) {
  const int parts = std::max(before.terms(), piece.terms()) <= 3 ? 2 : 12;
  for (int k = 0; k <= parts; ++k) {
    const double time = piece.start() + (until - piece.start()) * k / parts;
    if (!((before.path.position(time) - piece.path.position(time)).norm() <= within)) return false;
  }
  return true;
}

/// The pieces that are to be drawn. Where the one before leads to the same place, until the next begins, it goes on.
std::vector<RecordedPiece> visible(const std::vector<RecordedPiece>& pieces, double size, double end) {
  std::vector<RecordedPiece> result;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const RecordedPiece& piece = pieces[i];
    const double until = i + 1 < pieces.size() ? pieces[i + 1].start() : std::max(end, piece.start());
    if (!result.empty() && goes_on(result.back(), piece, until, drawn_within * size) &&
        turns_on(result.back(), piece, until)) {
      continue;
    }
    result.push_back(piece);
  }
  return result;
}

void append_shape(std::string& text, const SceneBody& body,
                  const std::map<const kds::collision::Mesh*, std::size_t>& mesh_numbers) {
  const kds::collision::Shape& shape = body.shape;
  if (const auto mesh = body.bent ? body.bent : triangles_of(shape)) {
    append_number(text, mesh_numbers.at(mesh.get()));
  } else {
    text += '"';
    text += kind_name(shape);
    text += '"';
  }
  text += ",\"size\":";
  append_vector(text, measures(shape));
}

/// Point and normal.
void append_place(std::string& text, const Event& event) {
  for (const Eigen::Vector3d& v : {event.point, event.normal}) {
    for (int d = 0; d < 3; ++d) {
      text += ',';
      append_short(text, v[d]);
    }
  }
}

/// Where the vertices of a mesh that bends are at its keyframes.
void append_frames(std::string& text, const kds::collision::MeshScript& script, double begin) {
  text += ",\"frames\":";
  char separator = '[';
  for (const auto& keyframe : script.keyframes()) {
    text += separator;
    separator = ',';
    text += '[';
    append_number(text, keyframe.time - begin);
    for (const Eigen::Vector3d& v : keyframe.positions) {
      for (int d = 0; d < 3; ++d) {
        text += ',';
        append_short(text, v[d]);
      }
    }
    text += ']';
  }
  text += ']';
}

std::string read_script(const std::filesystem::path& folder, const char* name) {
  if (auto script = three_script(folder, name)) return *std::move(script);
  throw ReplayError("replay: three.js: " + (folder.empty() ? std::string(name) : (folder / name).string()) +
                    " is not there; install it (Debian and Ubuntu: the package libjs-three) and configure again");
}

}  // namespace

ReplayRecorder::ReplayRecorder(const Scene& scene) : scene_(scene) {
  for (std::uint32_t place = 0; place < scene.bodies.size(); ++place) {
    for (const MotionPiece& piece : scene.bodies[place].motion) on_motion(place, piece);
  }
}

void ReplayRecorder::on_motion(std::uint32_t body, const MotionPiece& piece) {
  record_.on_motion(body, kds::collision::motion_as<RecordedPiece>(piece));
}

std::size_t RecordedPiece::terms() const {
  std::size_t count = path.coefficients.size();
  while (count > 1 && path.coefficients[count - 1].isZero(0)) --count;
  return count;
}

Record::Body& Record::body(std::uint32_t place) {
  if (bodies_.size() <= place) bodies_.resize(place + std::size_t{1});
  return bodies_[place];
}

void Record::forget_after(std::uint32_t place, double time) {
  auto& pieces = body(place).motion;
  while (!pieces.empty() && pieces.back().start() > time) pieces.pop_back();
}

void Record::on_removal(std::uint32_t place, double time) { body(place).end = time; }

void Record::on_event(const Event& event) {
  if (event.is_about_volumes()) return;
  (event.kind == EventKind::wall ? walls_ : event.is_about_rest() ? rests_ : touches_).push_back(event);
}

void Record::on_motion(std::uint32_t place, const RecordedPiece& piece) {
  auto& pieces = body(place).motion;
  // Pieces of a script may come after it.
  const auto at = std::lower_bound(pieces.begin(), pieces.end(), piece.start(),
                                   [](const RecordedPiece& p, double start) { return p.start() < start; });
  // Several changes at one instant: the last one is what happens.
  if (at != pieces.end() && at->start() == piece.start()) {
    *at = piece;
  } else {
    pieces.insert(at, piece);
  }
}

std::vector<RecordedPiece> Record::drawn(const Scene& scene, std::uint32_t place) const {
  const SceneBody& body = scene.bodies[place];
  const double size = kds::collision::place(body.shape, body.orientation).bounding_radius;
  return visible(bodies_[place].motion, size, scene.end_time);
}

std::string Record::to_json(const Scene& scene, const std::string& title) const {
  if (has_compounds(scene)) return to_json(with_surfaces(scene), title);
  if (has_half_spaces(scene)) return to_json(with_patches(scene), title);
  std::string text = "{\"title\":" + quoted(title) + ",\"begin\":";
  append_number(text, scene.begin_time);
  text += ",\"duration\":";
  append_number(text, scene.end_time - scene.begin_time);
  text += ",\"response\":";
  text += scene.response == Response::elastic ? "\"elastic\"" : "\"none\"";
  if (scene.domain) {
    text += ",\"domain\":{\"min\":";
    append_vector(text, scene.domain->min);
    text += ",\"max\":";
    append_vector(text, scene.domain->max);
    text += scene.domain->reflects ? ",\"walls\":true}" : ",\"walls\":false}";
  }
  text += ",\n\"meshes\":[";
  std::map<const kds::collision::Mesh*, std::size_t> mesh_numbers;
  const auto add_mesh = [&](const kds::collision::Mesh& mesh) {
    if (!mesh_numbers.try_emplace(&mesh, mesh_numbers.size()).second) return;
    if (mesh_numbers.size() > 1) text += ",\n";
    append_mesh(text, mesh);
  };
  for (const SceneMesh& mesh : scene.meshes) add_mesh(*mesh.mesh);
  for (const SceneBody& body : scene.bodies) {
    if (const auto mesh = triangles_of(body.shape)) add_mesh(*mesh);
  }
  text += "],\n\"bodies\":[\n";
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const SceneBody& body = scene.bodies[i];
    if (i > 0) text += ",\n";
    text += "{\"name\":" + quoted(body.name) + ",\"shape\":";
    append_shape(text, body, mesh_numbers);
    if (const auto* script = script_of(body.shape)) append_frames(text, *script, scene.begin_time);
    const Eigen::Quaterniond& q = body.orientation;
    text += ",\"turn\":";
    append_list(text, {q.x(), q.y(), q.z(), q.w()});
    if (body.fixed) text += ",\"fixed\":true";
    if (body.sensor) text += ",\"sensor\":true";
    if (bodies_[i].end < scene.end_time) {
      text += ",\"until\":";
      append_number(text, bodies_[i].end - scene.begin_time);
    }
    text += ",\"motion\":[";
    const auto pieces = drawn(scene, static_cast<std::uint32_t>(i));
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      if (p > 0) text += ',';
      append_path(text, pieces[p], scene.begin_time);
    }
    text += ']';
    if (scene.turning && turns(pieces, q)) {
      text += ",\"spins\":";
      char separator = '[';
      for (const RecordedPiece& piece : pieces) {
        text += separator;
        append_spin(text, piece);
        separator = ',';
      }
      text += ']';
    }
    text += '}';
  }
  const auto append_events = [&](const std::vector<Event>& events, const auto& names_of) {
    for (std::size_t i = 0; i < events.size(); ++i) {
      text += i > 0 ? ",[" : "[";
      append_number(text, events[i].time - scene.begin_time);
      for (const std::uint32_t name : names_of(events[i])) {
        text += ',';
        append_number(text, name);
      }
      append_place(text, events[i]);
      text += ']';
    }
  };
  text += "],\n\"touches\":[";
  append_events(touches_, [](const Event& touch) {
    return std::array{static_cast<std::uint32_t>(touch.kind), touch.a, touch.b};
  });
  text += "],\n\"walls\":[";
  append_events(walls_, [](const Event& wall) { return std::array{wall.a, wall.b}; });
  text += "],\n\"rests\":[";
  for (std::size_t i = 0; i < rests_.size(); ++i) {
    const Event& rest = rests_[i];
    text += i > 0 ? ",[" : "[";
    append_number(text, rest.time - scene.begin_time);
    text += rest.kind == EventKind::rest || rest.kind == EventKind::rest_at_wall ? ",1," : ",-1,";
    append_number(text, rest.a);
    if (!rest.is_at_wall()) {
      text += ',';
      append_number(text, rest.b);
    }
    text += ']';
  }
  text += "]}";
  return text;
}

std::string replay_page(const std::string& data, const std::filesystem::path& three_folder) {
  const std::string three = read_script(three_folder, "build/three.min.js");
  const std::string controls = read_script(three_folder, "examples/js/controls/OrbitControls.js");
  const std::array<std::pair<std::string_view, const std::string*>, 3> parts{
      {{"/*{THREE}*/", &three}, {"/*{CONTROLS}*/", &controls}, {"/*{DATA}*/", &data}}};
  std::string page;
  std::string_view rest = page_template;
  for (const auto& [mark, part] : parts) {
    const std::size_t at = rest.find(mark);
    page.append(rest.substr(0, at)).append(*part);
    rest.remove_prefix(at + mark.size());
  }
  return page.append(rest);
}

std::filesystem::path default_three_folder() { return KDS_THREE_FOLDER; }

}  // namespace kds::io
