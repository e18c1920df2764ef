// A structure drawn beside the picture: places, some of them joined.
#pragma once

#include "kds/framework/moving_set.hpp"
#include "kds/motion.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace kds::course {

/// What a structure looks like from one time until it is drawn anew. A page draws each place with the value that its
/// element has at the time of the picture, and marks the link that fails next.
struct Drawing {
  enum class Kind {
    tree,   ///< places in rows; a link to a place of the same element is bold
    ruler,  ///< places in a row, each with a line to where its value stands on an axis above
    plane   ///< places that move, with one scale for both coordinates
  };
  struct Place {
    Id element = nobody;    ///< whose name, colour and value it has
    std::vector<double> x;  ///< to the right: coefficients in the time in s
    std::vector<double> y;  ///< upwards
    int side = 0;           ///< of a box, its value is that of the lower (-1) or the upper (1) end
    std::string name = {};  ///< of a place without an element, one or two letters
  };
  /// A certificate about two places; or a line between them, which never fails.
  struct Link {
    std::size_t from, to;
    double fails = never;  ///< s
  };

  std::string title;
  Kind kind = Kind::tree;
  std::vector<Place> places = {};
  std::vector<Link> links = {};
  std::vector<std::size_t> circle = {};  ///< four places: a circle goes through the first three
  int axis = 1;                          ///< whose coordinates are the values: 0 for x, 1 for y

  /// Joins a place to the last one.
  void join(std::size_t from, double fails = never) { links.push_back({from, places.size() - 1, fails}); }
};

}  // namespace kds::course
