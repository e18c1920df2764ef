// The judge of the root benchmark: right answers must be judged right, and solvers that are wrong must be found out.
#include "tests/benchmarks/roots/contenders.hpp"
#include "tests/benchmarks/roots/families.hpp"
#include "tests/benchmarks/roots/judge.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace test_judge {
namespace {

using namespace bench_roots;

constexpr double never = std::numeric_limits<double>::infinity();
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

Verdict verdict(const Coefficients& c, double answer, double horizon = never) {
  return judge(exact_truth(c), horizon, answer).verdict;
}

const Coefficients one_two_three{6, -11, 6, -1};   // -(t - 1)(t - 2)(t - 3): falls at 1 and 3
const Coefficients touch_then_fall{2, -5, 4, -1};  // -(t - 1)^2 (t - 2)
const Coefficients negative_at_once{-2, 3, -1};    // -(t - 1)(t - 2)
const Coefficients no_root{1, 0, 1};

/// What a solver's mistakes come to over a few polynomials of every family.
template <class Solve>
Tally tally_of(Solve solve, int degree = 4) {
  Tally tally;
  kds::tests::Random random(3);
  for (const Family& family : families()) {
    for (int i = 0; i < 12; ++i) {
      const Coefficients c = family.draw(random, degree);
      const Truth truth = exact_truth(c);
      tally.add(judge(truth, never, solve(c, truth)));
    }
  }
  return tally;
}

/// The right answer, from the truth itself.
double honest(const Coefficients&, const Truth& truth) {
  const int i = truth.first_failure(never);
  if (i == -1) return never;
  return i == Truth::root_at_now ? 0 : truth.roots[static_cast<std::size_t>(i)].ceiling();
}

}  // namespace

TEST_CASE("judge: right answers are right", "[roots]") {
  CHECK(verdict(one_two_three, 1) == Verdict::right);
  CHECK(verdict(one_two_three, 1 + 1e-9) == Verdict::right);
  CHECK(verdict(one_two_three, never, 0.5) == Verdict::right);
  CHECK(verdict(one_two_three, 0.75, 0.5) == Verdict::right);  // beyond the horizon is never
  CHECK(verdict(touch_then_fall, 2) == Verdict::right);
  CHECK(verdict(negative_at_once, 0) == Verdict::right);
  CHECK(verdict(no_root, never) == Verdict::right);
}

TEST_CASE("judge: wrong answers are named", "[roots]") {
  CHECK(verdict(one_two_three, never) == Verdict::missed);
  CHECK(verdict(one_two_three, no_number) == Verdict::missed);
  CHECK(verdict(one_two_three, -1) == Verdict::missed);
  CHECK(verdict(one_two_three, 3) == Verdict::wrong_crossing);
  CHECK(verdict(one_two_three, 2) == Verdict::wrong_crossing);
  CHECK(verdict(one_two_three, 1.01) == Verdict::wrong_crossing);  // astray
  CHECK(verdict(one_two_three, 0.25, 0.5) == Verdict::phantom);
  CHECK(verdict(touch_then_fall, 1) == Verdict::wrong_crossing);
  CHECK(verdict(negative_at_once, 2) == Verdict::wrong_crossing);
  CHECK(verdict(negative_at_once, 1e-300) == Verdict::wrong_crossing);
  CHECK(verdict(negative_at_once, never) == Verdict::missed);
  CHECK(verdict(no_root, 1) == Verdict::phantom);
  CHECK(verdict(no_root, no_number) == Verdict::phantom);
  CHECK(verdict({1, -2, 1}, 1) == Verdict::phantom);  // a touch only
}

TEST_CASE("judge: errors in ulps, and whether early", "[roots]") {
  const Truth third = exact_truth(Coefficients{1, -3});
  const double below = 1.0 / 3;  // a third of a spacing before the root
  CHECK(judge(third, never, below).ulps == Approx(1.0 / 3));
  CHECK(judge(third, never, below).early);
  CHECK(judge(third, never, std::nextafter(below, 1)).ulps == Approx(2.0 / 3));
  CHECK_FALSE(judge(third, never, std::nextafter(below, 1)).early);
  CHECK(judge(third, never, below * (1 + 0x1p-40)).ulps == Approx(0x1p-40 / 3 / 0x1p-54).epsilon(1e-3));

  CHECK(judge(third, never, below, below, std::nextafter(below, 1)).enclosed);
  CHECK_FALSE(judge(third, never, below, 0.25, below).enclosed);
  CHECK_FALSE(judge(third, never, below, std::nextafter(below, 1), 0.5).enclosed);
  CHECK(judge(third, 0.25, never, never, never).enclosed);  // rightly none: nothing to enclose

  // At the last bit of the horizon.
  CHECK(judge(third, below, never).verdict == Verdict::right);
  CHECK(judge(third, below, below).verdict == Verdict::phantom);
  CHECK(judge(third, std::nextafter(below, 1), never).verdict == Verdict::missed);
}

TEST_CASE("judge: roots closer than doubles are told apart by what a double can do", "[roots]") {
  Truth truth;
  truth.sign_after_now = 1;
  // Falls just after 1, rises 1.05 spacings later: the double in between is nearer to the second root, and right.
  truth.roots = {{1, 0x1p-56, 1, -1}, {1 + 0x1p-52, 0x1p-56, -1, 1}};
  CHECK(judge(truth, never, 1 + 0x1p-52).verdict == Verdict::right);
  CHECK(judge(truth, never, 1 + 0x1p-50).verdict == Verdict::wrong_crossing);
  // A dip that no double sees may be reported or not.
  truth.roots = {{1, 0x1p-56, 1, -1}, {1, 0x1p-55, -1, 1}};
  CHECK(judge(truth, never, never).verdict == Verdict::right);
  CHECK(judge(truth, never, 1).verdict == Verdict::right);
  CHECK(judge(truth, never, 1.5).verdict == Verdict::phantom);
}

TEST_CASE("judge: an honest solver has no mistakes, wrong ones are found out", "[roots]") {
  const Tally right = tally_of(honest);
  CHECK(right.wrong() == 0);
  CHECK(right.early == 0);
  CHECK(right.ulps_max() <= 1);
  CHECK(right.crossings > 100);

  const Tally blind = tally_of([](const Coefficients&, const Truth&) { return never; });
  CHECK(blind.missed == right.crossings);
  CHECK(blind.wrong() == blind.missed);

  const Tally any_root = tally_of([](const Coefficients&, const Truth& truth) {  // takes touches and rises as well
    return truth.roots.empty() ? never : truth.roots[0].high;
  });
  CHECK(any_root.wrong_crossing > 0);
  CHECK(any_root.phantom > 0);

  const Tally last_root = tally_of([](const Coefficients& c, const Truth& truth) {
    const double first = honest(c, truth);
    return first < never && first > 0 ? truth.roots.back().high : first;
  });
  CHECK(last_root.wrong_crossing > 0);

  const Tally inaccurate =
      tally_of([](const Coefficients& c, const Truth& truth) { return honest(c, truth) * (1 - 0x1p-40); });
  CHECK(inaccurate.ulps_max() > 4000);
  CHECK(inaccurate.early > right.crossings / 2);
}

namespace {

template <int Degree>
void check_contenders_on_simple_roots(std::string& complaints) {
  // Far apart, so that everyone must be right: (1 - t) (2 + t) (3 + t)... and a polynomial without roots ahead.
  Coefficients falls{1, -1};
  Coefficients holds{1, 1};
  for (int i = 2; i <= Degree; ++i) {
    falls = product(falls, {static_cast<double>(i), 1});
    holds = product(holds, {static_cast<double>(i), 1});
  }
  kds::Polynomial<Degree> p;
  kds::Polynomial<Degree> q;
  std::copy(falls.begin(), falls.end(), p.c.begin());
  std::copy(holds.begin(), holds.end(), q.c.begin());
  for (const Entry<Degree>& entry : entries<Degree>()) {
    const auto expect = [&](bool right, const char* what) {
      if (!right) complaints += std::string(entry.name) + ", degree " + std::to_string(Degree) + ": " + what + '\n';
    };
    expect(std::abs(entry.answer(p, never) - 1) < 1e-9, "the root at 1");
    expect(std::abs(entry.answer(p, 1.5) - 1) < 1e-9, "the root at 1 before the horizon");
    expect(entry.answer(p, 0.5) == never, "the root beyond the horizon");
    expect(entry.answer(q, never) == never, "no root");
    expect(entry.answer(-q, never) == 0, "negative at once");
  }
}

template <int Degree>
void check_contenders_on_separated_roots(std::string& complaints) {
  const Family& separated = families()[1];
  kds::tests::Random random(5);
  for (const Entry<Degree>& entry : entries<Degree>()) {
    Tally tally;
    for (int i = 0; i < 40; ++i) {
      const Coefficients c = separated.draw(random, Degree);
      kds::Polynomial<Degree> p;
      std::copy(c.begin(), c.end(), p.c.begin());
      const Enclosure enclosure = entry.enclosure ? entry.enclosure(p, never) : Enclosure{0, never};
      tally.add(judge(exact_truth(c), never, entry.answer(p, never), enclosure.lower, enclosure.upper));
    }
    if (tally.wrong() + tally.unenclosed > 0 || tally.count != 40) {
      complaints += std::string(entry.name) + ", degree " + std::to_string(Degree) + ": " +
                    std::to_string(tally.wrong()) + " wrong\n";
    }
  }
}

}  // namespace

TEST_CASE("contenders: all are right where it is easy", "[roots]") {
  std::string complaints;
  [&]<int... Less>(std::integer_sequence<int, Less...>) {
    (check_contenders_on_simple_roots<Less + 1>(complaints), ...);
    (check_contenders_on_separated_roots<Less + 1>(complaints), ...);
  }
  (std::make_integer_sequence<int, greatest_degree>{});
  CHECK(complaints == "");
}

}  // namespace test_judge
