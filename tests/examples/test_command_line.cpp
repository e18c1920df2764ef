#include "tests/examples/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

using kds_collide::tests::read_file;
using kds_collide::tests::TemporaryFolder;

namespace {

struct Outcome {
  int code;
  std::string out;
  std::string err;
};

/// Runs the tool in the folder, `by` another program if one is named.
Outcome kds_collide_in(const TemporaryFolder& folder, const std::string& arguments, const std::string& by = "") {
  const TemporaryFolder streams;
  const std::string out = (streams / "out").string();
  const std::string err = (streams / "err").string();
  const std::string command = "cd '" + (folder / "").string() + "' && " + by + " '" KDS_COLLIDE_PROGRAM "' " +
                              arguments + " >" + out + " 2>" + err + " </dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(out), read_file(err)};
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// Two balls that meet at t = 1.
const char* const head_on = R"({"scene": 1, "end_time": 3, "response": "none", "bodies": [
  {"name": "a", "shape": {"sphere": {"radius": 1}}, "motion": [{"start": 0, "position": [[0,0,0], [1,0,0]]}]},
  {"name": "b", "shape": {"sphere": {"radius": 1}}, "motion": [{"start": 0, "position": [[4,0,0], [-1,0,0]]}]}]})";

}  // namespace

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

TEST_CASE("command line: the scene of the documentation has the events of the documentation") {
  const TemporaryFolder folder;
  const std::filesystem::path example = KDS_COLLIDE_EXAMPLE;
  const Outcome outcome = kds_collide_in(folder, "'" + (example / "scene.json").string() + "' --events - --quiet");
  CHECK(outcome.code == 0);
  CHECK(outcome.err.empty());
  CHECK(outcome.out == read_file(example / "events.csv"));
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
  CHECK_THAT(outcome.err, Catch::Contains("held together 1 times"));
  const auto stats = nlohmann::json::parse(read_file(folder / "s.json"));
  CHECK(stats["held"] == 1);
  const auto events = lines_of(read_file(folder / "e.csv"));
  CHECK(events.size() == stats["contacts"].get<std::size_t>() + 1);
  CHECK(events.size() < 100);
  // Flights that shrink by a half: at rest three times as late as it first lands.
  CHECK(std::stod(events.back()) == Approx(3 * std::stod(events[1])).epsilon(1e-6));
}

TEST_CASE("command line: all broad phases write the same events of generated scenes") {
  const TemporaryFolder folder;
  const auto kind = std::string(GENERATE(as<std::string>(), "rings", "spheres", "boxes", "models"));
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
  CHECK_THAT(page, Catch::Contains("\"touches\":[[1,0,0,1],[3,1,0,1]]"));
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

TEST_CASE("command line: bad arguments and bad scenes end with 2 and one line, and leave nothing behind") {
  const TemporaryFolder folder;
  folder.write("scene.json", head_on);
  folder.write("bad.json", "{\"scene\": 1, \"end_time\": NaN}");
  const auto [arguments, error] = GENERATE(table<std::string, std::string>({
      {"", "kds-collide: SCENE: is missing"},
      {"none.json", "none.json: file: cannot be read: No such file or directory"},
      {"bad.json --events e.csv --stats s.json", "bad.json: end_time: line 1, column 26: "},
      {"scene.json --frobnicate", "kds-collide: arguments: The following argument was not expected: --frobnicate"},
      {"scene.json --rate fast", "kds-collide: arguments: --rate: \"fast\" is not a finite number"},
      {"scene.json --rate ''", "kds-collide: arguments: --rate: \"\" is not a finite number"},
      {"scene.json --rate=", "kds-collide: arguments: --rate: "},
      {"scene.json --rate '{}'", "kds-collide: arguments: --rate: \"{}\" is not a finite number"},
      {"scene.json --rate 1e999", "kds-collide: arguments: --rate: \"1e999\" is out of range"},
      {"scene.json --rate 0x10", "kds-collide: arguments: --rate: \"0x10\" is not a finite number"},
      {"scene.json --until ''", "kds-collide: arguments: --until: \"\" is not a finite number"},
      {"scene.json --kdop 14.5", "kds-collide: arguments: --kdop: \"14.5\" is not a whole number from 0 to "},
      {"scene.json --kdop 016", "kds-collide: --kdop: must be 6, 14, 18 or 26"},
      {"scene.json --threads ''", "kds-collide: arguments: --threads: \"\" is not a whole number from 0 to 1844"},
      {"scene.json --rate -1", "kds-collide: --rate: must be >= 0"},
      {"scene.json --rate nan", "kds-collide: arguments: --rate: \"nan\" is not a finite number"},
      {"scene.json --until inf", "kds-collide: arguments: --until: \"inf\" is not a finite number"},
      {"scene.json --until -1", "kds-collide: --until: is before the motion begins"},
      {"scene.json --broad-phase best",
       "kds-collide: --broad-phase: there is no \"best\"; there are auto, grid, kinetic-sap"},
      {"scene.json --broad-phase kinetic-sap --kdop 8", "kds-collide: --kdop: must be 6, 14, 18 or 26"},
      {"scene.json --kdop 14", "kds-collide: --kdop: more than 6 is for --broad-phase kinetic-sap alone"},
      {"scene.json --broad-phase sap --rate 1e-310",
       "kds-collide: --rate: must be 0 or have a finite period, 1 / rate"},
      {"scene.json --broad-phase sap", "kds-collide: --rate: must be > 0 for the broad phase \"sap\""},
      {"scene.json --events none/e.csv", "none/e.csv: file: cannot be written: No such file or directory"},
      {"scene.json --events e.csv --stats none/s.json", "none/s.json: file: cannot be written: "},
      {"scene.json --events scene.json", "kds-collide: --events: is the same file as SCENE"},
      {"scene.json --events x --stats x", "kds-collide: --stats: is the same file as --events"},
      {"scene.json --events ./x --view x", "kds-collide: --view: is the same file as --events"},
      {"scene.json --events ''", "kds-collide: arguments: --events: names no file"},
      {"scene.json --rate 1e300", "kds-collide: --rate: asks for more than 1e12 results"},
      {"scene.json --threads -1", "kds-collide: arguments: --threads: \"-1\" is not a whole number from 0 to 1844"},
      {"scene.json --until 1e300",
       "scene.json: bodies[0].motion[0].position: may reach a magnitude of 1e+300 by t = 1e+300"},
      {"scene.json --generate rings", "kds-collide: SCENE: with --generate nothing is run; give --output"},
      {"--generate rings --events e.csv", "kds-collide: arguments: --events excludes --generate"},
      {"--generate rings --until 5", "kds-collide: arguments: --until excludes --generate"},
      {"--generate rings --bodies 2 --output ring.obj", "kds-collide: --output: is the name of the mesh ring.obj too"},
      {"--generate cubes", "kds-collide: --generate: there is no \"cubes\""},
      {"--generate rings --density 2", "kds-collide: --density: must be from 1e-12 to 0.3"},
      {"--generate rings --density ''", "kds-collide: arguments: --density: \"\" is not a finite number"},
      {"--generate rings --bodies 0", "kds-collide: --bodies: must be > 0"},
      {"--generate rings --bodies -5", "kds-collide: arguments: --bodies: \"-5\" is not a whole number from 0 to "},
      {"--generate rings --seed 18446744073709551616",
       "kds-collide: arguments: --seed: \"18446744073709551616\" is not a whole number from 0 to 18446744073709551615"},
      {"--generate rings --bodies 99999999999", "kds-collide: --bodies: must be at most 10000000"},
      {"scene.json --bodies 5", "kds-collide: arguments: --bodies requires --generate"},
  }));
  INFO(arguments);
  const Outcome outcome = kds_collide_in(folder, arguments);
  CHECK(outcome.code == 2);
  CHECK(outcome.out.empty());
  CHECK_THAT(outcome.err, Catch::StartsWith(error));
  CHECK(lines_of(outcome.err).size() == 1);
  CHECK(folder.file_count() == 2);
}

TEST_CASE("command line: an error is one line, whatever the arguments hold") {
  const TemporaryFolder folder;
  folder.write("scene.json", head_on);
  const Outcome outcome = kds_collide_in(folder, "scene.json --events \"$(printf 'no\\rsuch\\nfol\\033der/e')\"");
  CHECK(outcome.code == 2);
  CHECK(outcome.err == "no such fol der/e: file: cannot be written: No such file or directory\n");
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

TEST_CASE("command line: outputs that are one file by way of a link that leads nowhere yet are refused") {
  const TemporaryFolder folder;
  folder.write("scene.json", head_on);
  std::filesystem::create_symlink("x", folder / "link");
  const Outcome outcome = kds_collide_in(folder, "scene.json --quiet --events link --stats x");
  CHECK(outcome.code == 2);
  CHECK(outcome.err == "kds-collide: --stats: is the same file as --events\n");
}

TEST_CASE("command line: no output takes the place of a mesh of the scene") {
  const TemporaryFolder folder;
  const std::string mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  folder.write("plate.obj", mesh);
  folder.write("scene.json",
               R"({"scene": 1, "end_time": 1, "meshes": {"plate": {"file": "plate.obj"}}, "bodies": []})");
  const Outcome outcome = kds_collide_in(folder, "scene.json --events ../$(basename \"$PWD\")/plate.obj");
  CHECK(outcome.code == 2);
  CHECK(outcome.err == "kds-collide: --events: is the same file as meshes.plate.file of the scene\n");
  CHECK(read_file(folder / "plate.obj") == mesh);
}

TEST_CASE("command line: outputs may share a device, and one that is full ends the run with 1") {
  const TemporaryFolder folder;
  folder.write("scene.json", head_on);
  CHECK(kds_collide_in(folder, "scene.json --quiet --events /dev/null --stats /dev/null").code == 0);
  const Outcome full = kds_collide_in(folder, "scene.json --quiet --stats s.json --events /dev/full");
  CHECK(full.code == 1);
  CHECK(full.err == "/dev/full: file: cannot be written: No space left on device\n");
  CHECK(kds_collide_in(folder, "scene.json --quiet --stats /dev/full --events e.csv").code == 1);
  CHECK(folder.file_count() == 1);
}

TEST_CASE("command line: a run that is ended by a signal leaves nothing behind") {
  const TemporaryFolder folder;
  folder.write("scene.json", head_on);
  const std::string signal = GENERATE("INT", "TERM", "HUP", "PIPE", "QUIT", "XCPU");
  INFO(signal);
  const Outcome outcome = kds_collide_in(folder, "scene.json --quiet --events e.csv --stats s.json --rate 1e11",
                                         "ulimit -c 0; timeout --signal=" + signal + " 0.3");
  CHECK(outcome.code == 124);  // of timeout: it had to
  CHECK(folder.file_count() == 1);
}

TEST_CASE("command line: a file that may not grow so far ends the run with 1") {
  const TemporaryFolder folder;
  REQUIRE(kds_collide_in(folder, "--generate spheres --bodies 400 --output scene.json").code == 0);
  const std::string events = GENERATE("e.csv", "-");
  const Outcome outcome =
      kds_collide_in(folder, "scene.json --pairs --quiet --stats s.json --events " + events, "ulimit -f 4; ");
  CHECK(outcome.code == 1);
  CHECK(outcome.err == events + ": file: cannot be written: File too large\n");
  CHECK(folder.file_count() == 1);
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
