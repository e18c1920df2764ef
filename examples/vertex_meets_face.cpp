// You learn: to find when a vertex meets a face whose points each move on their own.
// How to run: build/dev/examples/vertex_meets_face
// What you see: they meet at s = 0.5 within 1e-06 of each other
#include "certificates/features/feature_contact.hpp"

#include <array>
#include <cmath>
#include <iostream>

using Points = std::array<Eigen::Vector3d, 4>;

int main() {
  // The vertex, then the corners of the face, at the beginning and at the end of a step: the vertex falls through.
  const Points begin{{{0.25, 0.25, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  const Points end{{{0.25, 0.25, -1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};

  const auto contact = kds::certificates::vertex_face_contact(begin, end);
  if (!contact) return std::cout << "they do not meet\n", 0;
  // The time is never late: at it the two are within `distance` of each other.
  std::cout << "they meet at s = " << std::round(contact.time * 1e5) / 1e5 << " within "
            << std::ceil(contact.distance * 1e6) / 1e6 << " of each other\n";
}
