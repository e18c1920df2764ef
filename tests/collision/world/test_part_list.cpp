// The list of a world's parts: the order of their events, and what is a part.
#include "collision/world/world_part.hpp"

#include "collision/world/bodies_image.hpp"
#include "collision/world/pairs/pairs.hpp"
#include "collision/world/scripts.hpp"
#include "collision/world/self_contacts.hpp"
#include "collision/world/timers.hpp"
#include "collision/world/turning/tumbling.hpp"
#include "collision/world/unbounded.hpp"
#include "collision/world/wall_times.hpp"
#include "kds/audit.hpp"

#include <catch2/catch.hpp>

#include <string>
#include <tuple>
#include <utility>

namespace kds::collision::test_part_list {
namespace {

/// A part with one event, and a number as its state.
template <int number, Stage its_stage>
struct Part {
  static constexpr Stage stage = its_stage;
  double time = never;
  int state = number;
  bool bound = false;

  double next_time() const { return time; }
  bool certify() { return std::exchange(bound, false); }
  void extend_horizon() { time += 1; }
  void audit(double t) const {
    if (time < t) throw AuditFailure(std::to_string(number));
  }
  struct Image : NoImage {
    int state = 0;
  };
  Image image() const {
    Image image;
    image.state = state;
    return image;
  }
  void become(const Image& image) { state = image.state; }
};
using First = Part<1, Stage::motions>;
using Second = Part<2, Stage::boxes>;
using Third = Part<3, Stage::reported>;
using Fourth = Part<4, Stage::reported>;

// From each of these something is missing.
struct WithoutStage : First {
  static constexpr int stage = 0;
};
struct CertifiesNothing : First {
  void certify() {}
};
struct WithoutAudit : First {
  void audit() const {}
};
struct WithoutImage : First {
  void image() const {}
};
struct DoesNotCheck : First {
  struct Image {
    template <class Archive>
    void archive(Archive&) {}
  };
  Image image() const { return {}; }
  void become(const Image&) {}
};

template <class... Each>
constexpr bool all_are_parts = (WorldPart<Each, Bodies<certificates::PointMotion<2>>::Image> && ...);
template <class... Each>
constexpr bool none_is_a_part = (!WorldPart<Each, Bodies<certificates::PointMotion<2>>::Image> && ...);

using Path = certificates::PointMotion<2>;
static_assert(all_are_parts<Scripts<Path>, Tumbling<Path>, BoxTimes<detail::PairRank>, Volumes<Path>, Timers,
                            WallTimes<Path>, RestingContacts<Path>, Pairs<Path>, SelfContacts<Path>, Unbounded<Path>>);
static_assert(all_are_parts<First, Second, Third, Fourth>);
static_assert(none_is_a_part<WithoutStage, CertifiesNothing, WithoutAudit, WithoutImage, DoesNotCheck, Reports>);

static_assert(PartList<First, Second, Third, Fourth>::in_order());
static_assert(!PartList<First, Third, Second>::in_order());
static_assert(!PartList<Second, First>::in_order());
static_assert(PartList<const First, Second, Third>::place_of<First>() == 0);
static_assert(PartList<const First, Second, Third>::place_of<Third>() == 2);

struct All {
  First first;
  Second second;
  Third third;
  Fourth fourth;
  PartList<First, Second, Third, Fourth> list{first, second, third, fourth};
};

}  // namespace

TEST_CASE("parts of a world: the earliest event is next, and of those of one time that of the first in the list") {
  All all;
  CHECK(all.list.next().time == never);
  all.fourth.time = 3;
  CHECK(all.list.next().place == 3);
  all.third.time = 3;
  CHECK(all.list.next().place == 2);
  all.second.time = 4;
  CHECK(all.list.next().place == 2);
  all.first.time = 3;
  const auto due = all.list.next();
  CHECK(due.time == 3);
  CHECK(due.place == 0);
}

TEST_CASE("parts of a world: an event belongs to its stage and those after it") {
  All all;
  const auto place_at = [&](auto& part) {
    part.time = 1;
    const auto due = all.list.next();
    part.time = never;
    return due;
  };
  CHECK(place_at(all.first).is_of(Stage::motions));
  CHECK(place_at(all.first).is_of(Stage::boxes));
  CHECK_FALSE(place_at(all.second).is_of(Stage::motions));
  CHECK(place_at(all.second).is_of(Stage::boxes));
  CHECK_FALSE(place_at(all.third).is_of(Stage::boxes));
  CHECK(place_at(all.third).is_of(Stage::reported));
  CHECK(place_at(all.fourth).is_of(Stage::reported));
}

TEST_CASE("parts of a world: what is asked at a place is asked of that part alone") {
  All all;
  all.second.bound = all.third.bound = true;
  const auto certify = [](auto& part) { return part.certify(); };
  CHECK_FALSE(all.list.at(0, certify));
  CHECK(all.list.at(2, certify));
  CHECK_FALSE(all.list.at(2, certify));
  CHECK(all.second.bound);
}

TEST_CASE("parts of a world: horizons, audits and images are those of all") {
  All all;
  all.first.time = all.second.time = all.third.time = all.fourth.time = 1;
  const auto audit = [&](double t) { all.list.each([t](const auto& part) { part.audit(t); }); };
  CHECK_NOTHROW(audit(1));
  all.list.each([](auto& part) { part.extend_horizon(); });
  CHECK_NOTHROW(audit(2));
  all.third.time = 1;
  CHECK_THROWS_WITH(audit(2), "3");

  const auto images = all.list.images();
  CHECK(std::get<Second::Image>(images).state == 2);
  all.first.state = all.second.state = all.third.state = all.fourth.state = 0;
  all.list.become(images);
  CHECK(std::tuple(all.first.state, all.second.state, all.third.state, all.fourth.state) == std::tuple(1, 2, 3, 4));
}

}  // namespace kds::collision::test_part_list
