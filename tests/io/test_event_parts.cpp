#include "io/event_parts.hpp"

#include "io/scene_reader.hpp"
#include "tests/io/parts_of_runs.hpp"
#include "tests/io/temporary_folder.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

namespace test_event_parts {

using namespace kds::io;
using namespace kds::io::tests;
using kds::tests::Random;

namespace {

std::size_t lines_in(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

/// Balls on a lattice with speeds of a lattice: contacts at the same times by the hundred.
Scene lattice() {
  Random random(77);
  Scene scene;
  constexpr int side = 5;
  for (int i = 0; i < side * side * side; ++i) {
    SceneBody body;
    body.name = std::to_string(i);
    body.shape = kds::collision::Sphere{0.5};
    MotionPiece piece;
    piece.path.coefficients = {1.5 * Eigen::Vector3d(i % side, i / side % side, i / side / side),
                               Eigen::Vector3d(random.integer(-1, 1), random.integer(-1, 1), random.integer(-1, 1)),
                               Eigen::Vector3d::Zero()};
    body.motion.push_back(piece);
    scene.bodies.push_back(body);
  }
  scene.end_time = 4;
  scene.response = Response::elastic;
  scene.domain = Domain{Eigen::Vector3d::Constant(-1), Eigen::Vector3d::Constant(1.5 * side), true};
  return scene;
}

std::string refusal(const Scene& scene, const std::string& file) {
  try {
    merged_parts(scene, file);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("event parts: merged they are the events of one world") {
  std::size_t events = 0, divided = 0, rests = 0, walls = 0, overlaps = 0, separations = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    INFO("seed " << seed);
    const TemporaryFolder folder;
    const std::string file = (folder / "events.csv").string();
    const Scene scene = random_scene(seed);
    const std::string right = events_of_one_world(scene);
    const RunResult result = run_apart(
        scene, file,
        {.processes = 1 + seed % 4, .domains = 2 + seed * 7 % 6, .run = seed, .rate = static_cast<double>(seed % 20)});
    REQUIRE(folder.file_count() == 1 + seed % 4);
    REQUIRE(merged_parts(scene, file, 1 + seed % 3) == right);
    events += lines_in(right), divided += result.bodies_owned > 0 ? 1 : 0;
    rests += count_of(right, ",rest,"), walls += count_of(right, ",wall,");
    overlaps += count_of(right, ",overlap,"), separations += count_of(right, ",separation,");
  }
  INFO(events << " events, " << divided << " scenes divided, " << rests << " rests, " << walls << " walls, " << overlaps
              << " overlaps, " << separations << " separations");
  CHECK(events > 3000);
  CHECK(divided > 30);
  CHECK(rests > 5);
  CHECK(walls > 300);
  CHECK(overlaps > 10);
  CHECK(separations > 100);
}

TEST_CASE("event parts: simultaneous events, more processes than domains, and one process without domains") {
  const Scene scene = lattice();
  const std::string right = events_of_one_world(scene);
  CHECK(lines_in(right) > 500);
  for (const std::size_t processes : {1u, 3u, 7u}) {
    const TemporaryFolder folder;
    const std::string file = (folder / "events.csv").string();
    CHECK(run_apart(scene, file, {.processes = processes, .domains = 5, .rate = 9}).bodies_owned > 0);
    CHECK(merged_parts(scene, file, 2) == right);
    run_apart(scene, file, {.processes = processes, .domains = 1});
    CHECK(merged_parts(scene, file) == right);
  }
}

TEST_CASE("event parts: a run that is ended early goes on with other processes") {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    INFO("seed " << seed);
    const TemporaryFolder folder;
    const std::string file = (folder / "events.csv").string();
    const Scene scene = random_scene(seed + 100);
    Random random(seed);
    Progress progress;
    for (std::uint64_t part = 1; part <= 4; ++part) {
      const std::size_t processes = 1 + random.below(4);
      INFO("part " << part << " by " << processes << " processes");
      run_apart(scene, file,
                {.processes = processes,
                 .domains = 2 + random.below(5),
                 .section = part,
                 .checkpoint_every = scene.end_time / 13,
                 .ends_at = part < 4 ? 1 + random.below(3) : 0},
                &progress);
      if (part < 4) {
        REQUIRE(!std::filesystem::exists(part_path(file, 0)));
        REQUIRE(refusal(scene, file) == part_path(file, 0) + ": file: cannot be read: No such file or directory");
      }
    }
    REQUIRE(merged_parts(scene, file) == events_of_one_world(scene));
  }
}

TEST_CASE("event parts: what a run has not ended is refused, and gone on with only where it fits") {
  const TemporaryFolder folder;
  const std::string file = (folder / "events.csv").string();
  const Scene scene = random_scene(3);
  const ApartOptions options{.checkpoint_every = 0.5};
  ApartOptions cut = options;
  cut.ends_at = 2;
  Progress progress;
  run_apart(scene, file, cut, &progress);
  CHECK(progress.parts.size() == 2);
  const std::string first = part_path(file, 0), second = part_path(file, 1), unfinished = second + ".unfinished";
  std::filesystem::copy_file(first + ".unfinished", first);
  std::filesystem::copy_file(unfinished, second);
  CHECK(refusal(scene, file) ==
        first + ": part of events: ends before the run: it has not ended, or this has been cut");
  std::filesystem::remove(first), std::filesystem::remove(second);

  const auto goes_on = [&] {
    Progress copy = progress;
    try {
      run_apart(scene, file, options, &copy);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string bytes = read_file(unfinished), of_first = read_file(first + ".unfinished");
  for (std::uint64_t at = 0; at < progress.parts[1].bytes; at += 1 + progress.parts[1].bytes / 60) {
    std::string other = bytes;
    other[at] = static_cast<char>(other[at] ^ 1);
    folder.write("events.csv.1.unfinished", other);
    const std::string why = goes_on();
    INFO(at << ": " << why);
    REQUIRE(why.find(unfinished + ": ") == 0);
    // Another one may still need what comes after the checkpoint.
    REQUIRE(read_file(first + ".unfinished") == of_first);
    REQUIRE(read_file(unfinished) == other);
  }
  Progress other_place = progress;
  other_place.parts[1].checksum ^= 1;
  folder.write("events.csv.1.unfinished", bytes);
  CHECK_THROWS_WITH(run_apart(scene, file, options, &other_place),
                    unfinished + ": file: cannot be gone on with: it is not what the run had written");
  folder.write("events.csv.1.unfinished", bytes.substr(0, progress.parts[1].bytes - 3));
  CHECK(goes_on().find(unfinished + ": file: cannot be gone on with: it has ") == 0);
  std::filesystem::remove(unfinished);
  CHECK(goes_on() == unfinished + ": file: cannot be gone on with: No such file or directory");
  CHECK(read_file(first + ".unfinished") == of_first);
  folder.write("events.csv.1.unfinished", bytes);
  CHECK(goes_on().empty());
  CHECK(merged_parts(scene, file) == events_of_one_world(scene));
}

TEST_CASE("event parts: a run that was killed while its parts took their places goes on, with other processes too") {
  const Scene scene = random_scene(3);
  const std::string right = events_of_one_world(scene);
  for (std::size_t in_place = 0; in_place < 8; ++in_place) {
    for (const std::size_t processes : {1u, 2u, 4u}) {
      INFO(in_place << ", " << processes);
      const TemporaryFolder folder;
      const std::string file = (folder / "events.csv").string();
      Progress progress;
      run_apart(scene, file, {.processes = 3, .checkpoint_every = 0.5}, &progress);
      for (std::size_t rank = 0; rank < 3; ++rank) {
        const std::string part = part_path(file, rank);
        if ((in_place >> rank & 1) == 0) std::filesystem::rename(part, part + ".unfinished");
      }
      run_apart(scene, file, {.processes = processes, .section = 2, .checkpoint_every = 0.5}, &progress);
      REQUIRE(merged_parts(scene, file) == right);
      CHECK(folder.file_count() == std::max<std::size_t>(3, processes));
    }
  }
}

TEST_CASE("event parts: what a run has left of more processes is removed, and nothing else") {
  const Scene scene = random_scene(3);
  const TemporaryFolder folder;
  const std::string file = (folder / "events.csv").string(), other = (folder / "other.csv").string();
  run_apart(scene, other, {.processes = 1, .run = 2});
  Progress progress;
  run_apart(scene, file, {.processes = 2, .checkpoint_every = 0.5, .ends_at = 1}, &progress);
  Progress later = progress;
  run_apart(scene, file, {.processes = 5, .section = 2, .checkpoint_every = 0.5, .ends_at = 1}, &later);
  REQUIRE(std::filesystem::exists(file + ".4.unfinished"));
  std::filesystem::remove(file + ".3.unfinished");
  std::filesystem::rename(file + ".2.unfinished", file + ".2");
  const std::string kept[] = {"events.csv.7", "events.csv.8.unfinished", "events.csv.04", "events.csv.9",
                              "events.csv.x"};
  for (const std::string& name : kept) {
    folder.write(name, name == "events.csv.9" ? "time,kind\n" : read_file(other + ".0"));
  }
  folder.write("events.csv.6.unfinished", "");
  SECTION("by fewer") {
    run_apart(scene, file, {.processes = 1, .section = 3, .checkpoint_every = 0.5}, &progress);
    CHECK(folder.file_count() == 2 + 1 + 5);
  }
  SECTION("those of others are not written over") {
    std::filesystem::rename(file + ".4.unfinished", file + ".2.unfinished");
    std::filesystem::rename(file + ".8.unfinished", file + ".3.unfinished");
    Progress copy = progress;
    CHECK_THROWS_WITH(run_apart(scene, file, {.processes = 5, .section = 3, .checkpoint_every = 0.5}, &copy),
                      file + ".3.unfinished: file: is there already, of a run that has not ended");
    std::filesystem::rename(file + ".3.unfinished", file + ".8.unfinished");
    run_apart(scene, file, {.processes = 5, .section = 3, .checkpoint_every = 0.5}, &progress);
    CHECK(folder.file_count() == 5 + 1 + 5);
  }
  for (const std::string& name : kept) CHECK(std::filesystem::exists(folder / name));
  CHECK(merged_parts(scene, file) == events_of_one_world(scene));
}

TEST_CASE("event parts: of other runs, scenes and processes they are refused") {
  const TemporaryFolder folder;
  const std::string file = (folder / "events.csv").string(), other = (folder / "other.csv").string();
  const Scene scene = random_scene(4);
  run_apart(scene, file, {.processes = 3, .run = 1});
  run_apart(scene, other, {.processes = 3, .run = 2});
  const auto part = [&](const std::string& of, std::size_t rank) { return read_file(part_path(of, rank)); };
  const std::string right[] = {part(file, 0), part(file, 1), part(file, 2)};
  const auto put = [&](std::size_t rank, const std::string& bytes) {
    return folder.write("events.csv." + std::to_string(rank), bytes).string() + ": part of events: ";
  };
  const std::string second = put(1, right[2]);
  CHECK(refusal(scene, file) == second + "is that of process 2");
  put(2, right[1]);
  CHECK(refusal(scene, file) == second + "is that of process 2");
  put(1, right[1]);
  const std::string third = put(2, part(other, 2));
  CHECK(refusal(scene, file) == third + "is of another run");
  put(2, right[2] + "x");
  CHECK(refusal(scene, file) == third + "has something behind its end");
  put(2, "time,kind,a,b,px,py,pz\n");
  CHECK(refusal(scene, file) == third + "is none, or is of another version");
  put(2, "");
  CHECK(refusal(scene, file) == third + "is none, or is of another version");
  std::filesystem::remove(part_path(file, 2));
  CHECK(refusal(scene, file) == part_path(file, 2) + ": file: cannot be read: No such file or directory");
  put(2, right[2]);
  const std::string first = put(0, right[1]);
  CHECK(refusal(scene, file) == first + "is that of process 1");
  put(0, right[0]);
  Scene larger = scene;
  larger.bodies.push_back(scene.bodies.front());
  CHECK(refusal(larger, file) == first + "is of another scene");
  CHECK_THROWS_WITH(EventParts(file, scene_number + 1, scene.bodies.size()), first + "is of another scene");
  CHECK(merged_parts(scene, file) == events_of_one_world(scene));
}

TEST_CASE("event parts: those that are damaged are refused, wherever it is") {
  const TemporaryFolder folder;
  const std::string file = (folder / "events.csv").string();
  Scene scene = random_scene(7);
  scene.end_time = 0.2;
  const std::string right = events_of_one_world(scene);
  run_apart(scene, file, {.processes = 2, .rate = 20});
  Random random(7);
  std::size_t tried = 0;
  for (const std::size_t rank : {0u, 1u}) {
    const std::string name = "events.csv." + std::to_string(rank), bytes = read_file(folder / name);
    const auto put = [&](const std::string& text) {
      std::filesystem::remove(folder / name);  // To write over what is there waits for the disk, on some systems.
      folder.write(name, text);
    };
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      INFO("part " << rank << ", byte " << i << " of " << bytes.size());
      std::string damaged = bytes;
      damaged[i] = static_cast<char>(damaged[i] ^ (1 << random.below(8)));
      put(damaged);
      REQUIRE(refusal(scene, file).find(name + ": part of events: ") != std::string::npos);
      put(bytes.substr(0, i));
      REQUIRE(refusal(scene, file).find(name + ": part of events: ") != std::string::npos);
      if (++tried % 4 > 0) continue;
      // A few bytes that are missing or twice there, as where blocks are written anew.
      const std::size_t length = 1 + random.below(100);
      damaged = bytes.substr(0, i) + bytes.substr(std::min(bytes.size(), i + length));
      put(damaged);
      REQUIRE(refusal(scene, file).find(name + ": part of events: ") != std::string::npos);
      put(bytes.substr(0, i) + bytes.substr(i, length) + bytes.substr(i));
      REQUIRE(refusal(scene, file).find(name + ": part of events: ") != std::string::npos);
    }
    put(bytes);
  }
  CHECK(tried > 1000);
  CHECK(lines_in(right) > 10);
  CHECK(merged_parts(scene, file) == right);
}

TEST_CASE("event parts: blocks that are left out, twice there or in other places are refused") {
  const TemporaryFolder folder;
  const std::string file = (folder / "events.csv").string();
  const Scene scene = random_scene(5);
  run_apart(scene, file, {.processes = 2, .rate = 5});
  const std::string name = "events.csv.1", bytes = read_file(folder / name);
  std::vector<std::string> blocks;
  for (std::size_t at = 8; at < bytes.size();) {
    std::uint64_t size = 0;
    std::memcpy(&size, bytes.data() + at + 8, sizeof size);
    blocks.push_back(bytes.substr(at, 24 + size));
    at += 24 + size;
  }
  REQUIRE(blocks.size() > 5);
  const auto with = [&](const std::vector<std::string>& order) {
    std::string text = bytes.substr(0, 8);
    for (const std::string& block : order) text += block;
    folder.write(name, text);
    return refusal(scene, file);
  };
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    auto order = blocks;
    order.erase(order.begin() + static_cast<std::ptrdiff_t>(i));
    CHECK(with(order).find(name + ": part of events: ") != std::string::npos);
    order.insert(order.begin() + static_cast<std::ptrdiff_t>(i), 2, blocks[i]);
    CHECK(with(order).find(name + ": part of events: ") != std::string::npos);
    if (i == 0) continue;
    order = blocks;
    std::swap(order[i], order[i - 1]);
    CHECK(with(order).find(name + ": part of events: ") != std::string::npos);
  }
  CHECK(with(blocks).empty());
}

TEST_CASE("event parts: events that cannot be, or on which parts do not agree, are refused") {
  using kds::collision::DomainEvent;
  const TemporaryFolder folder;
  const std::string file = (folder / "events.csv").string();
  const Scene scene = random_scene(5);
  const auto merged = [&](const std::vector<std::vector<DomainEvent>>& logs) {
    for (std::size_t rank = 0; rank < logs.size(); ++rank) {
      EventPart part(part_path(file, rank),
                     {.scene = scene_number, .bodies = scene.bodies.size(), .rank = rank, .processes = logs.size()});
      part.on_step({.domains = logs.size(), .first = rank, .logs = {logs[rank]}});
      part.close();
      part.commit();
    }
    return refusal(scene, file);
  };
  const auto event = [](double t, std::size_t other, std::uint32_t a, std::uint32_t b) {
    return DomainEvent{DomainEvent::Kind::contact, static_cast<decltype(DomainEvent::other_owner)>(other), a, b, {t}};
  };
  CHECK(merged({{event(1, 1, 2, 3)}, {event(1, 0, 2, 3)}}).empty());
  auto rests = event(1, DomainEvent::nobody, 2, 3);
  rests.kind = DomainEvent::Kind::rests;
  rests.cause = {DomainEvent::Cause::Phase::contacts, 1, 2};
  auto suppressed = rests;  // of a kind that files have not
  suppressed.kind = DomainEvent::Kind::rebound_suppressed;
  CHECK(merged({{event(1, DomainEvent::nobody, 1, 2), suppressed, rests}, {event(1, DomainEvent::nobody, 1, 3)}})
            .empty());
  auto passes = event(1, 1, 2, 3), told_by_other = event(1, 0, 2, 3);
  for (auto* one : {&passes, &told_by_other})
    one->kind = DomainEvent::Kind::passes, one->cause = {rests.cause.phase, 2, 3};
  CHECK(merged({{event(1, 1, 2, 3), passes}, {event(1, 0, 2, 3), told_by_other}}).empty());
  auto mark = event(1, 1, 2, 2), other_mark = event(1, 0, 2, 2);
  for (auto* one : {&mark, &other_mark}) one->kind = DomainEvent::Kind::mark, one->cause = rests.cause;
  CHECK(merged({{event(1, DomainEvent::nobody, 1, 2), mark}, {other_mark, rests}}).empty());
  const std::string first = part_path(file, 0) + ": part of events: ",
                    cannot_be = "has an event that cannot be one of ";
  const std::string disagree = first + "does not agree with the others about what has happened";
  CHECK(merged({{event(1, 1, 2, 3)}, {}}) == disagree);
  CHECK(merged({{mark}, {}}) == disagree);
  mark.other_owner = 0;
  CHECK(merged({{mark}, {}}) == first + cannot_be + "this scene");
  CHECK(merged({{event(1, 1, 2, 3)}, {event(2, 0, 2, 3)}}) == disagree);
  CHECK(merged({{event(1, 1, 2, 3)}, {event(1, DomainEvent::nobody, 2, 3)}}) == disagree);
  CHECK(merged({{event(1, 0, 2, 3)}, {}}) == first + cannot_be + "this scene");
  CHECK(merged({{event(1, 2, 2, 3)}, {}}) == first + cannot_be + "this scene");
  const auto none = static_cast<std::uint32_t>(scene.bodies.size());
  CHECK(merged({{event(1, DomainEvent::nobody, 2, none)}, {}}) == first + cannot_be + "this scene");
}

}  // namespace test_event_parts
