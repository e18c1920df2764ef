// The boxes of a page's elements, as its program has them.
#pragma once

#include "collision/broad_phase/kinetic_box.hpp"
#include "tests/examples/course/course_page.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace kds::tests {

/// By ids; flat in z.
inline std::vector<collision::KineticBox<2>> boxes_of(const CoursePage& page, double t) {
  std::vector<collision::KineticBox<2>> boxes;
  for (std::size_t id = 0; id < page.size(); ++id) {
    certificates::PointMotion<2> motion;
    const auto path = page.path(id, t);
    for (std::size_t i = 0; i <= 2; ++i) motion.coefficients[i] = {path.coordinate[0].c[i], path.coordinate[1].c[i], 0};
    motion.start = path.start;
    const std::array<double, 2> half = page.element(id)["half"];
    boxes.push_back(collision::box_around<2>(motion, {-half[0], -half[1], -1}, {half[0], half[1], 1}));
  }
  return boxes;
}

}  // namespace kds::tests
