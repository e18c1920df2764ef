// Two values in order, for values of any kind.
#pragma once

#include "certificates/order.hpp"
#include "kds/bounded.hpp"
#include "kds/lasting.hpp"

#include <type_traits>

namespace kds::certificates {

/// lower(t) <= upper(t), for anything that has a difference_about(): sampled values, say.
template <class Value>
struct Ascending {
  static constexpr int degree = Value::degree;
  const Value& lower;
  const Value& upper;

  Ascending(Lasting<Value> low, Lasting<Value> high) : lower(low), upper(high) {}

  bool is_negative_of(const Ascending& other) const { return &lower == &other.upper && &upper == &other.lower; }

  template <class Number>
  auto polynomial(double epoch) const {
    return difference_about<Number>(upper, lower, epoch);
  }
};

template <class Value>
Ascending(const Value&, const Value&) -> Ascending<Value>;

namespace detail {
template <class Value>
struct InOrderOf {
  using type = Ascending<Value>;
};
template <int Degree>
struct InOrderOf<Motion<Degree>> {
  using type = Order<Degree>;
};
}  // namespace detail

/// The certificate that two values are in order: Order for motions, which is quicker.
template <class Value>
using InOrder = typename detail::InOrderOf<Value>::type;

}  // namespace kds::certificates
