// What is refused, and what a run that does not end well leaves behind.
#include "tests/examples/command_line.hpp"

#include <catch2/catch.hpp>

#include <filesystem>
#include <string>

namespace test_command_line_errors {

using kds::io::tests::head_on;
using kds::io::tests::kds_collide_in;
using kds::io::tests::lines_of;
using kds::io::tests::Outcome;
using kds::io::tests::read_file;
using kds::io::tests::TemporaryFolder;

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
      {"scene.json --domains 65536", "kds-collide: --domains: at most 65535"},
      {"scene.json --domains 2 --pairs", "kds-collide: --domains: volumes are not told of in a scene that is divided"},
      {"scene.json --domains 2 --view v.html",
       "kds-collide: --domains: there are no pictures of a scene that is divided"},
      {"scene.json --checkpoint-every 1", "kds-collide: --checkpoint-every: needs --checkpoint"},
      {"scene.json --resume", "kds-collide: --resume: needs --checkpoint"},
      {"scene.json --checkpoint c", "kds-collide: --checkpoint: needs --checkpoint-every, a time > 0"},
      {"scene.json --checkpoint c --checkpoint-every 0",
       "kds-collide: --checkpoint: needs --checkpoint-every, a time > 0"},
      {"scene.json --checkpoint c --checkpoint-every 1e-310", "kds-collide: --checkpoint: needs --checkpoint-every, "},
      {"scene.json --checkpoint c --checkpoint-every 1e-30",
       "kds-collide: --checkpoint-every: asks for more than 1e12"},
      {"scene.json --checkpoint c --checkpoint-every 1 --events -",
       "kds-collide: --checkpoint: the checkpoint and the events must be files"},
      {"scene.json --checkpoint c --checkpoint-every 1 --view v.html",
       "kds-collide: --checkpoint: there are no pictures of a run in parts"},
      {"scene.json --checkpoint scene.json --checkpoint-every 1",
       "kds-collide: --checkpoint: is the same file as SCENE"},
      {"scene.json --checkpoint c --checkpoint-every 1 --events c.a.0",
       "kds-collide: --checkpoint: a part of it is the same file as --events"},
      {"scene.json --checkpoint c --checkpoint-every 1 --events c.b --events-apart",
       "kds-collide: --checkpoint: a part of it is the same file as a part of --events"},
      {"scene.json --checkpoint c --checkpoint-every 1 --stats ./c.b.17",
       "kds-collide: --checkpoint: a part of it is the same file as --stats"},
      {"scene.json --checkpoint e.unfinished --checkpoint-every 1 --events e",
       "kds-collide: --events: is the same file as --checkpoint"},
      {"scene.json --checkpoint c --checkpoint-every 1 --events e --events-apart --stats e.1.unfinished",
       "kds-collide: --events: a part of it is the same file as --stats"},
      {"scene.json --events e --events-apart --stats e.3",
       "kds-collide: --events: a part of it is the same file as --stats"},
      {"scene.json --checkpoint c --checkpoint-every 1 --resume", "c: file: cannot be read: No such file or directory"},
      {"scene.json --checkpoint bad.json --checkpoint-every 1 --resume", "bad.json: checkpoint: snapshot: "},
      {"scene.json --kdop 14", "kds-collide: --kdop: more than 6 is for --broad-phase kinetic-sap alone"},
      {"scene.json --broad-phase sap --rate 1e-310",
       "kds-collide: --rate: must be 0 or have a finite period, 1 / rate"},
      {"scene.json --broad-phase sap", "kds-collide: --rate: must be > 0 for the broad phase \"sap\""},
      {"scene.json --events none/e.csv", "none/e.csv: file: cannot be written: No such file or directory"},
      {"scene.json --events e.csv --stats none/s.json", "none/s.json: file: cannot be written: "},
      {"scene.json --events scene.json", "kds-collide: --events: is the same file as SCENE"},
      {"scene.json --events x --stats x", "kds-collide: --stats: is the same file as --events"},
      {"scene.json --events ./x --view x", "kds-collide: --view: is the same file as --events"},
      {"scene.json --vtk run.vtu", "kds-collide: --vtk: must end in .pvd"},
      {"scene.json --vtk a.pvd --gltf a.frames", "kds-collide: --vtk: is the same file as --gltf"},
      {"scene.json --vtk a.pvd --frame-rate 0", "kds-collide: --frame-rate: must be finite and > 0"},
      {"scene.json --vtk none/a.pvd", "none/a.pvd: file: cannot be written: "},
      {"scene.json --domains 2 --vtk a.pvd",
       "kds-collide: --domains: there are no pictures of a scene that is divided"},
      {"scene.json --events ''", "kds-collide: arguments: --events: names no file"},
      {"scene.json --rate 1e300", "kds-collide: --rate: asks for more than 1e12 results"},
      {"scene.json --threads -1", "kds-collide: arguments: --threads: \"-1\" is not a whole number from 0 to 1844"},
      {"scene.json --until 1e300",
       "scene.json: bodies[0].motion[0].position: may reach a magnitude of 1e+300 by t = 1e+300"},
      {"scene.json --generate rings", "kds-collide: SCENE: with --generate nothing is run; give --output"},
      {"--generate rings --events e.csv", "kds-collide: arguments: --events excludes --generate"},
      {"--generate rings --until 5", "kds-collide: arguments: --until excludes --generate"},
      {"--generate rings --bodies 2 --output ring.obj", "kds-collide: --output: is the name of the mesh ring.obj too"},
      {"--generate spheres --table --output s.h5", "kds-collide: --output: is the name of the table too"},
      {"--generate rods --table", "kds-collide: --table: is for spheres, boxes, rings, models and spinning-rings"},
      {"scene.json --table", "kds-collide: arguments: --table requires --generate"},
      {"--generate cubes", "kds-collide: --generate: there is no \"cubes\""},
      {"--generate crates --density 0.01", "kds-collide: --density: is not for crates, whose bodies have places"},
      {"--generate sheet --density 0.2", "kds-collide: --density: is not for sheet, whose bodies have places"},
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

TEST_CASE("command line: outputs that are one file by way of a link that leads nowhere yet are refused") {
  const TemporaryFolder folder;
  folder.write("scene.json", head_on);
  std::filesystem::create_symlink("x", folder / "link");
  const Outcome outcome = kds_collide_in(folder, "scene.json --quiet --events link --stats x");
  CHECK(outcome.code == 2);
  CHECK(outcome.err == "kds-collide: --stats: is the same file as --events\n");
}

TEST_CASE("command line: no part of an output takes the place of what the scene names, by way of a link or not") {
  const TemporaryFolder folder;
  REQUIRE(kds_collide_in(folder, "--generate spheres --bodies 3 --table --output scene.json").code == 0);
  const std::string scene = read_file(folder / "scene.json"), table = read_file(folder / "scene.h5");
  std::filesystem::remove(folder / "scene.h5");
  const std::string name = GENERATE(as<std::string>(), "c.a.0", "c.b.12", "e.1", "e.0.unfinished");
  const bool linked = GENERATE(false, true);
  INFO(name << ", " << linked);
  folder.write(name, table);
  if (linked) {
    std::filesystem::create_symlink(name, folder / "scene.h5");
  } else {
    folder.write("scene.json", std::string(scene).replace(scene.find("scene.h5"), 8, name));
  }
  const Outcome outcome = kds_collide_in(
      folder, "scene.json --quiet --checkpoint c --checkpoint-every 1 --events e --events-apart --until 10");
  CHECK(outcome.code == 2);
  const std::string option = name[0] == 'c' ? "--checkpoint" : "--events";
  CHECK(outcome.err == "kds-collide: " + option + ": a part of it is the same file as tables[0].file of the scene\n");
  CHECK(read_file(folder / name) == table);
  CHECK(folder.file_count() == (linked ? 3 : 2));
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

TEST_CASE("command line: a run in parts whose first checkpoint cannot be written leaves nothing behind") {
  const TemporaryFolder folder;
  folder.write("scene.json", head_on);
  const std::string run = "scene.json --quiet --checkpoint c --checkpoint-every 2 --events e.csv" +
                          std::string(GENERATE("", " --events-apart"));
  const Outcome outcome = kds_collide_in(folder, run, "ulimit -f 1; ");
  CHECK(outcome.code == 1);
  CHECK(outcome.err == "c: file: cannot be written: File too large; there is no checkpoint yet to go on from\n");
  CHECK(folder.file_count() == 1);
  CHECK(kds_collide_in(folder, run).code == 0);  // and it can be begun anew
}

TEST_CASE("command line: an answer that cannot be written ends with 1") {
  const TemporaryFolder folder;
  const std::string option = GENERATE("--help", "--version", "--broad-phase list");
  INFO(option);
  CHECK(kds_collide_in(folder, option).code == 0);
  const Outcome full = kds_collide_in(folder, option + " > /dev/full 2> error; true");
  CHECK(read_file(folder / "error") == "-: file: cannot be written: No space left on device\n");
}

}  // namespace test_command_line_errors
