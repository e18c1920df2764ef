// The pages of the course, as far as no browser is needed.
#include "examples/course/page.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <stdexcept>
#include <string>

namespace test_page {

using namespace kds;
using course::Page;
using course::View;
using nlohmann::json;

TEST_CASE("a page stores motions as they are, and certificates once", "[course]") {
  Page page(View::line, "title", "about </script>", 0, 1);
  page.element(3, "ball");
  page.moves(3, Motion<2>{{{0.1, 1e-300, -1.0 / 3}}, 5}, 0);
  page.moves(3, Motion<2>{{{1, 1, 1}}, 0}, 0.5);
  page.moves(3, Motion<2>{{{2, 2, 2}}, 0}, 0.5);  // at the same instant: this one counts
  const course::Held lasting{"holds", {3}, never}, passing{"passes", {3}, 0.25};
  page.starts({.text = "first", .certificates = {lasting, passing}});
  page.event(0.25, "it has passed", {3}, {.text = "second", .marked = {3}, .certificates = {lasting}});
  page.event(0.5, "once more", {3}, {.text = "third", .certificates = {passing, lasting}});

  const json data = json::parse(page.json());
  const json& pieces = data["elements"][0]["pieces"];
  REQUIRE(pieces.size() == 2);
  CHECK(pieces[0]["y"] == json({0.1, 1e-300, -1.0 / 3}));
  CHECK(pieces[0]["start"] == 5);
  CHECK(pieces[1]["y"] == json({2, 2, 2}));
  CHECK(data["elements"][0]["label"] == "b");
  CHECK(data["states"].size() == 3);
  CHECK(data["states"][1]["marked"] == json({3}));
  const json& held = data["certificates"];
  REQUIRE(held.size() == 3);
  CHECK((held[0]["from"] == 0 && held[0]["until"] == 3 && held[0]["fails"].is_null()));
  CHECK((held[1]["from"] == 0 && held[1]["until"] == 1 && held[1]["fails"] == 0.25));
  CHECK((held[2]["from"] == 2 && held[2]["until"] == 3));
}

TEST_CASE("a page is one file whose data cannot end its script", "[course]") {
  Page page(View::plane, "t", "</script><script>alert(1)</script>", 0, 1);
  page.element(0, "a");
  page.moves(0, certificates::PlaneMotion<1>{{{{{0, 1}}, {{1, 0}}}}, 0}, 0);
  page.starts({.text = "s"});
  const std::string html = page.html();
  CHECK(html.find("alert(1)</script>") == std::string::npos);
  CHECK(html.find("/*{") == std::string::npos);     // every part has been put in
  CHECK(html.find("src=\"") == std::string::npos);  // nothing is fetched
  CHECK(html.find("http://www.w3.org/2000/svg") != std::string::npos);
  CHECK(html.find("https://") == std::string::npos);
}

TEST_CASE("a page has a small picture of its run", "[course]") {
  Page line(View::line, "t", "a", 0, 1);
  line.element(0, "a");
  line.moves(0, Motion<2>{{{7, 0, 0}}, 0}, 0);
  line.starts({.text = "s"});
  // At two fifths of the width less its margins, and in the middle of the height.
  CHECK(line.picture().find("<circle cx=\"195\" cy=\"150\"") != std::string::npos);
  CHECK(line.picture().find("d=\"M16 150L") != std::string::npos);
  CHECK(line.html().find("<link rel=\"icon\" href=\"data:image/svg+xml;base64,PHN2Zy") != std::string::npos);

  // The state is that of two fifths of the time; a unit has as many pixels across as up.
  Page plane(View::plane, "t", "a", 0, 1);
  for (const Id id : {0u, 1u, 2u}) plane.element(id, "p");
  plane.moves(0, certificates::PlaneMotion<0>{{{{{0}}, {{0}}}}, 0}, 0);
  plane.moves(1, certificates::PlaneMotion<0>{{{{{1}}, {{0}}}}, 0}, 0);
  plane.moves(2, certificates::PlaneMotion<0>{{{{{0}}, {{1}}}}, 0}, 0);
  plane.starts({.text = "s", .edges = {{0, 1}}});
  plane.event(0.3, "e", {}, {.text = "s", .outline = {0, 1, 2}, .edges = {{1, 2}}});
  plane.event(0.5, "e", {}, {.text = "s"});
  CHECK(plane.picture().find("d=\"M106 284L374 284L106 16Z\"") != std::string::npos);
  CHECK(plane.picture().find("d=\"M374 284L106 16\"") != std::string::npos);
}

TEST_CASE("a page of space has all three coordinates, one of the plane has two", "[course]") {
  const certificates::PointMotion<1> path = certificates::PointMotion<1>::line({1, 2, 3}, {4, 5, 6});
  for (const View view : {View::plane, View::space}) {
    Page page(view, "t", "a", 0, 1);
    page.element(0, "a");
    page.moves(0, path, 0);
    page.starts({.text = "s"});
    const json data = json::parse(page.json());
    const json& piece = data["elements"][0]["pieces"][0];
    CHECK(data["view"] == (view == View::space ? "space" : "plane"));
    CHECK((piece["x"] == json({1.0, 4.0}) && piece["y"] == json({2.0, 5.0})));
    CHECK(piece.contains("z") == (view == View::space));
    if (view == View::space) CHECK(piece["z"] == json({3.0, 6.0}));
    CHECK(page.html().find("/*{THREE}*/") == std::string::npos);
  }
}

TEST_CASE("a program takes the motions that its page gives it", "[course]") {
  std::string motions;
  const auto given = [&](const std::string& text) {
    motions = text;
    char program[] = "program", file[] = "page.html";
    char* arguments[] = {program, file, motions.data()};
    Page page(View::line, "t", "a", 0, 1);
    return page.motions(3, arguments, std::vector<Motion<2>>{{{{1, 2, 3}}, 4}});
  };
  Page page(View::line, "t", "a", 0, 1);
  CHECK(page.motions(1, nullptr, std::vector<Motion<2>>{{{{1, 2, 3}}, 4}}).size() == 1);
  const auto two = given(R"([{"y": [0.1, -2]}, {"start": 0.5, "y": [1e-300, 0, 7]}])");
  REQUIRE(two.size() == 2);
  CHECK((two[0].start == 0 && two[0].position.c == std::array<double, 3>{0.1, -2, 0}));
  CHECK((two[1].start == 0.5 && two[1].position.c == std::array<double, 3>{1e-300, 0, 7}));
  CHECK_THROWS_WITH(given("[]"), "Page: motions must be an array of 1 to 26");
  CHECK_THROWS_WITH(given("{}"), "Page: motions must be an array of 1 to 26");
  CHECK_THROWS_WITH(given(R"([{"y": [1]}, {"y": [1, 2, 3, 4]}])"), "Page: motion 1: y has more than 3 numbers");
  CHECK_THROWS_AS(given(R"([{"x": [1]}])"), std::exception);
  CHECK_THROWS_AS(given(R"([{"y": ["a"]}])"), std::exception);
  CHECK_THROWS_AS(given("[{"), std::exception);
}

TEST_CASE("of drawings with one title at one time the last counts", "[course]") {
  Page page(View::line, "t", "a", 0, 1);
  page.draws(0, {.title = "one"});
  page.draws(0.5, {.title = "two"});
  course::Drawing drawing{.title = "one", .places = {{.x = {1}, .y = {2}, .name = "p"}, {.element = 3}}};
  drawing.join(0);
  page.draws(0, drawing);
  CHECK_THROWS_WITH(page.draws(0.4, {.title = "two"}), "Page: a drawing of two comes before the last");
  const json drawings = json::parse(page.json())["drawings"];
  REQUIRE(drawings.size() == 2);
  CHECK(drawings[0]["places"].size() == 2);
  CHECK((drawings[0]["places"][0]["name"] == "p" && drawings[0]["places"][1]["of"] == 3));
  CHECK(drawings[0]["links"][0] == json({0, 1, nullptr}));
  CHECK((drawings[1]["title"] == "two" && drawings[1]["since"] == 0.5));
}

TEST_CASE("a page says how structures stand, with the counts of its run", "[course]") {
  Page page(View::line, "t", "a", 0, 1);
  CHECK(!json::parse(page.json()).contains("standings"));
  const Measures run{.events = 12,
                     .external = 7,
                     .followed = 3,
                     .touched = 30,
                     .most_touched = 4,
                     .held = 5,
                     .most_held = 6,
                     .most_per_element = 2};
  page.standings = {course::standing::heap(run), course::standing::sweep_and_prune(117, 21)};
  const json standings = json::parse(page.json())["standings"];
  REQUIRE(standings.size() == 2);
  CHECK(standings[0]["structure"] == "Heap");
  CHECK(standings[0]["responsive"] == "5 certificates an event at most (here at most 4)");
  CHECK(standings[0]["efficient"].get<std::string>().ends_with(" (here 7 of 15 events change the answer)"));
  CHECK(standings[0]["local"] == "3 certificates an element at most (at the end at most 2)");
  CHECK(standings[0]["compact"].get<std::string>().ends_with(" (here at most 6)"));
  CHECK(standings[1]["efficient"].get<std::string>().find("here 21 of 117 do") != std::string::npos);
}

TEST_CASE("a page refuses what it could not show", "[course]") {
  CHECK_THROWS_AS(Page(View::line, "", "", 1, 1), std::invalid_argument);
  Page page(View::line, "", "", 0, 1);
  CHECK_THROWS_AS(page.moves(7, Motion<0>{}, 0), std::out_of_range);
  CHECK_THROWS_AS(page.event(0, "", {}, {}), std::logic_error);
  page.starts({});
  CHECK_THROWS_AS(page.starts({}), std::logic_error);
  page.event(0.5, "", {}, {});
  CHECK_THROWS_AS(page.event(0.4, "", {}, {}), std::logic_error);
  page.element(0, "a");
  CHECK_THROWS_AS(page.json(), std::logic_error);  // it has no motion
}

}  // namespace test_page
