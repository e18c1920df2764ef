// Which calls a guard lets through.
#include "collision/world/guard.hpp"

#include <catch2/catch.hpp>

#include <stdexcept>
#include <string>

namespace kds::collision::test_guard {
namespace {

using Catch::Matchers::Contains;

struct Guarded {
  bool in_box_function = false;
  Guard guard{in_box_function};

  bool asks() const {
    return lets([&] { guard.require_whole("ask"); });
  }
  bool changes() const {
    return lets([&] { guard.require_changeable("change"); });
  }
  bool runs() const {
    return lets([&] { guard.require_idle("run"); });
  }

  template <class Call>
  static bool lets(const Call& call) {
    try {
      call();
    } catch (const std::logic_error&) {
      return false;
    }
    return true;
  }
};

TEST_CASE("Guard: what may be called outside steps, in steps, and in box functions") {
  Guarded of;
  CHECK((of.asks() && of.changes() && of.runs()));
  const int result = of.guard.step([&] {
    CHECK(of.guard.stepping());
    CHECK((of.asks() && of.changes() && !of.runs()));
    CHECK_THROWS_WITH(of.guard.require_idle("World::step"), "World::step: must not be called from within a callback");
    return 7;
  });
  CHECK(result == 7);
  CHECK(!of.guard.stepping());
  of.in_box_function = true;
  CHECK((of.asks() && !of.changes() && !of.runs()));
  CHECK_THROWS_WITH(of.guard.require_changeable("World::add_body"),
                    "World::add_body: a box function must not change the world");
}

TEST_CASE("Guard: an exception in a step or a change breaks it, with the first reason, until it is mended") {
  for (const bool in_change : {false, true}) {
    Guarded of;
    const auto fail = [](const char* why) { throw std::runtime_error(why); };
    const auto first = [&] { fail("first"); };
    CHECK_THROWS_AS(in_change ? of.guard.change(first) : of.guard.step(first), std::runtime_error);
    CHECK(!of.guard.whole());
    CHECK_THROWS_AS(of.guard.change([&] { fail("second"); }), std::runtime_error);
    CHECK((!of.asks() && !of.changes() && !of.runs()));
    CHECK_THROWS_WITH(of.guard.require_whole("World::size"), Contains("interrupted half-way: first"));
    of.guard.mend();
    CHECK((of.asks() && of.changes() && of.runs()));
  }
}

TEST_CASE("Guard: what a listener throws breaks nothing, but what it has caught of a change does") {
  Guarded of;
  CHECK_THROWS_AS(of.guard.step([&] { of.guard.tell([] { throw std::runtime_error("mine"); }); }), std::runtime_error);
  CHECK((of.asks() && of.changes() && of.runs()));
  const auto catches = [&] {
    try {
      of.guard.change([] { throw 1; });
    } catch (int) {
    }
  };
  CHECK_THROWS_WITH(of.guard.step([&] { of.guard.tell(catches); }), Contains("what was thrown is no std::exception"));
  CHECK(!of.asks());
}

}  // namespace
}  // namespace kds::collision::test_guard
