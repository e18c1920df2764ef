// The extension module kds._kds, which the Python files of the package wrap: nothing in it is for users.
#include "kds/version.hpp"
#include "python/bindings.hpp"

#include <pybind11/pybind11.h>

#include <string>

PYBIND11_MODULE(_kds, module) {
  module.attr("version") = std::to_string(KDS_VERSION_MAJOR) + "." + std::to_string(KDS_VERSION_MINOR) + "." +
                           std::to_string(KDS_VERSION_PATCH);
  kds_python::bind_shapes(module);
  kds_python::bind_world(module);
  kds_python::bind_periodic_world(module);
  kds_python::bind_scene(module);
  kds_python::bind_structures(module);
}
