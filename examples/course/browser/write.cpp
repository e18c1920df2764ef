// In place of page_file.cpp where a program runs in its own page: that takes the data from the standard output.
#include "examples/course/page.hpp"

#include <iostream>

namespace kds::course {

void Page::write(int /*argc*/, char** /*argv*/, const std::string& /*name*/) const {
  std::cout << "page: " << json() << std::endl;
}

}  // namespace kds::course
