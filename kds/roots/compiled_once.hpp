// The functions that failure times and signs use, compiled in one place.
#pragma once

/// In namespace kds: `KDS_COMPILED_ONCE(extern template, Kind)` in a header that includes failure_time.hpp says that
/// the library has these functions for certificates of that kind, so that its includers need not compile them;
/// `KDS_COMPILED_ONCE(template, Kind)` in a .cpp file compiles them.
///
/// All are too large for a compiler to inline. Functions that it does inline (sign_after() of doubles, the quick part
/// of failure_time_after_turn()) are not among them.
#define KDS_COMPILED_ONCE(prefix, ...)                            \
  prefix double failure_time(const __VA_ARGS__&, double, double); \
  prefix double detail::failure_time_while_positive(              \
      const __VA_ARGS__&, const Polynomial<__VA_ARGS__::degree, Ball<double>>&, double, double)

/// The same for what certificates of a degree have in common.
#define KDS_COMPILED_ONCE_OF_DEGREE(prefix, degree)                                                   \
  KDS_COMPILED_ONCE(prefix, CertificateReference<degree>);                                            \
  prefix double detail::failure_time_of_formula(const CertificateReference<degree>&, double, double); \
  prefix double detail::failure_time_by_signs(const CertificateReference<degree>&, double, double);   \
  prefix int detail::extended_sign_after(const CertificateReference<degree>&, double, int);           \
  prefix int detail::exact_sign_after(const CertificateReference<degree>&, double, int)

/// The degrees that occur: those of motions, of their distances, and of four points in the plane.
#define KDS_COMPILED_ONCE_OF_ALL_DEGREES(prefix) \
  KDS_COMPILED_ONCE_OF_DEGREE(prefix, 1);        \
  KDS_COMPILED_ONCE_OF_DEGREE(prefix, 2);        \
  KDS_COMPILED_ONCE_OF_DEGREE(prefix, 3);        \
  KDS_COMPILED_ONCE_OF_DEGREE(prefix, 4);        \
  KDS_COMPILED_ONCE_OF_DEGREE(prefix, 5);        \
  KDS_COMPILED_ONCE_OF_DEGREE(prefix, 6);        \
  KDS_COMPILED_ONCE_OF_DEGREE(prefix, 8);        \
  KDS_COMPILED_ONCE_OF_DEGREE(prefix, 10);       \
  KDS_COMPILED_ONCE_OF_DEGREE(prefix, 12)
