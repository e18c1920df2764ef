// Kinetic structures for teaching: sorted list, convex hull, Delaunay triangulation.
#include "certificates/plane_motion.hpp"
#include "examples/course/mesh_edges.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "python/arrays.hpp"
#include "python/bindings.hpp"
#include "structures/convex_hull.hpp"
#include "structures/delaunay.hpp"
#include "structures/sorted_list.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

namespace kds_python {
namespace {

using Path = kds::certificates::PlaneMotion<2>;

/// What has changed: +1 something has come, -1 it has gone; of a hull a is b, the point.
struct ChangeRow {
  double time;
  std::int64_t change;
  std::uint32_t a;
  std::uint32_t b;
};

struct SwapRow {
  double time;
  std::uint32_t left;  ///< from now on
  std::uint32_t right;
};

/// Throws unless the clock may go from now to t.
void require_ahead(double now, double t) {
  if (std::isfinite(t) && t >= now) return;
  std::ostringstream text;
  text << "advance_to: the time must be finite and not before now, which is " << now << ", and is " << t;
  throw std::invalid_argument(text.str());
}

/// Coefficients a row: 3 numbers.
kds::Motion<2> value_motion(const double* row, double start) { return {{{row[0], row[1], row[2]}}, start}; }

/// Coefficients a row: x and y, three times.
Path plane_motion(const double* row, double start) {
  return {{{{{row[0], row[2], row[4]}}, {{row[1], row[3], row[5]}}}}, start};
}

class SortedList {
 public:
  SortedList(const Doubles& coefficients, double now) : list_(Recorder{&swaps_}), clock_(now, list_) {
    std::vector<kds::structures::SortedList<2, Recorder>::Entry> entries;
    for (py::ssize_t i = 0; i < coefficients.shape(0); ++i) {
      entries.push_back({value_motion(coefficients.data() + 3 * i, now), static_cast<std::uint32_t>(i)});
    }
    next_ = static_cast<std::uint32_t>(entries.size());
    list_.assign(entries, now);
  }

  py::array_t<SwapRow> advance_to(double t) {
    require_ahead(clock_.now(), t);
    clock_.advance_to(t);
    return to_array(std::exchange(swaps_, {}));
  }
  std::uint32_t insert(const Doubles& coefficients) {
    list_.insert(next_, value_motion(coefficients.data(), clock_.now()), clock_.now());
    return next_++;
  }
  void remove(std::uint32_t id) { list_.remove(id, clock_.now()); }
  void update(std::uint32_t id, const Doubles& coefficients) {
    list_.update(id, value_motion(coefficients.data(), clock_.now()), clock_.now());
  }
  py::array_t<std::uint32_t> order() const {
    std::vector<std::uint32_t> ids;
    for (const auto& entry : list_.entries()) ids.push_back(entry.id);
    return to_array(ids);
  }
  py::array_t<double> values() const {
    std::vector<double> values;
    for (const auto& entry : list_.entries()) values.push_back(entry.motion(clock_.now()));
    return to_array(values);
  }
  double now() const { return clock_.now(); }
  double next_time() const { return clock_.next_time(); }
  std::size_t size() const { return list_.size(); }
  void audit() const { clock_.audit(); }

 private:
  struct Recorder {
    std::vector<SwapRow>* swaps;
    void swapped(std::uint32_t left, std::uint32_t right, double t) { swaps->push_back({t, left, right}); }
    static std::uint32_t rank(std::uint32_t) { return 0; }
  };

  std::vector<SwapRow> swaps_;
  kds::structures::SortedList<2, Recorder> list_;
  kds::Simulator<kds::structures::SortedList<2, Recorder>> clock_;
  std::uint32_t next_ = 0;
};

using Edge = std::array<kds::Id, 2>;

/// What a structure is watched for: edges of a triangulation, or points of a hull, each twice.
std::vector<Edge> watched(const kds::structures::DelaunayRule<Path>& rule) {
  return kds::course::edges_of(rule.mesh());
}

std::vector<Edge> watched(const kds::structures::ConvexHullRule<Path>& rule) {
  std::vector<Edge> points;
  for (const kds::Id id : rule.hull()) points.push_back({id, id});
  std::sort(points.begin(), points.end());
  return points;
}

template <class Rule>
class PlaneStructure {
 public:
  PlaneStructure(const Doubles& paths, double now)
      : structure_((fill(paths, now), points_), now, {}, Recorder{this}), clock_(now, structure_) {
    before_ = watched(structure_.rule());
  }

  py::array_t<ChangeRow> advance_to(double t) {
    require_ahead(clock_.now(), t);
    clock_.advance_to(t);
    return to_array(std::exchange(changes_, {}));
  }
  // Edits report what they change, too, with the next advance.
  std::uint32_t insert(const Doubles& path) {
    const kds::Id id = points_.add(plane_motion(path.data(), clock_.now()), clock_.now());
    compare(clock_.now());
    return id;
  }
  void remove(std::uint32_t id) {
    points_.remove(id, clock_.now());
    compare(clock_.now());
  }
  void update(std::uint32_t id, const Doubles& path) {
    points_.update(id, plane_motion(path.data(), clock_.now()), clock_.now());
    compare(clock_.now());
  }
  py::array_t<std::uint32_t> hull() const { return to_array(structure_.rule().hull()); }
  py::array_t<std::uint32_t> triangles() const {
    const auto& mesh = structure_.rule().mesh();
    std::vector<std::uint32_t> corners;
    for (std::uint32_t t = 0; t < mesh.end_triangle(); ++t) {
      if (!mesh.in_use(t) || !mesh.finite(t)) continue;
      for (std::uint32_t i = 0; i < 3; ++i) corners.push_back(mesh.origin(3 * t + i));
    }
    return py::array_t<std::uint32_t>({static_cast<py::ssize_t>(corners.size() / 3), py::ssize_t{3}}, corners.data());
  }
  py::array_t<std::uint32_t> ids() const { return to_array(points_.ids()); }
  py::array_t<double> positions() const {
    std::vector<double> numbers;
    for (const kds::Id id : points_.ids()) {
      for (const double x : points_[id](clock_.now())) numbers.push_back(x);
    }
    return py::array_t<double>({static_cast<py::ssize_t>(numbers.size() / 2), py::ssize_t{2}}, numbers.data());
  }
  double now() const { return clock_.now(); }
  double next_time() const { return clock_.next_time(); }
  std::size_t size() const { return points_.ids().size(); }
  std::uint64_t events() const { return structure_.measures().events; }
  void audit() const { clock_.audit(); }

 private:
  struct Recorder {
    PlaneStructure* of;
    void operator()(const Rule&, const kds::KineticEvent& event) const {
      if (event.effect == kds::Effect::external) of->compare(event.time);
    }
  };

  void fill(const Doubles& paths, double now) {
    for (py::ssize_t i = 0; i < paths.shape(0); ++i) points_.add(plane_motion(paths.data() + 6 * i, now), now);
  }

  void compare(double time) {
    std::vector<Edge> after = watched(structure_.rule());
    const auto note = [&](const std::vector<Edge>& from, const std::vector<Edge>& without, std::int64_t change) {
      std::vector<Edge> rest;
      std::set_difference(from.begin(), from.end(), without.begin(), without.end(), std::back_inserter(rest));
      for (const auto& [a, b] : rest) changes_.push_back({time, change, a, b});
    };
    note(before_, after, -1);
    note(after, before_, +1);
    before_ = std::move(after);
  }

  kds::MovingSet<Path> points_;
  std::vector<Edge> before_;
  std::vector<ChangeRow> changes_;
  kds::Kinetic<Rule, Recorder> structure_;
  kds::Simulator<kds::Kinetic<Rule, Recorder>> clock_;
};

template <class Structure>
py::class_<Structure> bind_structure(py::module_& module, const char* name) {
  py::class_<Structure> bound(module, name);
  bound.def(py::init<const Doubles&, double>())
      .def("advance_to", &Structure::advance_to)
      .def("insert", &Structure::insert)
      .def("remove", &Structure::remove)
      .def("update", &Structure::update)
      .def("now", &Structure::now)
      .def("next_time", &Structure::next_time)
      .def("size", &Structure::size)
      .def("audit", &Structure::audit);
  return bound;
}

template <class Rule>
void bind_plane(py::module_& module, const char* name) {
  using Structure = PlaneStructure<Rule>;
  bind_structure<Structure>(module, name)
      .def("hull", &Structure::hull)
      .def("triangles", &Structure::triangles)
      .def("ids", &Structure::ids)
      .def("positions", &Structure::positions)
      .def("events", &Structure::events);
}

}  // namespace

void bind_structures(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(SwapRow, time, left, right);
  PYBIND11_NUMPY_DTYPE(ChangeRow, time, change, a, b);
  bind_structure<SortedList>(module, "SortedList").def("order", &SortedList::order).def("values", &SortedList::values);
  bind_plane<kds::structures::ConvexHullRule<Path>>(module, "ConvexHull");
  bind_plane<kds::structures::DelaunayRule<Path>>(module, "Delaunay");
}

}  // namespace kds_python
