// Orders by which the elements of a structure are compared.
#pragma once

#include "certificates/direction_order.hpp"
#include "certificates/in_order.hpp"
#include "kds/framework/moving_set.hpp"

#include <array>
#include <concepts>
#include <cstddef>

namespace kds::structures {

/// Makes the certificate that one element is not greater than another.
///
/// Semantic law: the certificate's function is a difference, rank(b) - rank(a), so that the order is transitive.
template <class R>
concept Ranking = requires(const R& ranking, const typename R::Element& a) {
  requires MovingElement<typename R::Element>;
  ranking.in_order(a, a);
};

/// Values by their size.
template <MovingElement Value>
struct ByValue {
  using Element = Value;
  certificates::InOrder<Value> in_order(const Value& lower, const Value& upper) const { return {lower, upper}; }
};

/// Points by how far they are in a direction. The ranking must outlive its certificates.
template <MovingElement Path, std::size_t Dimension>
struct ByDirection {
  using Element = Path;
  std::array<double, Dimension> direction{};
  certificates::DirectionOrder<Path, Dimension> in_order(const Path& lower, const Path& upper) const {
    return {lower, upper, direction};
  }
};

}  // namespace kds::structures
