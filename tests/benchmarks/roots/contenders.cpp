#include "tests/benchmarks/roots/contenders.hpp"

#include "tests/benchmarks/roots/contenders/bernstein.hpp"
#include "tests/benchmarks/roots/contenders/canonical.hpp"
#include "tests/benchmarks/roots/contenders/closed_form.hpp"
#include "tests/benchmarks/roots/contenders/companion_eigen.hpp"
#include "tests/benchmarks/roots/contenders/compensated.hpp"
#include "tests/benchmarks/roots/contenders/derivative_intervals.hpp"
#include "tests/benchmarks/roots/contenders/gsl.hpp"

#include <concepts>

namespace bench_roots {
namespace {

/// Degrees from least_degree to greatest_degree.
template <class S>
concept Contender = requires(const kds::Polynomial<S::least_degree>& p, double horizon) {
  { S::name } -> std::convertible_to<const char*>;
  { S::certified } -> std::convertible_to<bool>;
  { S::greatest_degree } -> std::convertible_to<int>;
  { S::first_negative(p, horizon) } -> std::same_as<double>;
};

template <Contender S, int Degree>
double sum_of_answers(const std::vector<kds::Polynomial<Degree>>& polynomials, const std::vector<double>& horizons) {
  double sum = 0;
  for (std::size_t i = 0; i < polynomials.size(); ++i) {
    const double t = S::first_negative(polynomials[i], horizons[i]);
    sum += t < never ? t : 1.0;
  }
  return sum;
}

template <int Degree, Contender... Solvers>
std::vector<Entry<Degree>> entries_of() {
  std::vector<Entry<Degree>> list;
  const auto add = [&]<Contender S>(S) {
    if constexpr (S::least_degree <= Degree && Degree <= S::greatest_degree) {
      list.push_back({S::name, S::certified, &S::template first_negative<Degree>, &sum_of_answers<S, Degree>, nullptr});
      if constexpr (S::certified) list.back().enclosure = &S::template enclosure<Degree>;
    }
  };
  (add(Solvers{}), ...);
  return list;
}

}  // namespace

// One line adds one.
template <int Degree>
std::vector<Entry<Degree>> entries() {
  return entries_of<Degree,
#ifdef KDS_WITH_GSL
                    Gsl,
#endif
                    CompanionEigen,       //
                    ClosedForm,           //
                    Compensated,          //
                    DerivativeIntervals,  //
                    Bernstein,            //
                    Enclosed,             //
                    Canonical>();
}

template std::vector<Entry<1>> entries();
template std::vector<Entry<2>> entries();
template std::vector<Entry<3>> entries();
template std::vector<Entry<4>> entries();
template std::vector<Entry<5>> entries();
template std::vector<Entry<6>> entries();
template std::vector<Entry<7>> entries();
template std::vector<Entry<8>> entries();

}  // namespace bench_roots
