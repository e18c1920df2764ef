// Several certificates at once, against conditions over exactly isolated roots.
#include "certificates/conjunction.hpp"
#include "tests/certificates/check_certificate.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <span>
#include <vector>

namespace test_conjunction {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::all_broken;
using certificates::first_all_broken;
using certificates::first_any_holds;

using Line = PolynomialCertificate<1>;
using OnAParabola = PolynomialCertificate<2>;

struct Problem {
  std::vector<Line> lines;
  std::vector<OnAParabola> parabolas;
  std::vector<oracle::Polynomial> polynomials;

  std::span<const Line> line_span() const { return lines; }
  std::span<const OnAParabola> parabola_span() const { return parabolas; }
};

template <int Degree>
PolynomialCertificate<Degree> random_certificate(Random& random) {
  PolynomialCertificate<Degree> f;
  const bool coarse = random.one_in(2);
  for (double& c : f.value.position.c) c = coarse ? random.integer(-2, 2) : random.between(-1, 1);
  f.value.position.c[0] += random.one_in(2) ? 0 : -1;  // broken more often than not, or all would hardly ever be
  f.value.start = coarse ? 0 : random.between(-1, 1);
  return f;
}

Problem random_problem(Random& random) {
  Problem problem;
  for (std::size_t i = random.below(3); i-- > 0;) problem.lines.push_back(random_certificate<1>(random));
  for (std::size_t i = 1 + random.below(4); i-- > 0;) problem.parabolas.push_back(random_certificate<2>(random));
  for (const auto& f : problem.lines) problem.polynomials.push_back(exact(f.value));
  for (const auto& f : problem.parabolas) problem.polynomials.push_back(exact(f.value));
  return problem;
}

oracle::Condition all_negative(const Problem& problem) {
  return {problem.polynomials, [&](const oracle::Rational& t) {
            return std::all_of(problem.polynomials.begin(), problem.polynomials.end(),
                               [&](const auto& p) { return p(t) < 0; });
          }};
}

oracle::Condition any_positive(const Problem& problem) {
  return {problem.polynomials, [&](const oracle::Rational& t) {
            return std::any_of(problem.polynomials.begin(), problem.polynomials.end(),
                               [&](const auto& p) { return p(t) > 0; });
          }};
}

}  // namespace

TEST_CASE("all are broken first where the exact stretches say so", "[conjunction]") {
  const std::uint64_t seed = 140;
  CAPTURE(seed);
  Random random(seed);
  int later = 0;
  for (int round = 0; round < 600; ++round) {
    const Problem problem = random_problem(random);
    const double now = random.integer(-6, 2) / 2.0;
    const double horizon = random.one_in(2) ? 5 : now + random.between(0, 2);
    const double expected = oracle::first_double(all_negative(problem), now, horizon);
    const double t = first_all_broken(now, horizon, problem.line_span(), problem.parabola_span());
    CAPTURE(round, now, horizon);
    REQUIRE(t == expected);
    later += t != never && t != now;
    if (t != never) CHECK(all_broken(t, problem.line_span(), problem.parabola_span()));
    if (t > now && t != never) CHECK_FALSE(all_broken(next_down(t), problem.line_span(), problem.parabola_span()));
  }
  CHECK(later > 30);
}

TEST_CASE("whether all are broken at t+ is what the signs say", "[conjunction]") {
  const std::uint64_t seed = 141;
  CAPTURE(seed);
  Random random(seed);
  int broken = 0;
  for (int round = 0; round < 600; ++round) {
    const Problem problem = random_problem(random);
    const double t = random_time(random);
    const bool expected = std::all_of(problem.polynomials.begin(), problem.polynomials.end(),
                                      [&](const auto& p) { return p.sign_after(oracle::rational(t)) < 0; });
    CAPTURE(round, t);
    CHECK(all_broken(t, problem.line_span(), problem.parabola_span()) == expected);
    broken += expected;
  }
  CHECK(broken > 30);
}

TEST_CASE("the order of the certificates does not change the answer", "[conjunction]") {
  const std::uint64_t seed = 142;
  CAPTURE(seed);
  Random random(seed);
  for (int round = 0; round < 200; ++round) {
    Problem problem = random_problem(random);
    const double t = first_all_broken(-3.0, 5.0, problem.line_span(), problem.parabola_span());
    for (int i = 0; i < 4; ++i) {
      for (std::size_t j = problem.parabolas.size(); j-- > 1;) {
        std::swap(problem.parabolas[j], problem.parabolas[random.below(j + 1)]);
      }
      std::reverse(problem.lines.begin(), problem.lines.end());
      CAPTURE(round, i);
      CHECK(first_all_broken(-3.0, 5.0, problem.parabola_span(), problem.line_span()) == t);
    }
  }
}

TEST_CASE("one holds again first where the exact stretches say so", "[conjunction]") {
  const std::uint64_t seed = 143;
  CAPTURE(seed);
  Random random(seed);
  int later = 0;
  for (int round = 0; round < 600; ++round) {
    const Problem problem = random_problem(random);
    const double now = random.integer(-6, 2) / 2.0;
    const double horizon = random.one_in(2) ? 5 : now + random.between(0, 2);
    const double expected = oracle::first_double(any_positive(problem), now, horizon);
    const double t = first_any_holds(now, horizon, problem.line_span(), problem.parabola_span());
    CAPTURE(round, now, horizon);
    REQUIRE(t == expected);
    later += t != never && t != now;
  }
  CHECK(later > 30);
}

TEST_CASE("by hand: two facts that fail in turn and never together, and two that do", "[conjunction]") {
  // Broken in (1, 2) and in (2, 3): never both.
  const std::vector<OnAParabola> in_turn{{{{{2, -3, 1}}, 0}}, {{{{6, -5, 1}}, 0}}};
  CHECK(first_all_broken(0.0, never, std::span<const OnAParabola>(in_turn)) == never);
  // Broken in (1, 3) and in (2, 4): both from 2.
  const std::vector<OnAParabola> together{{{{{3, -4, 1}}, 0}}, {{{{8, -6, 1}}, 0}}};
  CHECK(first_all_broken(0.0, never, std::span<const OnAParabola>(together)) == 2);
  CHECK(first_all_broken(0.0, 1.5, std::span<const OnAParabola>(together)) == never);
  CHECK(first_all_broken(2.5, never, std::span<const OnAParabola>(together)) == 2.5);
  CHECK(first_all_broken(3.0, never, std::span<const OnAParabola>(together)) == never);
  CHECK(first_any_holds(2.0, never, std::span<const OnAParabola>(together)) == 3);
  CHECK(first_any_holds(2.0, 2.5, std::span<const OnAParabola>(together)) == never);
}

}  // namespace test_conjunction
