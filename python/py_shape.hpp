// Shapes as Python has them.
#pragma once

#include "collision/shapes/shape.hpp"

namespace kds_python {

/// A shape that place() has accepted. (A type of its own, since pybind11 takes a std::variant apart.)
struct PyShape {
  kds::collision::Shape shape;
};

}  // namespace kds_python
