// A value that stays on one side of a limit.
#pragma once

#include "kds/bounded.hpp"
#include "kds/certificate.hpp"
#include "kds/motion.hpp"

namespace kds::certificates {

/// side * (limit - value(t)) >= 0: the value stays below the limit (side 1) or above it (side -1). Its degree is that
/// of the value, of which perhaps only samples are known (kds/bounded.hpp).
template <class Value>
struct WithinLimit {
  static constexpr int degree = Value::degree;
  Value value;
  double limit;
  double side;  ///< 1 or -1

  bool is_negative_of(const WithinLimit& other) const {
    return side == -other.side && limit == other.limit && value == other.value;
  }

  template <class Number>
  auto polynomial(double epoch) const {
    return (about<Number>(value, epoch) - constant<Number>(limit)) * -side;
  }
};

}  // namespace kds::certificates
