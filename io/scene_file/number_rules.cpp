#include "io/scene_file/number_rules.hpp"

#include "kds/number_text.hpp"

#include <cmath>

namespace kds::io {

std::string number_problem(double x) {
  if (std::isnan(x)) return "is not a number";
  if (std::abs(x) <= largest_number) return {};
  return "must be at most " + number_text(largest_number) + " in magnitude";
}

std::string positive_problem(double x) {
  if (std::string problem = number_problem(x); !problem.empty()) return problem;
  if (!(x > 0)) return "must be > 0";
  return x >= smallest_size ? "" : "must be at least " + number_text(smallest_size);
}

std::string length_problem(double x) {
  if (std::string problem = number_problem(x); !problem.empty()) return problem;
  if (!(x >= 0)) return "must be >= 0";
  return x == 0 || x >= smallest_size ? "" : "must be 0, or at least " + number_text(smallest_size);
}

std::string fraction_problem(double x) {
  if (std::string problem = number_problem(x); !problem.empty()) return problem;
  return x >= 0 && x <= 1 ? "" : "must be in [0, 1]";
}

std::string friction_problem(double x) {
  if (std::string problem = number_problem(x); !problem.empty()) return problem;
  return x >= 0 ? "" : "must be >= 0";
}

std::string tangential_restitution_problem(double x) {
  if (std::string problem = number_problem(x); !problem.empty()) return problem;
  return x >= -1 && x <= 1 ? "" : "must be in [-1, 1]";
}

}  // namespace kds::io
