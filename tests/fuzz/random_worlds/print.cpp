#include "tests/fuzz/random_worlds/print.hpp"

#include "tests/fuzz/random_worlds/meshes.hpp"
#include "tests/fuzz/random_worlds/program_head.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <set>
#include <string>
#include <variant>

namespace kds::fuzz {
namespace {

/// Short if it is exact, else in hexadecimal.
std::string number(double x) {
  char letters[64];
  std::snprintf(letters, sizeof letters, x * 64 == std::floor(x * 64) && std::abs(x) < 1e6 ? "%.10g" : "%a", x);
  return letters;
}
std::string vector(const Vector3d& v) { return "{" + number(v[0]) + ", " + number(v[1]) + ", " + number(v[2]) + "}"; }
std::string path(const Path& p) {
  return "p.path(" + number(p.start) + ", " + vector(p.place) + ", " + vector(p.velocity) + ", " +
         vector(p.half_acceleration) + ")";
}
const char* broad_phase(BroadPhaseKind kind) {
  constexpr std::array names{"automatic", "grid", "kinetic_sap", "sap", "all_pairs"};
  return names[static_cast<std::size_t>(kind)];
}

void print_call(const Scenario& scenario, const Call& call, const char* indent) {
  const std::string body = std::to_string(call.body);
  std::string text = std::string(call_names[static_cast<std::size_t>(call.kind)]) + "(" + body;
  switch (call.kind) {
    case Call::Kind::add:
      text += ", body_" + body + "(p)";
      break;
    case Call::Kind::attach:
      text += ", body_" + body + "(p), " + std::to_string(call.other);
      break;
    case Call::Kind::group:
      text += ", " + std::to_string(call.category) + "u";
      break;
    case Call::Kind::ignore:
      text += ", " + std::to_string(call.other) + (~call.collides_with != 0 ? ", true" : ", false");
      break;
    case Call::Kind::move:
    case Call::Kind::away_and_back:
      text += ", " + path(call.path);
      break;
    case Call::Kind::follow:
      text += ", " + std::to_string(call.other);
      break;
    case Call::Kind::filter:
      text += ", " + std::to_string(call.category) + "u, " + std::to_string(call.collides_with) + "u";
      break;
    case Call::Kind::weigh:
      text += ", " + number(call.mass);
      break;
    case Call::Kind::append: {
      Path later = call.path;
      later.start = call.seconds;
      text += ", " + path(later);
      break;
    }
    case Call::Kind::ring:
      text = "ring(" + number(call.seconds);
      break;
    case Call::Kind::push_off:
      text += ", -c.normal";
      if (call.other != call.body) text += "), p.push_off(" + std::to_string(call.other) + ", c.normal";
      break;
    case Call::Kind::advance:
    case Call::Kind::save:
      text = call.kind == Call::Kind::save ? "save_and_load(" : "advance(" + number(call.seconds);
      break;
    case Call::Kind::fail:
      text = "fail(";
      break;
    default:
      break;
  }
  const bool limited = call.kind == Call::Kind::add || call.kind == Call::Kind::attach;
  std::printf("%s%sp.%s);\n", indent,
              limited ? ("if (p.world->size() < " + std::to_string(scenario.most_alive) + ") ").c_str() : "",
              text.c_str());
}

void print_body(const Scenario& scenario, std::size_t number_of_body) {
  const BodyPlan& body = scenario.bodies[number_of_body];
  const BodyPlan plain;
  std::printf("\nBodyDescription<Degree> body_%zu(Player& p) {\n  BodyDescription<Degree> d;\n", number_of_body);
  if (body.shape == ShapeKind::ball) std::printf("  d.shape = Sphere{p.length * %s};\n", number(body.size[0]).c_str());
  if (body.shape == ShapeKind::box) {
    std::printf("  d.shape = Box{p.length * Vector3d%s};\n", vector(body.size).c_str());
  }
  if (body.shape == ShapeKind::capsule) {
    std::printf("  d.shape = Capsule{p.length * %s, p.length * %s};\n", number(body.size[0]).c_str(),
                number(body.size[1]).c_str());
  }
  if (body.shape == ShapeKind::hull) {
    std::printf("  d.shape = convex_hull({");
    for (const Eigen::Vector3d& corner : cut_box(body.size))
      std::printf("p.length * Vector3d%s, ", vector(corner).c_str());
    std::printf("});\n");
  }
  if (body.shape == ShapeKind::compound) {
    std::printf("  d.shape = compound(std::vector<CompoundPart>{");
    for (const collision::CompoundPart& part : angle(body.size)) {
      std::printf("{Box{p.length * Vector3d%s}, p.length * Vector3d%s}, ",
                  vector(std::get<collision::Box>(part.shape).half_extents).c_str(), vector(part.position).c_str());
    }
    std::printf("});\n");
  }
  if (body.shape == ShapeKind::half_space) {
    std::printf("  d.shape = HalfSpace{Vector3d%s};\n", vector(body.size).c_str());
  }
  if (body.shape == ShapeKind::mesh) {
    std::printf("  d.shape = MeshShape{mesh_%zu(), p.length * %s};\n", body.mesh, number(body.size[0]).c_str());
  }
  for (const Path& piece : body.pieces) std::printf("  d.motion.push_back(%s);\n", path(piece).c_str());
  const auto& q = body.orientation;
  if (q.coeffs() != plain.orientation.coeffs()) {
    std::printf("  d.orientation = Eigen::Quaterniond(%a, %a, %a, %a);\n", q.w(), q.x(), q.y(), q.z());
  }
  if (body.mass != plain.mass) std::printf("  d.mass = %s;\n", number(body.mass).c_str());
  if (body.restitution != plain.restitution) std::printf("  d.restitution = %s;\n", number(body.restitution).c_str());
  if (body.fixed) std::printf("  d.fixed = true;\n");
  if (body.category != plain.category || body.collides_with != plain.collides_with) {
    std::printf("  d.category = %u, d.collides_with = %uu;\n", body.category, body.collides_with);
  }
  if (body.group != 0) std::printf("  d.group = %u;\n", body.group);
  if (body.sensor) std::printf("  d.sensor = true;\n");
  if (body.volume == collision::BoundingVolume::sphere) std::printf("  d.volume = BoundingVolume::sphere;\n");
  if (body.box_function) {
    std::printf(
        "  const PlacedShape placed = place(d.shape, d.orientation);\n"
        "  const Vector3d margin = Vector3d::Constant(p.length * %s);\n"
        "  d.box = [low = Vector3d(placed.low - margin), high = Vector3d(placed.high + margin)](double t, const "
        "Motion& "
        "m) {\n    auto box = box_around<Degree>(m, low, high);\n    box.valid_until = t + %s;\n    return box;\n  "
        "};\n",
        number(body.box_margin).c_str(), number(body.box_validity).c_str());
  }
  std::printf("  return d;\n}\n");
}

std::set<std::size_t> bodies_used(const Scenario& scenario) {
  std::set<std::size_t> used;
  const auto use = [&](const Call& call) {
    if (call.kind == Call::Kind::add || call.kind == Call::Kind::attach) used.insert(call.body);
  };
  for (const Call& call : scenario.calls) use(call);
  for (const Reaction& reaction : scenario.reactions) {
    for (const Call& call : reaction.calls) use(call);
  }
  return used;
}

void print_mesh(std::size_t number_of_mesh) {
  const Surface& surface = sample_surfaces()[number_of_mesh];
  std::printf("\nstd::shared_ptr<const Mesh> mesh_%zu() {  // %s\n", number_of_mesh, surface.name);
  std::printf("  static const auto mesh = std::make_shared<const Mesh>(\n      std::vector<Vector3d>{");
  for (const Vector3d& v : surface.vertices) std::printf("%s, ", vector(v).c_str());
  std::printf("},\n      std::vector<Mesh::Triangle>{");
  for (const auto& t : surface.triangles) std::printf("{%u, %u, %u}, ", t[0], t[1], t[2]);
  std::printf("});\n  return mesh;\n}\n");
}

void print_options(const Scenario& scenario, const Way& way) {
  constexpr std::array responses{"none", "elastic", "callback"};
  std::printf("  p.options.start_time = %s;\n  p.options.response = Response::%s;\n",
              number(scenario.start_time).c_str(), responses[static_cast<std::size_t>(scenario.response)]);
  std::printf("  p.options.report_pairs = %d;\n  p.options.report_pieces = %d;\n",
              static_cast<int>(scenario.report_pairs), static_cast<int>(scenario.report_pieces));
  std::printf("  p.options.zeno = {%u, %a};\n  p.options.most_edits = 300;\n", scenario.zeno_contacts,
              scenario.zeno_interval);
  std::printf("  p.length = %a;\n  p.fixed_bodies_move = %d;\n", scenario.unit,
              static_cast<int>(scenario.fixed_bodies_move));
  if (scenario.walls) {
    std::printf(
        "  const Vector3d corner = Vector3d::Constant(p.length * %s);\n  p.options.walls = Walls{-corner, corner, "
        "%s};\n",
        number(scenario.wall.half_side).c_str(), number(scenario.wall.restitution).c_str());
  }
  std::printf(
      "  p.options.broad_phase = BroadPhaseKind::all_pairs;\n  if (other) {\n"
      "    p.options.broad_phase = BroadPhaseKind::%s;\n    p.load_into = BroadPhaseKind::%s;\n",
      broad_phase(way.broad_phase), broad_phase(way.load_into));
  if (way.broad_phase == BroadPhaseKind::sap) std::printf("    p.options.rate = %s;\n", number(way.rate).c_str());
  if (way.window != never) std::printf("    p.options.window = %a;\n", way.window);
  std::printf(
      "    p.options.kdop = %d;\n    p.stops = %d;\n    p.save_every = %zu;\n    p.saves_between_calls = %d;\n  }\n",
      way.kdop, way.stops, way.save_every, static_cast<int>(way.saves_between_calls));
  if (way.budgets) std::printf("  if (other) p.budgets = true;\n");
  if (way.runs_ahead) std::printf("  if (other) p.runs_ahead = true;\n");
}

void print_reactions(const Scenario& scenario) {
  std::printf(
      "  p.react = [&]([[maybe_unused]] const std::string& kind, [[maybe_unused]] int a, [[maybe_unused]] int b, "
      "[[maybe_unused]] int count, [[maybe_unused]] const Contact& c) {\n");
  for (const Reaction& reaction : scenario.reactions) {
    if (reaction.calls.empty()) continue;
    const EventKey& e = reaction.event;
    std::printf("    if (kind == \"%s\" && a == %zu && b == %zu && count == %zu) {\n", line_names[e.kind].data(), e.a,
                e.b, e.count);
    for (const Call& call : reaction.calls) print_call(scenario, call, "      ");
    std::printf("    }\n");
  }
  std::printf("  };\n");
}

}  // namespace

void print_program(const Scenario& scenario, const Way& way, const Difference& difference) {
  std::printf("// Seed %llu: %s differs from all-pairs: %s. Bodies are numbered as they are added.\n",
              static_cast<unsigned long long>(scenario.seed), way.name().c_str(), difference.what.c_str());
  std::printf("static constexpr int Degree = %d;\n%s", scenario.degree, program_head);
  const std::set<std::size_t> used = bodies_used(scenario);
  std::set<std::size_t> meshes;
  for (const std::size_t body : used) {
    if (scenario.bodies[body].shape == ShapeKind::mesh) meshes.insert(scenario.bodies[body].mesh);
  }
  for (const std::size_t mesh : meshes) print_mesh(mesh);
  for (const std::size_t body : used) print_body(scenario, body);
  std::printf("\nLog run(bool other) {\n  Player p;\n");
  print_options(scenario, way);
  print_reactions(scenario);
  std::printf("  p.begin();\n");
  for (const Call& call : scenario.calls) {
    const bool large = scenario.bodies.size() > Way::most_bodies_saved_often;
    if (!large || call.kind == Call::Kind::advance) std::printf("  p.between();\n");
    print_call(scenario, call, "  ");
  }
  std::printf(
      "  return p.log;\n}\n\nint main() {\n  const Log expected = run(false), found = run(true);\n"
      "  for (std::size_t i = 0; i < std::max(expected.size(), found.size()); ++i) {\n"
      "    const std::string e = i < expected.size() ? expected[i] : \"-\", f = i < found.size() ? found[i] : \"-\";\n"
      "    if (e == f) std::printf(\"    %%s\\n\", e.c_str());\n"
      "    if (e != f) std::printf(\"all-pairs: %%s\\nother:     %%s\\n\", e.c_str(), f.c_str());\n  }\n"
      "  return expected == found ? 0 : 1;\n}\n");
}

}  // namespace kds::fuzz
