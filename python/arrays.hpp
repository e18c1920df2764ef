// NumPy arrays of what C++ has in vectors.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <vector>

namespace kds_python {

namespace py = pybind11;

// Arrays come from the Python files of the package, which have checked their shapes.
using Doubles = py::array_t<double, py::array::c_style>;

template <class Row>
py::array_t<Row> to_array(const std::vector<Row>& rows) {
  return py::array_t<Row>(static_cast<py::ssize_t>(rows.size()), rows.data());
}

}  // namespace kds_python
