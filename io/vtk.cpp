#include "io/vtk.hpp"

#include "certificates/turning/turned_orientation.hpp"
#include "collision/shapes/shape_forms.hpp"
#include "io/base64.hpp"
#include "io/pictures/body_surface.hpp"
#include "io/pictures/compound_surface.hpp"
#include "io/pictures/half_space_patch.hpp"
#include "kds/number_text.hpp"

#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

namespace kds::io {
namespace {

using Eigen::Vector3d;

constexpr double most_corners = 1e9;
constexpr std::string_view ending = ".pvd";

/// What is round is drawn with fewer triangles than in other pictures, since each frame has all of them.
constexpr Roundness coarse{12, 3};

/// Numbers as the text of an array of data: their length in bytes and they, least byte first on every machine.
template <class Number>
std::string encoded(const std::vector<Number>& numbers) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(sizeof(Number) * numbers.size() + 8);
  const auto append = [&bytes](auto bits) {
    for (std::size_t k = 0; k < sizeof bits; ++k) bytes.push_back(static_cast<std::uint8_t>(bits >> (8 * k)));
  };
  append(std::uint64_t{sizeof(Number) * numbers.size()});
  for (const Number number : numbers) {
    if constexpr (sizeof(Number) == 8) {
      append(std::bit_cast<std::uint64_t>(number));
    } else {
      append(std::bit_cast<std::uint32_t>(number));
    }
  }
  return base64(bytes);
}

template <class Number>
void append_array(std::string& text, const char* name, const std::vector<Number>& numbers, int components = 1) {
  const char* const type = std::is_same_v<Number, float>    ? "Float32"
                           : std::is_same_v<Number, double> ? "Float64"
                                                            : "Int32";
  for (const char* const part : {"<DataArray type=\"", type, "\" Name=\"", name, "\""}) text += part;
  if (components > 1) text += " NumberOfComponents=\"" + std::to_string(components) + "\"";
  text += " format=\"binary\">" + encoded(numbers) + "</DataArray>\n";
}

std::string file_of(const char* type, const std::string& content) {
  return std::string("<?xml version=\"1.0\"?>\n<VTKFile type=\"") + type +
         "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n" + content + "</VTKFile>\n";
}

Scene with_plain_shapes(const Scene& scene) {
  if (has_compounds(scene)) return with_plain_shapes(with_surfaces(scene));
  return has_half_spaces(scene) ? with_patches(scene) : scene;
}

/// As the value of an attribute.
std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    const char* const name = c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : nullptr;
    name ? safe += name : safe += c;
  }
  return safe;
}

std::string frame_name(std::size_t i) { return "frame_" + std::to_string(i) + ".vtp"; }

bool is_frame(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  const std::string_view start = "frame_", end = ".vtp";
  if (!name.starts_with(start) || !name.ends_with(end)) return false;
  const std::string number = name.substr(start.size(), name.size() - start.size() - end.size());
  return !number.empty() && number.find_first_not_of("0123456789") == std::string::npos;
}

[[noreturn]] void fail(const std::filesystem::path& folder, const std::string& why, bool when_opening = false) {
  throw OutputError(folder.string() + ": folder: " + why, when_opening);
}

}  // namespace

struct VtkFrames::Body {
  std::shared_ptr<const Surface> surface;
  Vector3d scale;
  std::vector<RecordedPiece> pieces;  ///< starts ascend
  double end;                         ///< s
};

VtkFrames::VtkFrames(const Scene& scene, const Record& record) : scene_(with_plain_shapes(scene)) {
  std::map<SurfaceKey, std::shared_ptr<const Surface>> known;
  for (std::uint32_t place = 0; place < scene_.bodies.size(); ++place) {
    const auto& shape = scene_.bodies[place].shape;
    const auto* const script = script_of(shape);
    Body body{nullptr, surface_scale(shape), record.drawn(scene_, place), record.end(place)};
    if (script) {
      body.surface = std::make_shared<const Surface>(surface_of(*script));
    } else {
      auto& surface = known[surface_key(shape)];
      if (!surface) surface = std::make_shared<const Surface>(surface_of(shape, coarse));
      body.surface = surface;
    }
    bodies_.push_back(std::move(body));
  }
}

VtkFrames::~VtkFrames() = default;

std::size_t VtkFrames::corners() const {
  std::size_t sum = 0;
  for (const Body& body : bodies_) sum += body.surface->triangles.size();
  return sum;
}

std::string VtkFrames::at(double t) const {
  std::vector<float> places, velocities;
  std::vector<std::int32_t> corners, ends, of_body, of_sensor;
  for (std::size_t place = 0; place < bodies_.size(); ++place) {
    const Body& body = bodies_[place];
    const auto after = std::upper_bound(body.pieces.begin(), body.pieces.end(), t,
                                        [](double time, const RecordedPiece& piece) { return time < piece.start(); });
    if (after == body.pieces.begin() || t >= body.end) continue;
    const RecordedPiece& piece = *(after - 1);
    const Eigen::Quaterniond q =
        scene_.turning ? kds::certificates::turned_orientation(piece.orientation, piece.spin(), t).normalized()
                       : scene_.bodies[place].orientation;
    const Eigen::Matrix3d rotation = q.toRotationMatrix();
    const Vector3d centre = piece.path.position(t), velocity = piece.path.velocity(t);
    const Surface& surface = *body.surface;
    const auto* const script = script_of(scene_.bodies[place].shape);
    const auto first = static_cast<std::int32_t>(places.size() / 3);
    for (std::size_t v = 0; 3 * v < surface.places.size(); ++v) {
      const float* const unit = &surface.places[3 * v];
      const Vector3d own = script ? script->position(v, t) : Vector3d(unit[0], unit[1], unit[2]);
      append_floats(places, centre + rotation * own.cwiseProduct(body.scale));
    }
    for (const std::uint32_t corner : surface.triangles) corners.push_back(first + static_cast<std::int32_t>(corner));
    for (std::size_t i = 0; i < surface.triangles.size() / 3; ++i) {
      ends.push_back(static_cast<std::int32_t>(3 * (ends.size() + 1)));
      of_body.push_back(static_cast<std::int32_t>(place));
      of_sensor.push_back(scene_.bodies[place].sensor ? 1 : 0);
      append_floats(velocities, velocity);
    }
  }
  std::string text = "<PolyData>\n<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\"";
  text += " format=\"binary\">" + encoded(std::vector<double>{t}) + "</DataArray>\n</FieldData>\n";
  text += "<Piece NumberOfPoints=\"" + std::to_string(places.size() / 3) + "\" NumberOfVerts=\"0\" NumberOfLines=\"0\"";
  text += " NumberOfStrips=\"0\" NumberOfPolys=\"" + std::to_string(ends.size()) + "\">\n<Points>\n";
  append_array(text, "Points", places, 3);
  text += "</Points>\n<Polys>\n";
  append_array(text, "connectivity", corners);
  append_array(text, "offsets", ends);
  text += "</Polys>\n<CellData Scalars=\"body\" Vectors=\"velocity\">\n";
  append_array(text, "body", of_body);
  append_array(text, "sensor", of_sensor);
  append_array(text, "velocity", velocities, 3);
  text += "</CellData>\n</Piece>\n</PolyData>\n";
  return file_of("PolyData", text);
}

bool is_series_name(const std::string& path) { return path.ends_with(ending) && path.size() > ending.size(); }

std::filesystem::path frames_folder(const std::string& path) {
  return std::filesystem::path(path).replace_extension(".frames");
}

VtkSeries::VtkSeries(const std::string& path)
    : path_(is_series_name(path) ? path
                                 : throw std::invalid_argument(path + ": file: the name of a VTK series ends in .pvd")),
      folder_(frames_folder(path)),
      temporary_(folder_.string() + ".part-" + std::to_string(getpid())),
      list_(path) {
  std::error_code error;
  if (!std::filesystem::exists(folder_, error)) return;
  if (!std::filesystem::is_directory(folder_, error)) fail(folder_, "is a file, and frames are to be in it", true);
  for (const auto& entry : std::filesystem::directory_iterator(folder_, error)) {
    if (!is_frame(entry.path()))
      fail(folder_, "there is more in it than frames: " + entry.path().filename().string(), true);
  }
  if (error) fail(folder_, error.message(), true);
}

VtkSeries::~VtkSeries() {
  std::error_code ignored;
  std::filesystem::remove_all(temporary_, ignored);
}

void VtkSeries::write(const Scene& scene, const Record& record, double frames_per_second) {
  if (!(frames_per_second > 0 && std::isfinite(frames_per_second))) {
    throw std::invalid_argument("VTK: frames a second: must be finite and > 0");
  }
  const VtkFrames frames(scene, record);
  const double length = scene.end_time - scene.begin_time;
  const double in_all = (std::floor(length * frames_per_second) + 2) * static_cast<double>(frames.corners());
  if (!(in_all <= most_corners) || !(length * frames_per_second <= most_corners)) {
    throw std::length_error("VTK: more than a thousand million corners of triangles: ask for fewer frames a second");
  }
  std::error_code error;
  std::filesystem::create_directory(temporary_, error);
  if (error) fail(temporary_, error.message());
  std::string list = "<Collection>\n";
  std::size_t count = 0;
  const auto add = [&](double t) {
    const std::string name = frame_name(count++);
    OutputFile frame((temporary_ / name).string());
    frame.write(frames.at(t));
    frame.commit();
    list += "<DataSet timestep=\"" + number_text(t) + "\" group=\"\" part=\"0\" file=\"" +
            escaped((folder_.filename() / name).string()) + "\"/>\n";
  };
  double t = scene.begin_time;
  for (double k = 1; t < scene.end_time; ++k) {
    add(t);
    t = scene.begin_time + k / frames_per_second;
  }
  add(scene.end_time);
  list_.write(file_of("Collection", list + "</Collection>\n"));
}

void VtkSeries::close() { list_.close(); }

void VtkSeries::commit() {
  std::error_code error;
  const std::filesystem::path old = temporary_.string() + ".old";
  const bool replaces = std::filesystem::exists(folder_, error);
  if (replaces) std::filesystem::rename(folder_, old, error);
  if (!error) std::filesystem::rename(temporary_, folder_, error);
  if (error) fail(folder_, "cannot be written: " + error.message());
  list_.commit();
  if (replaces) std::filesystem::remove_all(old, error);
}

}  // namespace kds::io
