#include "tests/examples/command_line.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <string>

namespace test_command_line {

using kds::io::tests::head_on;
using kds::io::tests::kds_collide_in;
using kds::io::tests::lines_of;
using kds::io::tests::Outcome;
using kds::io::tests::read_file;
using kds::io::tests::TemporaryFolder;

TEST_CASE("command line: a scene in, events out") {
  const TemporaryFolder folder;
  folder.write("scene.json", head_on);
  const Outcome outcome = kds_collide_in(folder, "scene.json --events - --quiet");
  CHECK(outcome.code == 0);
  CHECK(outcome.err.empty());
  CHECK(outcome.out ==
        "time,kind,a,b,px,py,pz,nx,ny,nz,feature_a,feature_b\n"
        "1,contact,a,b,2,0,0,1,0,0,-,-\n"
        "3,separation,a,b,2,0,0,-1,0,0,-,-\n");
}

TEST_CASE("command line: the scenes of the documentation have the events of the documentation") {
  const auto [scene, events] =
      GENERATE(table<std::string, std::string>({{"scene.json", "events.csv"}, {"turning.json", "turning.csv"}}));
  const TemporaryFolder folder;
  const std::filesystem::path example = KDS_COLLIDE_EXAMPLE;
  const Outcome outcome = kds_collide_in(folder, "'" + (example / scene).string() + "' --events - --quiet");
  CHECK(outcome.code == 0);
  CHECK(outcome.err.empty());
  CHECK(outcome.out == read_file(example / events));
}

TEST_CASE("command line: --until, --stats and the summary") {
  const TemporaryFolder folder;
  folder.write("scene.json", head_on);
  const Outcome outcome = kds_collide_in(folder, "scene.json --events e.csv --stats s.json --until 2 --rate 10");
  CHECK(outcome.code == 0);
  CHECK(outcome.out.empty());
  CHECK_THAT(outcome.err, Catch::Contains("2 bodies, 2 s simulated: 1 contacts"));
  CHECK(lines_of(read_file(folder / "e.csv")).size() == 2);
  const auto stats = nlohmann::json::parse(read_file(folder / "s.json"));
  for (const char* key : {"cpu_seconds", "setup_cpu_seconds", "run_cpu_seconds", "sim_seconds", "bodies", "swaps",
                          "contacts", "pair_tests", "motion_updates", "peak_memory_bytes"}) {
    INFO(key);
    CHECK(stats.at(key).is_number());
  }
  CHECK(stats["sim_seconds"] == 2);
  CHECK(stats["contacts"] == 1);
  CHECK(stats["broad_phase"] == "few-boxes");  // what auto is with two bodies
  CHECK(stats["peak_memory_bytes"] > 100'000);
}

TEST_CASE("command line: a ball that bounces ever lower comes to rest, which the statistics and the summary tell") {
  const TemporaryFolder folder;
  folder.write("scene.json", R"({"scene": 1, "end_time": 100, "response": "elastic", "restitution": 0.5, "bodies": [
    {"name": "floor", "fixed": true, "shape": {"box": {"half_extents": [9,9,1]}},
     "motion": [{"start": 0, "position": [[0,0,-1]]}]},
    {"name": "ball", "shape": {"sphere": {"radius": 1}},
     "motion": [{"start": 0, "position": [[0,0,4], [0,0,0], [0,0,-5]]}]}]})");
  const Outcome outcome = kds_collide_in(folder, "scene.json --events e.csv --stats s.json");
  CHECK(outcome.code == 0);
  CHECK_THAT(outcome.err, Catch::Contains("1 contacts came to last"));
  const auto stats = nlohmann::json::parse(read_file(folder / "s.json"));
  CHECK(stats["held"] == 1);
  const auto events = lines_of(read_file(folder / "e.csv"));
  CHECK(events.size() == stats["contacts"].get<std::size_t>() + 2);
  CHECK(events.size() < 100);
  CHECK_THAT(events.back(), Catch::Contains(",rest,floor,ball,"));
  // Flights that shrink by a half: at rest three times as late as it first lands.
  CHECK(std::stod(events.back()) == Approx(3 * std::stod(events[1])).epsilon(1e-6));
}

TEST_CASE("command line: all broad phases write the same events of generated scenes") {
  const TemporaryFolder folder;
  const auto kind = std::string(GENERATE(as<std::string>(), "rings", "spheres", "boxes", "models", "spinners",
                                         "spinning-rings", "rods", "plates", "capsules"));
  INFO(kind);
  const std::string size = kind == "models" ? " --bodies 12 --density 0.1" : " --bodies 60 --density 0.2";
  REQUIRE(kds_collide_in(folder, "--generate " + kind + size + " --seed 5").code == 0);
  const auto events = [&](const std::string& options) {
    const Outcome outcome = kds_collide_in(folder, kind + ".json --quiet --events - " + options);
    CHECK(outcome.code == 0);
    CHECK(outcome.err.empty());
    return outcome.out;
  };
  for (const std::string pairs : {"", " --pairs"}) {
    const std::string expected = events(pairs);
    CHECK(lines_of(expected).size() > 2);
    const bool grid = events("--broad-phase grid" + pairs) == expected;
    const bool kinetic_sap = events("--broad-phase kinetic-sap --rate 60" + pairs) == expected;
    const bool sap = events("--broad-phase sap --rate 60" + pairs) == expected;
    const bool sap_often = events("--broad-phase sap --rate 1000" + pairs) == expected;
    const bool all_pairs = events("--broad-phase all-pairs" + pairs) == expected;
    CHECK(grid);
    CHECK(kinetic_sap);
    CHECK(sap);
    CHECK(sap_often);
    CHECK(all_pairs);
  }
  // K-DOPs begin and cease to overlap at other times than boxes.
  CHECK(events("--broad-phase kinetic-sap --kdop 26 --rate 60") == events(""));
}

TEST_CASE("command line: scenes that are divided have the same events and the same numbers of them") {
  const TemporaryFolder folder;
  const auto kind = std::string(GENERATE(as<std::string>(), "rings", "spheres", "boxes", "spinning-rings"));
  INFO(kind);
  REQUIRE(kds_collide_in(folder, "--generate " + kind + " --bodies 300 --density 0.1 --seed 5").code == 0);
  const auto events = [&](const std::string& options) {
    const Outcome outcome = kds_collide_in(folder, kind + ".json --quiet --until 2 --events - " + options);
    CHECK(outcome.code == 0);
    CHECK(outcome.err.empty());
    return outcome.out;
  };
  const std::string expected = events("--stats one.json");
  CHECK(lines_of(expected).size() > 20);
  for (const std::string options : {"--domains 2", "--domains 3 --threads 2", "--domains 8 --threads 0 --rate 7"}) {
    const bool same = events(options + " --stats divided.json") == expected;
    INFO(options);
    CHECK(same);
    const auto one = nlohmann::json::parse(read_file(folder / "one.json"));
    const auto divided = nlohmann::json::parse(read_file(folder / "divided.json"));
    for (const char* count : {"contacts", "separations", "overlaps", "wall_contacts", "bodies"}) {
      CHECK(one[count] == divided[count]);
    }
    CHECK(divided["domains"] > 1);
    if (options == "--domains 2") CHECK(divided["broad_phase"] == "grid");
    CHECK(!one.contains("domains"));
  }
  const bool few_bodies = events("--domains 0") == expected;
  CHECK(few_bodies);
}

TEST_CASE("command line: a run that has ended early goes on from its last checkpoint") {
  const TemporaryFolder folder;
  const auto kind = std::string(GENERATE(as<std::string>(), "spheres", "spinning-rings"));
  INFO(kind);
  REQUIRE(kds_collide_in(folder, "--generate " + kind + " --bodies 200 --density 0.1 --seed 5").code == 0);
  const std::string run = kind + ".json --quiet --until 2 --events ";
  REQUIRE(kds_collide_in(folder, run + "one.csv").code == 0);
  const std::string expected = read_file(folder / "one.csv");
  CHECK(lines_of(expected).size() > 20);
  const std::string in_parts = run + "parts.csv --checkpoint run.state --checkpoint-every 0.7";
  REQUIRE(kds_collide_in(folder, in_parts).code == 0);
  const bool same = read_file(folder / "parts.csv") == expected;
  CHECK(same);
  // As if it had been ended after its last checkpoint, in the middle of a line.
  std::filesystem::rename(folder / "parts.csv", folder / "parts.csv.unfinished");
  const std::string stays = "parts.csv.unfinished: file: is there already, of a run that has not ended\n";
  CHECK(kds_collide_in(folder, in_parts).err == stays);
  std::filesystem::resize_file(folder / "parts.csv.unfinished", expected.size() - 7);
  CHECK(kds_collide_in(folder, in_parts + " --resume --stats rest.json").code == 0);
  const bool same_in_parts = read_file(folder / "parts.csv") == expected;
  CHECK(same_in_parts);
  const auto rest = nlohmann::json::parse(read_file(folder / "rest.json"));
  CHECK(rest["sim_seconds"].get<double>() == Approx(0.6));

  // One that was ended when the events had their place, and other outputs had not.
  CHECK(kds_collide_in(folder, in_parts + " --resume --stats again.json").code == 0);
  const bool same_again = read_file(folder / "parts.csv") == expected;
  CHECK(same_again);
  CHECK(std::filesystem::exists(folder / "again.json"));
  CHECK_FALSE(std::filesystem::exists(folder / "parts.csv.unfinished"));

  const auto refused = [&](const std::string& arguments, const std::string& line) {
    const Outcome outcome = kds_collide_in(folder, arguments);
    CHECK(outcome.code == 2);
    CHECK(outcome.err == line + "\n");
    CHECK(read_file(folder / "parts.csv") == expected);
  };
  const std::string goes_on = kind + ".json --checkpoint run.state --checkpoint-every 1 --resume ";
  refused(goes_on, "kds-collide: --events: is not given, and given in the checkpoint");
  const std::string with_events = goes_on + "--events parts.csv ";
  refused(with_events + "--events-apart", "kds-collide: --events-apart: is given, and not given in the checkpoint");
  refused(with_events + "--pairs", "kds-collide: --pairs: is given, and not given in the checkpoint");
  refused(with_events + "--shortest-flight 0.5", "kds-collide: --shortest-flight: is 0.5, and 0.001 in the checkpoint");
  refused(with_events + "--orientation-error 0.01",
          "kds-collide: --orientation-error: is 0.01, and 0.001 in the checkpoint");
  refused(with_events + "--until 1", "kds-collide: --until: the run ends at 1, and the checkpoint is of 1.4");
  folder.write("head_on.json", head_on);
  const Outcome other =
      kds_collide_in(folder, "head_on.json --events e.csv --checkpoint run.state --checkpoint-every 1 --resume");
  CHECK(other.code == 2);
  CHECK(other.err == "head_on.json: file: is not what it was when the checkpoint was written\n");

  // What is damaged is refused, and nothing else is changed.
  std::filesystem::rename(folder / "parts.csv", folder / "parts.csv.unfinished");
  for (std::size_t at = 0; at < expected.size() / 2; at += 1 + expected.size() / 20) {
    std::string damaged = expected;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    folder.write("parts.csv.unfinished", damaged);
    const Outcome outcome = kds_collide_in(folder, in_parts + " --resume");
    CHECK(outcome.code == 2);
    CHECK(outcome.err == "parts.csv.unfinished: file: cannot be gone on with: it is not what the run had written\n");
    CHECK(read_file(folder / "parts.csv.unfinished") == damaged);
  }
}

TEST_CASE("command line: --pairs adds the events of bounding volumes") {
  const TemporaryFolder folder;
  folder.write("scene.json", head_on);
  const auto lines = lines_of(kds_collide_in(folder, "scene.json --quiet --events - --pairs").out);
  REQUIRE(lines.size() == 5);
  CHECK(lines[1] == "1,pair_begin,a,b,,,,,,,-,-");
  CHECK(lines[2] == "1,contact,a,b,2,0,0,1,0,0,-,-");
}

TEST_CASE("command line: --view writes a page that needs nothing else") {
  const TemporaryFolder folder;
  folder.write("scene.json", head_on);
  const Outcome outcome = kds_collide_in(folder, "scene.json --view v.html --quiet");
  if (outcome.err.find("libjs-three") != std::string::npos) return;  // cannot be shown here
  CHECK(outcome.code == 0);
  const std::string page = read_file(folder / "v.html");
  CHECK_THAT(page, Catch::StartsWith("<!DOCTYPE html>") && Catch::Contains("OrbitControls = function"));
  CHECK_THAT(page, Catch::Contains("\"touches\":[[1,0,0,1,2,0,0,1,0,0],[3,1,0,1,"));
}

TEST_CASE("command line: --vtk writes a list of frames, as many a second as asked for") {
  const TemporaryFolder folder;
  folder.write("scene.json", head_on);
  const Outcome outcome = kds_collide_in(folder, "scene.json --vtk v.pvd --frame-rate 2 --until 3 --quiet");
  CHECK(outcome.code == 0);
  const std::string list = read_file(folder / "v.pvd");
  CHECK_THAT(list, Catch::Contains("<DataSet timestep=\"2.5\" group=\"\" part=\"0\" file=\"v.frames/frame_5.vtp\"/>"));
  CHECK_THAT(read_file(folder / "v.frames/frame_6.vtp"), Catch::Contains("<VTKFile type=\"PolyData\""));
  CHECK_FALSE(std::filesystem::exists(folder / "v.frames/frame_7.vtp"));
  CHECK(folder.file_count() == 3);
}

TEST_CASE("command line: --view shows how bodies turn") {
  const TemporaryFolder folder;
  const std::filesystem::path example = KDS_COLLIDE_EXAMPLE;
  const Outcome outcome = kds_collide_in(folder, "'" + (example / "turning.json").string() + "' --view v.html --quiet");
  if (outcome.err.find("libjs-three") != std::string::npos) return;  // cannot be shown here
  CHECK(outcome.code == 0);
  CHECK_THAT(read_file(folder / "v.html"), Catch::Contains(R"("motion":[[0,9.5,4,2]],"spins":[[0,0,0,1,0,0,-1]])"));
}

TEST_CASE("command line: --broad-phase list, --help and --version") {
  const TemporaryFolder folder;
  const Outcome list = kds_collide_in(folder, "--broad-phase list");
  CHECK(list.code == 0);
  for (const char* name : {"auto", "grid", "kinetic-sap", "sap", "all-pairs"}) {
    const auto lines = lines_of(list.out);
    CHECK(std::any_of(lines.begin(), lines.end(),
                      [&](const std::string& l) { return l.starts_with(std::string(name) + ' '); }));
  }
  CHECK(kds_collide_in(folder, "--help").code == 0);
  CHECK(kds_collide_in(folder, "--version").code == 0);
}

TEST_CASE("command line: whole numbers are decimal, zeros in front or not") {
  const TemporaryFolder folder;
  REQUIRE(kds_collide_in(folder, "--generate spheres --bodies 010 --seed 010 --output a.json").code == 0);
  REQUIRE(kds_collide_in(folder, "--generate spheres --bodies 10 --seed 10 --output b.json").code == 0);
  CHECK(read_file(folder / "a.json") == read_file(folder / "b.json"));
  CHECK(kds_collide_in(folder, "a.json --broad-phase kinetic-sap --kdop 014 --quiet").code == 0);
}

TEST_CASE("command line: the replay shows a bounce between two pieces of a script") {
  const TemporaryFolder folder;
  folder.write("scene.json", R"({"scene": 1, "end_time": 8, "response": "none",
    "domain": {"min": [0,0,0], "max": [10,10,10], "walls": "reflect"}, "bodies": [
    {"name": "a", "shape": {"sphere": {"radius": 1}}, "motion": [
      {"start": 0, "position": [[7,5,5], [1,0,0]]}, {"start": 5, "position": [[5,5,5]]}]}]})");
  const Outcome outcome = kds_collide_in(folder, "scene.json --view v.html --quiet");
  if (outcome.err.find("libjs-three") != std::string::npos) return;  // cannot be shown here
  CHECK_THAT(read_file(folder / "v.html"), Catch::Contains(R"("motion":[[0,7,5,5,1,0,0],[2,9,5,5,-1,0,0],[5,5,5,5]])"));
}

TEST_CASE("command line: a scene's name that is not UTF-8 does not lose the run") {
  const TemporaryFolder folder;
  folder.write("sc\xff.json", head_on);
  const Outcome outcome = kds_collide_in(folder, "sc\xff.json --view v.html --stats s.json --quiet");
  if (outcome.err.find("libjs-three") != std::string::npos) return;  // cannot be shown here
  CHECK(outcome.code == 0);
  CHECK(folder.file_count() == 3);
}

TEST_CASE("command line: scenes at the edge of what makes sense run") {
  const TemporaryFolder folder;
  const std::string ball =
      R"("shape": {"sphere": {"radius": 1}}, "motion": [{"start": 0, "position": [[1,2,3], [1,0,0]]}]})";
  const auto run = [&](const std::string& bodies) {
    folder.write("scene.json", R"({"scene": 1, "end_time": 1, "response": "elastic", "bodies": [)" + bodies + "]}");
    const Outcome outcome = kds_collide_in(folder, "scene.json --quiet --events -");
    CHECK(outcome.err.empty());
    CHECK(outcome.code == 0);
    return lines_of(outcome.out);
  };
  SECTION("no body") { CHECK(run("").size() == 1); }
  SECTION("one body") { CHECK(run("{\"name\": \"a\", " + ball).size() == 1); }
  SECTION("two bodies at one place that move alike") {
    const auto lines = run("{\"name\": \"a\", " + ball + ", {\"name\": \"b\", " + ball);
    REQUIRE(lines.size() == 2);
    CHECK_THAT(lines[1], Catch::StartsWith("0,overlap,a,b,"));
  }
}

}  // namespace test_command_line
