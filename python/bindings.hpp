// The parts of the extension module.
#pragma once

#include <pybind11/pybind11.h>

namespace kds_python {

void bind_shapes(pybind11::module_& module);
void bind_world(pybind11::module_& module);
void bind_periodic_world(pybind11::module_& module);
void bind_scene(pybind11::module_& module);
void bind_structures(pybind11::module_& module);

}  // namespace kds_python
