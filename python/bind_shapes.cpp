// Shapes of bodies.
#include "collision/narrow_phase/shape_distance.hpp"
#include "collision/response/mass_properties.hpp"
#include "collision/shapes/compound.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/heightfield.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "io/mesh_file.hpp"
#include "python/bindings.hpp"
#include "python/py_shape.hpp"

#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstddef>
#include <exception>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kds_python {
namespace {

namespace py = pybind11;
using namespace kds::collision;

double bounding_radius(const PyShape& of) { return place(of.shape, Eigen::Quaterniond::Identity()).bounding_radius; }

PyShape checked(Shape shape) {
  const PyShape checked{std::move(shape)};
  bounding_radius(checked);
  return checked;
}

PyShape mesh_shape(std::vector<Eigen::Vector3d> vertices, std::vector<Mesh::Triangle> triangles, double scale) {
  return checked(MeshShape{std::make_shared<const Mesh>(std::move(vertices), std::move(triangles)), scale});
}

/// Times, and for each of them as many positions, one time after the other.
PyShape bending_mesh(const std::vector<double>& times, const std::vector<Eigen::Vector3d>& positions,
                     std::vector<Mesh::Triangle> triangles) {
  return checked(BendingMesh{std::make_shared<const MeshScript>(to_keyframes(times, positions), std::move(triangles))});
}

/// Of two shapes, each with its orientation as w, x, y, z; the second one's centre is in a point.
py::tuple distance_of(const PyShape& a, const Eigen::Vector4d& turned_a, const PyShape& b,
                      const Eigen::Vector4d& turned_b, const Eigen::Vector3d& at, double t) {
  const auto placed = [](const PyShape& of, const Eigen::Vector4d& q) {
    return place(of.shape, Eigen::Quaterniond(q[0], q[1], q[2], q[3]));
  };
  const ShapeDistance found = shape_distance(placed(a, turned_a), placed(b, turned_b), at, t);
  return py::make_tuple(found.distance, found.of_a, found.of_b);
}

/// Parts, and of each: position, and orientation as w, x, y, z; and whether they are moved about their centre of mass.
PyShape compound_shape(const std::vector<PyShape>& parts, const std::vector<Eigen::Vector3d>& positions,
                       const std::vector<Eigen::Vector4d>& orientations, bool moved) {
  std::vector<CompoundPart> placed;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Eigen::Vector4d& q = orientations[i];
    placed.push_back({parts[i].shape, positions[i], Eigen::Quaterniond(q[0], q[1], q[2], q[3])});
  }
  return checked(compound(moved ? about_centre_of_mass(placed) : placed));
}

}  // namespace

void bind_shapes(py::module_& module) {
  py::class_<PyShape>(module, "Shape",
                      "The shape of bodies: made by sphere(), box(), capsule(), hull(), mesh(), heightfield(), "
                      "read_mesh(), half_space(), compound(), bending_mesh().")
      .def_property_readonly(
          "kind", [](const PyShape& of) { return kind_name(of.shape); },
          "'sphere', 'box', 'capsule', 'hull', 'mesh', 'half-space', 'compound' or 'bending mesh'.")
      .def_property_readonly("bounding_radius", &bounding_radius,
                             "The radius of the ball about the centre that contains the shape.")
      // It never changes, so copies may be itself.
      .def("__copy__", [](const py::object& self) { return self; })
      .def("__deepcopy__", [](const py::object& self, const py::dict&) { return self; })
      .def("__repr__", [](const PyShape& of) {
        std::ostringstream text;
        text << "<kds.Shape " << kind_name(of.shape) << ", bounding radius " << bounding_radius(of) << ">";
        return text.str();
      });
  module.def("sphere", [](double radius) { return checked(Sphere{radius}); });
  module.def("box", [](const Eigen::Vector3d& half_extents) { return checked(Box{half_extents}); });
  module.def("capsule", [](double radius, double half_length) { return checked(Capsule{radius, half_length}); });
  module.def("hull", [](std::vector<Eigen::Vector3d> points) { return checked(convex_hull(std::move(points))); });
  module.def("half_space", [](const Eigen::Vector3d& normal, double offset) {
    return checked(HalfSpace{normal, offset});
  });
  module.def("mesh", mesh_shape);
  module.def(
      "heightfield", [](const std::vector<double>& heights, std::size_t columns, double along_x, double along_y) {
        return checked(MeshShape{std::make_shared<const Mesh>(heightfield(heights, columns, along_x, along_y)), 1});
      });
  module.def("compound", compound_shape);
  module.def("bending_mesh", bending_mesh);
  module.def("shape_distance", distance_of);
  module.def("read_mesh", [](const std::string& file, double scale) {
    try {
      auto data = kds::io::read_mesh_file(file);
      const std::vector<std::string> mended = kds::io::mend(data);
      return py::make_tuple(mesh_shape(std::move(data.vertices), std::move(data.triangles), scale), mended);
    } catch (const std::exception& error) {  // which do not name the file
      throw std::invalid_argument(file + ": " + error.what());
    }
  });
}

}  // namespace kds_python
