// A kinetic sorted list under any sequence of operations against the exact order of its motions.
#include "kds/events/calendar_queue.hpp"
#include "kds/events/dary_queue.hpp"
#include "kds/events/pairing_queue.hpp"
#include "kds/simulator.hpp"
#include "structures/sorted_list.hpp"
#include "tests/fuzz/bytes.hpp"
#include "tests/fuzz/check.hpp"
#include "tests/structures/random_values.hpp"
#include "tests/structures/rule_list.hpp"

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::fuzz {
namespace {

/// At most so many elements and operations: the exact model costs their product.
constexpr std::uint32_t most_elements = 12;
constexpr int most_operations = 200;
/// And so many events: parabolas that nearly agree swap often.
constexpr std::uint64_t most_events = 2000;

std::uint32_t rank_of(std::uint32_t id) { return id % 3; }

struct Listener {
  std::uint64_t* swaps;
  void swapped(std::uint32_t, std::uint32_t, double) { ++*swaps; }
  static std::uint32_t rank(std::uint32_t id) { return rank_of(id); }
};

template <int Degree, class List>
class Scenario {
 public:
  explicit Scenario(Bytes& bytes)
      : bytes_(bytes),
        start_(bytes.one_in(4) ? 1e9 : 0),
        wide_(bytes.one_in(4)),
        list_(Listener{&swaps_}),
        simulator_(start_, list_) {}

  void run() {
    for (int i = 0; i < most_operations && !bytes_.empty() && list_.counters().events < most_events; ++i) {
      operation();
      check();
    }
  }

 private:
  Motion<Degree> motion() {
    Motion<Degree> motion;
    // Wide numbers may overflow nowhere in the exact signs' double filter: 60 bits apart, of degree 3.
    for (double& c : motion.position.c) c = wide_ && bytes_.one_in(2) ? bytes_.wide(60) : bytes_.number();
    motion.start = simulator_.now() + (bytes_.one_in(2) ? bytes_.number() : 0);
    return motion;
  }

  bool known(std::uint32_t id) const { return model_.motions.contains(id); }

  void operation() {
    const double now = simulator_.now();
    const auto id = static_cast<std::uint32_t>(bytes_.below(most_elements));
    switch (bytes_.below(10)) {
      case 0:
      case 1:  // insert, or refuse to
        if (known(id)) {
          refuses<std::invalid_argument>([&] { list_.insert(id, motion(), now); });
        } else {
          model_.motions[id] = motion();
          list_.insert(id, model_.motions[id], now);
        }
        break;
      case 2:
        if (known(id)) {
          model_.motions.erase(id);
          list_.remove(id, now);
        } else {
          refuses<std::out_of_range>([&] { list_.remove(id, now); });
        }
        break;
      case 3:  // jump
        change(id, motion());
        break;
      case 4:  // turn round on the spot
        if (known(id)) {
          Motion<Degree> turned = restarted(model_.motions[id], now);
          turned.position.c[1] = -turned.position.c[1];
          change(id, turned);
        }
        break;
      case 5: {  // move as another
        const auto other = static_cast<std::uint32_t>(bytes_.below(most_elements));
        if (known(other)) change(id, model_.motions[other]);
        break;
      }
      case 6: {
        Motion<Degree> broken = motion();
        broken.position.c[bytes_.below(Degree + 1)] = std::numeric_limits<double>::quiet_NaN();
        refuses<std::exception>([&] { list_.update(id, broken, now); });
        break;
      }
      case 7:
        simulator_.step(now + 1);
        break;
      case 8:
        advance(now + std::abs(bytes_.number()));
        break;
      default:
        simulator_.set_window(bytes_.one_in(4) ? never : 0.125 + std::abs(bytes_.number()));
    }
  }

  void change(std::uint32_t id, const Motion<Degree>& motion) {
    if (!known(id)) return refuses<std::out_of_range>([&] { list_.update(id, motion, simulator_.now()); });
    model_.motions[id] = motion;
    list_.update(id, motion, simulator_.now());
  }

  void advance(double target) {
    while (simulator_.step(target)) {
      check();
      if (list_.counters().events >= most_events) return;
    }
    simulator_.advance_to(target);
  }

  template <class Error, class F>
  void refuses(F&& f) {
    try {
      f();
    } catch (const Error&) {
      return;
    }
    throw Failure("what is wrong was not refused");
  }

  void check() const {
    const double now = simulator_.now();
    list_.audit(now);
    require(list_.size() == model_.motions.size(), "the list's size is wrong");
    // While swaps of this instant are due the order is that of a moment before.
    if (simulator_.next_time() == now) return;
    const auto expected = model_.order(now, rank_of);
    std::size_t place = 0;
    for (const auto& entry : list_.entries()) {
      require(entry.id == expected[place], "place " + std::to_string(place) + " holds " + std::to_string(entry.id) +
                                               ", not " + std::to_string(expected[place]));
      require(list_.position(entry.id) == place, "a position is wrong");
      require(entry.motion == model_.motions.at(entry.id), "a motion is wrong");
      ++place;
    }
  }

  Bytes& bytes_;
  double start_;
  bool wide_;
  std::uint64_t swaps_ = 0;
  List list_;
  Simulator<List> simulator_;
  tests::Model<Degree> model_;
};

/// The tuned list, or one made of a rule with some queue.
template <int Degree>
void run_a_list(Bytes& bytes) {
  switch (bytes.below(4)) {
    case 0:
      return Scenario<Degree, tests::RuleList<Degree, Listener, CalendarQueue<>>>(bytes).run();
    case 1:
      return Scenario<Degree, tests::RuleList<Degree, Listener, DaryQueue<>>>(bytes).run();
    case 2:
      return Scenario<Degree, tests::RuleList<Degree, Listener, PairingQueue<>>>(bytes).run();
    default:
      return Scenario<Degree, structures::SortedList<Degree, Listener>>(bytes).run();
  }
}

}  // namespace

void run(std::span<const std::uint8_t> input) {
  Bytes bytes(input);
  switch (bytes.below(3)) {
    case 0:
      return run_a_list<1>(bytes);
    case 1:
      return run_a_list<2>(bytes);
    default:
      return run_a_list<3>(bytes);
  }
}

}  // namespace kds::fuzz
