#include "kds/roots/gsl_roots.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_poly.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds {
namespace {

/// The GSL's handler would abort the program where the eigenvalues do not converge.
class NoErrorHandler {
 public:
  NoErrorHandler() : previous_(gsl_set_error_handler_off()) {}
  ~NoErrorHandler() { gsl_set_error_handler(previous_); }
  NoErrorHandler(const NoErrorHandler&) = delete;
  NoErrorHandler& operator=(const NoErrorHandler&) = delete;

 private:
  gsl_error_handler_t* previous_;
};

struct FreeWorkspace {
  void operator()(gsl_poly_complex_workspace* workspace) const { gsl_poly_complex_workspace_free(workspace); }
};

/// Kept from call to call: an allocation would cost as much as a small problem.
gsl_poly_complex_workspace* workspace_for(std::size_t coefficients) {
  thread_local std::vector<std::unique_ptr<gsl_poly_complex_workspace, FreeWorkspace>> kept;
  if (kept.size() <= coefficients) kept.resize(coefficients + 1);
  auto& workspace = kept[coefficients];
  if (!workspace) workspace.reset(gsl_poly_complex_workspace_alloc(coefficients));
  if (!workspace) throw std::bad_alloc();
  return workspace.get();
}

/// Real parts of all roots. Precondition: the last coefficient is not zero. Those of pairs that are not real do no
/// harm: the sign does not change there.
std::vector<double> real_parts(std::span<const double> c) {
  std::vector<double> x(3);
  if (c.size() <= 3) {
    const double leading = c.size() == 3 ? c[2] : 0.0;
    x.resize(static_cast<std::size_t>(gsl_poly_solve_quadratic(leading, c[1], c[0], &x[0], &x[1])));
  } else if (c.size() == 4) {
    x.resize(
        static_cast<std::size_t>(gsl_poly_solve_cubic(c[2] / c[3], c[1] / c[3], c[0] / c[3], &x[0], &x[1], &x[2])));
  } else {
    const NoErrorHandler quiet;
    std::vector<double> z(2 * (c.size() - 1));
    if (gsl_poly_complex_solve(c.data(), c.size(), workspace_for(c.size()), z.data()) != GSL_SUCCESS) {
      throw std::runtime_error("gsl_first_negative: the eigenvalues of the companion matrix did not converge");
    }
    x.clear();
    for (std::size_t i = 0; i < z.size(); i += 2) x.push_back(z[i]);
  }
  return x;
}

bool division_overflows(std::span<const double> c) {
  return std::any_of(c.begin(), c.end(), [&](double x) { return !std::isfinite(x / c.back()); });
}

}  // namespace

double gsl_first_negative(std::span<const double> c, double end) {
  for (std::size_t i = 0; i < c.size(); ++i) {
    if (!std::isfinite(c[i])) {
      throw std::invalid_argument("gsl_first_negative: coefficient " + std::to_string(i) + " is not finite");
    }
  }
  // The sign just after 0 is that of the first coefficient that is not zero.
  const auto first = std::find_if(c.begin(), c.end(), [](double x) { return x != 0; });
  if (first == c.end()) return never;
  if (*first < 0) return 0 <= end ? 0 : never;
  while (c.back() == 0 || division_overflows(c)) c = c.first(c.size() - 1);
  if (c.size() < 2) return never;

  std::vector<double> roots = real_parts(c);
  std::erase_if(roots, [](double x) { return !(x > 0 && x < never); });
  std::sort(roots.begin(), roots.end());
  const auto value = [&](double x) {
    double sum = 0;
    for (std::size_t i = c.size(); i-- > 0;) sum = sum * x + c[i];
    return sum;
  };
  for (std::size_t i = 0; i < roots.size(); ++i) {
    const double beyond = i + 1 < roots.size() ? 0.5 * roots[i] + 0.5 * roots[i + 1] : 1.5 * roots[i];
    if (value(beyond) < 0) return roots[i] <= end ? roots[i] : never;
  }
  return never;
}

}  // namespace kds
