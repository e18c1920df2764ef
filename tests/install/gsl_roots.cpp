// A program of someone else's that uses kds::gsl: when does 1 - t, written about 0 s, turn negative?
#include "kds/roots/gsl_roots.hpp"
#include "kds/motion.hpp"

#include <array>
#include <iostream>

int main() {
  const std::array<double, 2> falling{1, -1};
  std::cout << "it fails at t = " << kds::gsl_first_negative(falling) << "\n";
}
