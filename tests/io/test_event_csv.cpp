#include "io/event_csv.hpp"
#include "kds/number_text.hpp"
#include "tests/io/temporary_folder.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <bit>
#include <charconv>
#include <cmath>
#include <random>
#include <string>

namespace test_event_csv {

using namespace kds::io;
using kds::collision::Feature;
using kds::io::tests::read_file;
using kds::io::tests::TemporaryFolder;

namespace {

Scene two_bodies() {
  Scene scene;
  scene.bodies.resize(2);
  scene.bodies[0].name = "plain name";
  scene.bodies[1].name = "a \"b\", c";
  return scene;
}

std::string line_of(const Event& event) {
  std::string text;
  append_csv_line(text, event, two_bodies());
  return text;
}

}  // namespace

TEST_CASE("event csv: the line of each kind of event") {
  const Eigen::Vector3d p(0.1, -0.0, 1e-7);
  const Eigen::Vector3d n(0, 0, -1);
  CHECK(line_of({0.25, EventKind::contact, 0, 1, p, n, Feature::vertex(12), Feature::edge(17, 3)}) ==
        "0.25,contact,plain name,\"a \"\"b\"\", c\",0.1,0,1e-07,0,0,-1,v12,e3-17\n");
  CHECK(line_of({1e9, EventKind::separation, 0, 1, p, n, Feature::face(40), {}}) ==
        "1e+09,separation,plain name,\"a \"\"b\"\", c\",0.1,0,1e-07,0,0,-1,f40,-\n");
  CHECK(line_of({0, EventKind::overlap, 0, 1, p, n, {}, {}}) ==
        "0,overlap,plain name,\"a \"\"b\"\", c\",0.1,0,1e-07,0,0,-1,-,-\n");
  CHECK(line_of({2, EventKind::wall, 0, 4, p, n, {}, {}}) == "2,wall,plain name,-z,0.1,0,1e-07,0,0,-1,-,-\n");
  CHECK(line_of({2, EventKind::rest, 0, 1, p, n, {}, {}}).starts_with("2,rest,plain name,"));
  CHECK(line_of({2, EventKind::wake_at_wall, 0, 4, p, n, {}, {}}) == "2,wake,plain name,-z,0.1,0,1e-07,0,0,-1,-,-\n");
  CHECK(line_of({2, EventKind::pass, 0, 1, p, n, {}, {}}).starts_with("2,pass,plain name,"));
  CHECK(line_of({3, EventKind::pair_begin, 0, 1, {}, {}, {}, {}}) ==
        "3,pair_begin,plain name,\"a \"\"b\"\", c\",,,,,,,-,-\n");
  CHECK(line_of({3, EventKind::pair_end, 0, 1, {}, {}, {}, {}}) ==
        "3,pair_end,plain name,\"a \"\"b\"\", c\",,,,,,,-,-\n");
}

TEST_CASE("event csv: every number reads back to the same double") {
  std::mt19937_64 random(11);
  for (int i = 0; i < 10'000; ++i) {
    const auto x = std::bit_cast<double>(random());
    if (!std::isfinite(x)) continue;
    std::string text;
    kds::append_number(text, x);
    double again = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), again);
    REQUIRE(error == std::errc());
    REQUIRE(end == text.data() + text.size());
    REQUIRE(std::bit_cast<std::uint64_t>(again) == std::bit_cast<std::uint64_t>(x));
  }
}

TEST_CASE("event csv: a file appears when it is complete") {
  const TemporaryFolder folder;
  const Scene scene = two_bodies();
  const std::filesystem::path file = folder / "events.csv";
  {
    EventCsv csv(file.string(), scene);
    for (int i = 0; i < 5000; ++i) csv.on_event({i * 0.5, EventKind::wall, 0, 1, {0, 0, 0}, {1, 0, 0}, {}, {}});
    CHECK_FALSE(std::filesystem::exists(file));
    csv.commit();
  }
  const std::string text = read_file(file);
  CHECK(text.starts_with("time,kind,a,b,px,py,pz,nx,ny,nz,feature_a,feature_b\n0,wall,plain name,+x,"));
  CHECK(std::count(text.begin(), text.end(), '\n') == 5001);
  CHECK(folder.file_count() == 1);
}

TEST_CASE("checksum: it does not depend on how the bytes come, and notices every change of a byte, and of the length") {
  kds::tests::Random random(3);
  std::string bytes;
  for (int i = 0; i < 60; ++i) bytes += static_cast<char>(random.below(256));
  const auto of = [](const std::string& text) {
    Checksum sum;
    sum.add(text);
    return sum.value();
  };
  for (int trial = 0; trial < 300; ++trial) {
    Checksum sum;
    for (std::size_t at = 0; at < bytes.size();) {
      const std::size_t count = random.below(1 + (trial % 2 == 0 ? 9 : bytes.size() - at));
      sum.add(std::string_view(bytes).substr(at, count));
      at += std::min(count, bytes.size() - at);
      CHECK(sum.value() == of(bytes.substr(0, at)));
    }
  }
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string other = bytes;
    other[i] = static_cast<char>(other[i] ^ 1 << random.below(8));
    CHECK(of(other) != of(bytes));
    CHECK(of(bytes.substr(0, i)) != of(bytes.substr(0, i) + '\0'));
  }
}

}  // namespace test_event_csv
