// Whether the structures that a page draws are those of its motions, by their geometry.
#pragma once

#include "tests/examples/course/course_page.hpp"

#include <string>
#include <vector>

namespace kds::tests {

/// What is wrong, in words, with the drawings of a page's program in what the driver saw at one time. Nothing of it is
/// compared with what the program recorded.
std::vector<std::string> wrong_in_drawings(const CoursePage& page, const std::string& program, const json& frame);

}  // namespace kds::tests
