// What must be known at a time, computed from the motions alone by runs of their own.
#pragma once

#include "tests/examples/course/course_page.hpp"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kds::tests {

/// What a picture is to show at t. What is not expected is not compared.
struct Expected {
  std::optional<std::vector<Id>> order, outline, marked;  ///< marked: ascending
  std::optional<std::vector<std::pair<Id, Id>>> edges;    ///< ascending
  std::optional<double> fails;                            ///< the failure time of the next certificate, or never
  std::vector<std::array<double, 3>> positions;           ///< of a run; if empty those of the page's motions
  std::string text;                                       ///< that the state's text begins with
};

/// By the name of the program.
const std::map<std::string, std::function<Expected(const CoursePage&, double t)>>& expectations();

}  // namespace kds::tests
