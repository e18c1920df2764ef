// The functions that failure times and signs of one kind of certificate use, compiled in one place.
#pragma once

#include "kds/roots/failure_time.hpp"

/// In namespace kds: `KDS_COMPILED_ONCE(extern template, Kind)` in a header says that the library has these functions
/// for certificates of that kind, so that its includers need not compile them; `KDS_COMPILED_ONCE(template, Kind)` in
/// a .cpp file compiles them.
///
/// All are too large for a compiler to inline. Functions that it does inline (sign_after() of doubles, the quick part
/// of failure_time_after_turn()) are not among them.
#define KDS_COMPILED_ONCE(prefix, ...)                                                           \
  prefix double failure_time(const __VA_ARGS__&, double, double);                                \
  prefix double detail::failure_time_while_positive(                                             \
      const __VA_ARGS__&, const Polynomial<__VA_ARGS__::degree, Ball<double>>&, double, double); \
  prefix int detail::extended_sign_after(const __VA_ARGS__&, double, int)
