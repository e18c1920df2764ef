// Which numbers a scene may hold. Each rule gives what is wrong with a number, or nothing.
#pragma once

#include <string>

namespace kds::io {

/// Largest magnitude of any number of a scene, and smallest of a size, mass or scale: products of four of them, with
/// room to spare for error bounds, stay normal doubles.
inline constexpr double largest_number = 1e30;
inline constexpr double smallest_size = 1e-30;

std::string number_problem(double x);                  ///< of magnitude up to largest_number
std::string positive_problem(double x);                ///< from smallest_size on
std::string length_problem(double x);                  ///< the same, or 0
std::string fraction_problem(double x);                ///< in [0, 1]
std::string friction_problem(double x);                ///< >= 0
std::string tangential_restitution_problem(double x);  ///< in [-1, 1]

}  // namespace kds::io
