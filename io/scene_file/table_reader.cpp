#include "io/scene_file/table_reader.hpp"

#include "io/body_table.hpp"
#include "io/checksum.hpp"
#include "io/scene_file/body_checks.hpp"
#include "io/scene_file/shape_reader.hpp"

#include <algorithm>
#include <charconv>
#include <new>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>

namespace kds::io {
namespace {

using Eigen::Vector3d;
using kds::collision::Shape;

/// Gives entries of columns, checked; of a column that is not used, what stands for it.
class Rows {
 public:
  Rows(const BodyTable& table, const ReadTable& read) : table_(table), read_(read) {}

  [[noreturn]] void fail(std::size_t row, const char* column, const std::string& what) const {
    throw JsonError(read_.member_path(read_.first_row + row, column), what);
  }
  double number(const std::vector<double>& column, const char* name, std::size_t row, double otherwise,
                std::string (*problem)(double)) const {
    if (column.empty()) return otherwise;
    const std::string wrong = problem(column[row]);
    if (!wrong.empty()) fail(row, name, wrong);
    return column[row];
  }
  Vector3d vector(const std::vector<Vector3d>& column, const char* name, std::size_t row,
                  std::string (*problem)(double) = number_problem) const {
    if (column.empty()) return Vector3d::Zero();
    for (const double x : column[row]) {
      const std::string wrong = problem(x);
      if (!wrong.empty()) fail(row, name, wrong);
    }
    return column[row];
  }
  bool flag(const std::vector<std::int8_t>& column, const char* name, std::size_t row) const {
    if (column.empty() || column[row] == 0) return false;
    if (column[row] != 1) fail(row, name, "must be 0 or 1");
    return true;
  }
  const BodyTable& table() const { return table_; }

 private:
  const BodyTable& table_;
  const ReadTable& read_;
};

/// Which shapes the rows have: one of the scene's, by number or the same for all, or balls, or boxes.
class Shapes {
 public:
  Shapes(const JsonNode& node, const BodyTable& table, const Scene& scene) {
    const bool listed = node.has("shapes"), one = node.has("shape");
    if (one + listed + !table.radius.empty() + !table.half_extents.empty() != 1) {
      node.fail(
          "must have exactly one of \"shape\", \"shapes\", and of the columns radius and half_extents in its file");
    }
    if (one) shapes_.push_back(read_shape(node["shape"], scene.meshes));
    if (listed) {
      for (const JsonNode& each : node["shapes"].elements()) shapes_.push_back(read_shape(each, scene.meshes));
    }
    if (listed && table.shape.empty())
      node["shapes"].fail("needs a column shape in the file, which says who has which");
    if (!listed && !table.shape.empty()) node.fail("must have \"shapes\" for the column shape in its file");
  }

  Shape of(const Rows& rows, std::size_t row) const {
    const BodyTable& table = rows.table();
    if (!table.radius.empty() || !table.half_extents.empty()) {
      if (!table.scale.empty()) rows.fail(row, "scale", "is for meshes only");
      if (table.half_extents.empty()) {
        return kds::collision::Sphere{rows.number(table.radius, "radius", row, 0, positive_problem)};
      }
      return kds::collision::Box{rows.vector(table.half_extents, "half_extents", row, positive_problem)};
    }
    std::size_t which = 0;
    if (!table.shape.empty()) {
      const std::int64_t number = table.shape[row];
      if (number < 0 || static_cast<std::uint64_t>(number) >= shapes_.size()) {
        rows.fail(row, "shape",
                  "is " + std::to_string(number) + "; there are " + std::to_string(shapes_.size()) +
                      " shapes, numbered from 0");
      }
      which = static_cast<std::size_t>(number);
    }
    Shape shape = shapes_[which];
    if (table.scale.empty()) return shape;
    auto* const mesh = std::get_if<kds::collision::MeshShape>(&shape);
    if (!mesh) rows.fail(row, "scale", "is for meshes only");
    mesh->scale *= rows.number(table.scale, "scale", row, 1, positive_problem);
    const std::string problem = mesh_size_problem(*mesh, true);
    if (!problem.empty()) rows.fail(row, "scale", problem);
    return shape;
  }

 private:
  std::vector<Shape> shapes_;
};

MotionPiece piece_of(const Rows& rows, std::size_t row) {
  const BodyTable& table = rows.table();
  MotionPiece piece{};
  piece.path.start = rows.number(table.start, "start", row, 0, number_problem);
  piece.path.coefficients = {rows.vector(table.position, "position", row), rows.vector(table.velocity, "velocity", row),
                             0.5 * rows.vector(table.acceleration, "acceleration", row)};
  piece.orientation = Eigen::Quaterniond::Identity();
  if (!table.orientation.empty()) {
    const Eigen::Vector4d& q = table.orientation[row];
    piece.orientation = unit_quaternion({q[0], q[1], q[2], q[3]},
                                        [&](const std::string& what) { rows.fail(row, "orientation", what); });
  }
  piece.angular_velocity = rows.vector(table.angular_velocity, "angular_velocity", row);
  return piece;
}

/// What read(path) gives of the file that the node names.
template <class Read>
auto from_file(const JsonNode& node, const std::filesystem::path& folder, const Read& read) {
  const std::string file = node["file"].string();
  try {
    return read(folder / file);
  } catch (const BodyTableError& error) {
    node["file"].fail(file + ": " + error.what());
  } catch (const std::bad_alloc&) {
    node["file"].fail(file + ": has more than fits into memory");
  }
}

bool is_row(std::string_view digits, std::size_t rows) {
  std::size_t row = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), row);
  return error == std::errc() && row < rows && std::to_string(row) == digits;
}

/// Of so many rows: the sum of what is made of each, so that those of all rows are the sum of those of their parts.
std::uint64_t checksum_of_rows(const BodyTable& table, std::size_t first_row, std::size_t rows) {
  std::uint64_t sum = 0;
  for_each_column(table, [&](const char* name, const auto& column) {
    const std::uint64_t of_column = chained(first_chain, name);
    for (std::size_t row = 0; row < std::min(rows, column.size()); ++row) {
      const auto* const bytes = reinterpret_cast<const char*>(&column[row]);
      sum += chained(chained(of_column, first_row + row), {bytes, sizeof(column[row])});
    }
  });
  return sum;
}

}  // namespace

std::string ReadTable::member_path(std::size_t row, const std::string& member) const {
  const std::string_view of_piece = "motion[0].";  // whose members are columns
  const std::string column = member.rfind(of_piece, 0) == 0 ? member.substr(of_piece.size()) : member;
  const std::string of_row = path + ".rows[" + std::to_string(row) + "]";
  return column.empty() ? of_row : of_row + "." + column;
}

std::size_t rows_of_table(const JsonNode& node, const std::filesystem::path& folder) {
  return from_file(node, folder, [](const auto& path) { return body_table_rows(path); });
}

ReadTable read_table(const JsonNode& node, const std::filesystem::path& folder, const SurfaceNumbers& of_scene,
                     const TableRows& rows_wanted, Scene& scene) {
  node.object({"file", "prefix", "shape", "shapes"});
  ReadTable read;
  read.path = node.path();
  read.file = node["file"].string();
  read.prefix = node["prefix"].string();
  read.first = scene.bodies.size();
  BodyTable table;
  if (rows_wanted.wanted) {
    read.rows = rows_of_table(node, folder);
    read.first_row = rows_wanted.first, read.rows_read = *rows_wanted.wanted;
    // One at least, since a column without rows counts as one that is not there.
    table = from_file(node, folder, [&](const auto& path) {
      return read_body_table(path, std::min(read.first_row, read.rows - 1), std::max<std::size_t>(1, read.rows_read));
    });
  } else {
    table = from_file(node, folder, [](const auto& path) { return read_body_table(path); });
    read.rows = read.rows_read = table.rows();
  }
  read.has_friction =
      !table.friction.empty() || !table.tangential_restitution.empty() || !table.rolling_friction.empty();
  const Shapes shapes(node, table, scene);
  const Rows rows(table, read);
  scene.bodies.reserve(scene.bodies.size() + read.rows_read);
  for (std::size_t row = 0; row < read.rows_read; ++row) {
    SceneBody& body = scene.bodies.emplace_back();
    body.name = read.prefix + std::to_string(read.first_row + row);
    body.shape = shapes.of(rows, row);
    body.motion = {piece_of(rows, row)};
    body.orientation = body.motion.front().orientation;
    body.mass = rows.number(table.mass, "mass", row, 1, positive_problem);
    body.fixed = rows.flag(table.fixed, "fixed", row);
    body.sensor = rows.flag(table.sensor, "sensor", row);
    body.restitution = rows.number(table.restitution, "restitution", row, of_scene.restitution, fraction_problem);
    body.friction = rows.number(table.friction, "friction", row, of_scene.friction, friction_problem);
    body.tangential_restitution = rows.number(table.tangential_restitution, "tangential_restitution", row,
                                              of_scene.tangential_restitution, tangential_restitution_problem);
    body.rolling_friction =
        rows.number(table.rolling_friction, "rolling_friction", row, of_scene.rolling_friction, friction_problem);
  }
  scene.turning = scene.turning || !table.angular_velocity.empty();
  scene.sources.push_back(
      {node["file"].path(), read.file, checksum_of_rows(table, read.first_row, read.rows_read), true});
  return read;
}

void check_names(const std::vector<ReadTable>& tables, const std::map<std::string, std::string>& names) {
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const std::string& prefix = tables[i].prefix;
    const auto begins_so = [&](const std::string& name) { return name.rfind(prefix, 0) == 0; };
    for (auto name = names.lower_bound(prefix); name != names.end() && begins_so(name->first); ++name) {
      if (!is_row(std::string_view(name->first).substr(prefix.size()), tables[i].rows)) continue;
      throw JsonError(tables[i].path + ".prefix",
                      "gives a body the name \"" + name->first + "\", which is that of " + name->second + " too");
    }
    for (std::size_t j = 0; j < tables.size(); ++j) {
      if (i == j || !std::string_view(tables[j].prefix).starts_with(prefix)) continue;
      const std::string_view rest = std::string_view(tables[j].prefix).substr(prefix.size());
      const bool digits = std::all_of(rest.begin(), rest.end(), [](char c) { return c >= '0' && c <= '9'; });
      if (!digits) continue;
      throw JsonError(tables[std::max(i, j)].path + ".prefix",
                      "with the prefix of " + tables[std::min(i, j)].path + ", two bodies could have the same name");
    }
  }
}

}  // namespace kds::io
