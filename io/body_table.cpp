#include "io/body_table.hpp"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>

namespace kds::io {
namespace {

/// An object of the HDF5 library.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t), const char* what) : id_(id), close_(close) {
    if (id < 0) throw BodyTableError(what);
  }
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Keeps HDF5 from writing its own messages to standard error, as long as it lives.
class Silence {
 public:
  Silence() {
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Silence() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// What a column's entries are: `width` numbers of the type `Number`.
template <class Entry>
struct Layout {
  using Number = Entry;
  static constexpr hsize_t width = 1;
};
template <int Size>
struct Layout<Eigen::Matrix<double, Size, 1>> {
  using Number = double;
  static constexpr hsize_t width = Size;
};

template <class Number>
hid_t native_type() {
  if constexpr (std::is_same_v<Number, double>) return H5T_NATIVE_DOUBLE;
  if constexpr (std::is_same_v<Number, std::int64_t>) return H5T_NATIVE_INT64;
  if constexpr (std::is_same_v<Number, std::int8_t>) return H5T_NATIVE_INT8;
}

/// Integers are numbers too, and Booleans, which some programs store as an enumeration.
bool is_number(H5T_class_t kind, bool whole) {
  return kind == H5T_INTEGER || (whole ? kind == H5T_ENUM : kind == H5T_FLOAT);
}

std::string shape_text(hsize_t width, std::string_view rows) {
  std::string text = "(" + std::string(rows);
  if (width > 1) text += ", " + std::to_string(width);
  return text + ")";
}

/// Names of what the root group holds. (By calls that are the same in all versions of HDF5 from 1.8 on.)
std::vector<std::string> names_in(hid_t file) {
  const auto name_of = [file](hsize_t i, char* text, std::size_t size) {
    return H5Lget_name_by_idx(file, ".", H5_INDEX_NAME, H5_ITER_INC, i, text, size, H5P_DEFAULT);
  };
  H5G_info_t group{};
  if (H5Gget_info(file, &group) < 0) throw BodyTableError("its datasets cannot be listed");
  std::vector<std::string> names;
  for (hsize_t i = 0; i < group.nlinks; ++i) {
    const ssize_t length = name_of(i, nullptr, 0);
    if (length < 0) throw BodyTableError("its datasets cannot be listed");
    std::string& name = names.emplace_back(static_cast<std::size_t>(length), '\0');
    name_of(i, name.data(), name.size() + 1);
  }
  return names;
}

/// Rows of a table: all, or so many from the first on.
struct RowRange {
  std::size_t first = 0;
  std::optional<std::size_t> count{};
};

/// Reads rows of a column. Returns how many rows it has.
template <class Entry>
std::size_t read_column(hid_t file, const std::string& name, const RowRange& rows, std::vector<Entry>& column) {
  using Number = typename Layout<Entry>::Number;
  constexpr hsize_t width = Layout<Entry>::width;
  const auto require = [&](bool holds, const std::string& what) {
    if (!holds) throw BodyTableError(name + ": " + what);
  };
  const hid_t opened = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  require(opened >= 0, "must be a dataset");
  const Handle set(opened, H5Dclose, "");
  const Handle type(H5Dget_type(set), H5Tclose, "a dataset has no type");
  require(is_number(H5Tget_class(type), !std::is_same_v<Number, double>),
          std::is_same_v<Number, double> ? "must hold numbers" : "must hold whole numbers");
  const Handle space(H5Dget_space(set), H5Sclose, "a dataset has no shape");
  const int rank = H5Sget_simple_extent_ndims(space);
  std::array<hsize_t, 2> extent{0, 1};
  const bool fits = rank == (width == 1 ? 1 : 2) && H5Sget_simple_extent_dims(space, extent.data(), nullptr) >= 0;
  require(fits && extent[1] == width, "must have the shape " + shape_text(width, "rows"));
  // A file of a few bytes may claim any number of rows. Deflate makes bytes 1032 times fewer at most; and a column
  // whose rows were never written takes none, which is no matter where rows are few.
  constexpr double most_compressed = 2048, few_bytes = 4096;
  const double bytes = static_cast<double>(extent[0]) * static_cast<double>(width * H5Tget_size(type));
  require(bytes <= most_compressed * (few_bytes + static_cast<double>(H5Dget_storage_size(set))),
          "has fewer bytes than its rows need");
  if (rows.first > extent[0]) return extent[0];
  const std::array<hsize_t, 2> first{rows.first, 0}, count{rows.count.value_or(extent[0]), width};
  if (count[0] > extent[0] - first[0]) return extent[0];
  column.resize(count[0]);
  const Handle memory(H5Screate_simple(rank, count.data(), nullptr), H5Sclose, "out of memory");
  const bool selected = H5Sselect_hyperslab(space, H5S_SELECT_SET, first.data(), nullptr, count.data(), nullptr) >= 0;
  require(selected && H5Dread(set, native_type<Number>(), memory, space, H5P_DEFAULT, column.data()) >= 0,
          "cannot be read");
  return extent[0];
}

void write_column(hid_t file, const char* name, hsize_t rows, hsize_t width, hid_t type, const void* data) {
  const std::array<hsize_t, 2> extent{rows, width};
  const Handle space(H5Screate_simple(width == 1 ? 1 : 2, extent.data(), nullptr), H5Sclose, "out of memory");
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "out of memory");
  H5Pset_obj_track_times(properties, false);  // The bytes do not depend on when they are made.
  const Handle set(H5Dcreate2(file, name, type, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose,
                   "a dataset cannot be made");
  if (H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) throw BodyTableError("a dataset cannot be filled");
}

/// Every column that is used has as many rows as `position`.
std::string unequal_rows(const char* name, std::size_t rows, std::size_t of_position) {
  return std::string(name) + ": has " + std::to_string(rows) + " rows, and position has " + std::to_string(of_position);
}

}  // namespace

namespace {

/// Calls read(file), which is open then.
template <class Read>
void with_file(const std::filesystem::path& path, const Read& read) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw BodyTableError("cannot be read: Is a directory");
  if (!std::ifstream(path, std::ios::binary)) {
    throw BodyTableError(std::string("cannot be read: ") + std::strerror(errno));
  }
  const Silence silence;
  read(Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "is no HDF5 file, or is damaged"));
}

BodyTable read_rows(const std::filesystem::path& path, const RowRange& range) {
  BodyTable table;
  std::map<std::string, std::size_t> rows;  // of each column that there is
  with_file(path, [&](hid_t file) {
    for (const std::string& name : names_in(file)) {
      bool known = false;
      for_each_column(table, [&](const char* column, auto& values) {
        if (name != column) return;
        known = true;
        rows[name] = read_column(file, name, range, values);
      });
      if (!known) throw BodyTableError(name + ": is no column of a table of bodies");
    }
  });
  if (rows["position"] == 0) throw BodyTableError("position: is missing, or has no rows");
  for_each_column(table, [&](const char* name, const auto&) {
    const auto found = rows.find(name);
    if (found == rows.end() || found->second == 0 || found->second == rows["position"]) return;
    throw BodyTableError(unequal_rows(name, found->second, rows["position"]));
  });
  return table;
}

}  // namespace

BodyTable read_body_table(const std::filesystem::path& path) { return read_rows(path, {}); }

BodyTable read_body_table(const std::filesystem::path& path, std::size_t first, std::size_t rows) {
  return read_rows(path, {first, rows});
}

std::size_t body_table_rows(const std::filesystem::path& path) {
  std::size_t rows = 0;
  with_file(path, [&](hid_t file) {
    std::vector<Eigen::Vector3d> none;
    const std::vector<std::string> names = names_in(file);
    if (std::ranges::find(names, "position") != names.end()) rows = read_column(file, "position", {0, 0}, none);
  });
  if (rows == 0) throw BodyTableError("position: is missing, or has no rows");
  return rows;
}

std::string to_hdf5(const BodyTable& table) {
  for_each_column(table, [&](const char* name, const auto& values) {
    if (values.empty() || values.size() == table.rows()) return;
    throw std::invalid_argument(unequal_rows(name, values.size(), table.rows()));
  });
  const Silence silence;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "out of memory");
  constexpr std::size_t growth = std::size_t{64} << 20;
  constexpr hbool_t in_memory_only = 0;
  H5Pset_fapl_core(access, growth, in_memory_only);
  const Handle file(H5Fcreate("bodies", H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose, "out of memory");
  for_each_column(table, [&](const char* name, const auto& values) {
    using Entry = typename std::remove_cvref_t<decltype(values)>::value_type;
    if (values.empty()) return;
    write_column(file, name, values.size(), Layout<Entry>::width, native_type<typename Layout<Entry>::Number>(),
                 values.data());
  });
  if (H5Fflush(file, H5F_SCOPE_GLOBAL) < 0) throw BodyTableError("out of memory");
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  if (size < 0) throw BodyTableError("its bytes cannot be had");
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (H5Fget_file_image(file, bytes.data(), bytes.size()) != size) throw BodyTableError("its bytes cannot be had");
  return bytes;
}

}  // namespace kds::io
