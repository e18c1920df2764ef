// You learn: bodies in a world; contacts at exact times, and an elastic response.
// How to run: build/dev/examples/10_contacts, then open the page that it names
// What you see: 11 contacts, and the energy is 1 of what it was
#include "certificates/ball_separation.hpp"
#include "certificates/wall_separation.hpp"
#include "collision/world.hpp"
#include "examples/course/facts.hpp"

#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

using namespace kds;
using namespace kds::collision;
using Eigen::Vector3d;
using Path = certificates::PointMotion<2>;

const Vector3d gravity(0, -1, 0);

/// Receives contacts while the world runs. Motions are already those after the bounce.
class Teller final : public WorldListener<2> {
 public:
  explicit Teller(course::Page& page) : page_(page) {}

  void contact(World<2>& world, const PairEvent& event) override {
    ++contacts;
    const Id a = body_slot(event.a), b = body_slot(event.b);
    tell(world, event.contact.time, page_.name(a) + " hits " + page_.name(b), {a, b});
  }
  void wall(World<2>& world, const WallEvent& event) override {
    const char* const walls[] = {"left", "right", "lower", "upper", "back", "front"};
    const Id id = body_slot(event.body);
    tell(world, event.contact.time, page_.name(id) + " hits the " + walls[event.wall] + " wall", {id});
  }

  /// The certificates that the page lists: until when each pair is apart and each ball inside, if nothing happens
  /// before.
  course::State known(const World<2>& world, double now) const {
    course::State state{.text = std::to_string(contacts) + " contacts so far"};
    for (Id a = 0; a < world.size(); ++a) {
      for (Id b = a + 1; b < world.size(); ++b) {
        const certificates::BallSeparation<2> apart{world.motion(a), world.motion(b), radius(a), radius(b)};
        const std::string fact = page_.name(a) + " and " + page_.name(b) + " are apart";
        const double fails = apart.first_approach(now, never);
        state.certificates.push_back(
            course::held(fact, {a, b}, apart, fails, 0, "distance\u00B2 \u2212 (sum of radii)\u00B2"));
      }
      state.certificates.push_back(inside(world, a, now));
    }
    return state;
  }
  /// The one that fails first of the four certificates that keep a ball inside.
  course::Held inside(const World<2>& world, Id id, double now) const {
    course::Held first;
    for (int i = 0; i < 4; ++i) {
      const auto wall = static_cast<std::size_t>(i);  // of x, y, x, y
      const certificates::WallSeparation<2> apart{world.motion(id).axis(i % 2), page_.walls[wall], radius(id),
                                                  i < 2 ? -1.0 : 1.0};
      // Just after a bounce the ball may be outside by a rounding, on its way in.
      const double from = sign_after(apart, now) < 0 ? recovery_time(apart, now) : now;
      const double fails = failure_time(apart, from);
      if (fails < first.fails) first = course::held("", {id}, apart, fails, 0, "distance of the wall \u2212 radius");
    }
    first.fact = page_.name(id) + " is inside the walls";
    first.members = {id};
    return first;
  }
  static double radius(Id id) { return 0.35 + 0.1 * id; }
  int contacts = 0;

 private:
  void tell(World<2>& world, double time, const std::string& text, const std::vector<Id>& members) {
    std::cout << "t = " << time << ": " << text << '\n';
    for (const Id id : members) page_.moves(id, world.motion(id), time);
    page_.event(time, text, members, known(world, time));
  }

  course::Page& page_;
};

double energy(const World<2>& world) {
  double sum = 0;
  for (BodyId id = 0; id < world.size(); ++id) {
    const Vector3d v = world.motion(id).velocity(world.now());
    sum += world.mass(id) * (v.squaredNorm() / 2 - gravity.dot(world.motion(id).position(world.now())));
  }
  return sum;
}

int main(int argc, char** argv) {
  const double end = 12;
  course::Page page(course::View::plane, "10 Contacts",
                    "Balls in gravity, in a box. A contact is the moment at which the distance of two balls is the sum "
                    "of their radii and falls; between contacts each path is one parabola.",
                    0, end);
  page.walls = {0, 0, 8, 5};
  page.window = {0, 0, 8, 5};
  page.play_time = 20;

  Teller teller(page);
  World<2> world({.response = Response::elastic, .walls = Walls{Vector3d(0, 0, -2), Vector3d(8, 5, 2)}}, &teller);
  const Vector3d places[] = {{1, 1, 0}, {3, 3.5, 0}, {5, 1.2, 0}, {6.6, 3.6, 0}};
  const Vector3d speeds[] = {{1.1, 1.6, 0}, {0.7, 0, 0}, {-0.8, 1.2, 0}, {-1.2, -0.4, 0}};
  for (Id id = 0; id < 4; ++id) {
    const Path path = Path::parabola(places[id], speeds[id], gravity);
    const double radius = Teller::radius(id);
    page.element(id, std::string(1, static_cast<char>('a' + id)), radius);
    page.moves(id, path, 0);
    world.add_body({.shape = Sphere{radius}, .motion = {path}, .mass = radius * radius * radius});
  }
  world.advance_to(0);
  page.starts(teller.known(world, 0));
  const double before = energy(world);
  world.advance_to(end);
  world.audit();
  std::cout << teller.contacts << " contacts, and the energy is " << energy(world) / before << " of what it was\n";
  page.write(argc, argv, "10_contacts");
}
