// A trial of a kinetic structure: all that its author would test of it, in one call.
#pragma once

#include "kds/framework/kinetic.hpp"
#include "kds/framework/reverse.hpp"
#include "kds/framework/snapshot.hpp"
#include "kds/number_text.hpp"
#include "kds/simulator.hpp"
#include "kds/testing/random.hpp"
#include "kds/testing/random_motions.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace kds::testing {

/// What a trial of a structure consists of.
struct TrialOptions {
  std::uint64_t seed = 1;
  Kind kind = Kind::generic;
  int steps = 20;          ///< each some time without edits, and an edit
  std::size_t first = 8;   ///< elements at the beginning
  std::size_t most = 16;   ///< elements
  double window = never;   ///< of the simulator, in seconds
  std::size_t one_in = 1;  ///< states after events of which one is checked; those after edits all are
  bool backwards = true;   ///< in the end, run back in time and forward again, where elements can
};

/// What a trial has found. A right structure has nothing wrong; events and states tell whether it was tried at all.
struct Findings {
  std::vector<KineticEvent> events{};  ///< of all structures
  std::uint64_t states = 0;            ///< that were checked
  std::uint64_t wrong = 0;
  std::string first{};  ///< the first that was wrong, in words

  bool right() const { return wrong == 0; }
};

/// No edits of the rule itself.
struct NoRuleEdits {
  template <class Structure>
  void operator()(Structure& /*structure*/, Random& /*random*/, double /*now*/) const {}
};

/// Runs a structure made of `rule` on random elements through random edits, and checks it. If the rule stands on others
/// (StandsOn), structures of these are made too, one of each rule, default-constructed, on the same elements.
///
/// `make(random, kind, now)` gives an element that moves about its place at `now` (random_motions.hpp). `check(rule,
/// elements, now)` compares the state with brute force, when all events of a time are over, and gives the number of
/// things that are wrong. `edit(structure, random, now)`, if given, may change the rule by Kinetic::edit(). All must be
/// functions of their arguments: the run is repeated.
///
/// Elements come, go, jump, turn, restart where they are, and are given the motion of another, so that the two stay at
/// one place. After every event and edit all certificates and failure times are audited with exact signs (so a wrong
/// certificate is found when it is made). Half way a snapshot is taken; the second half is run twice from it, and must
/// give the same events and end in the same bytes. In the end, if elements are Reversible, time runs back for a while
/// and forward again, with the same checks. What the structure throws counts as wrong.
template <class Rule, class Make, class Check, class Edit = NoRuleEdits>
Findings try_rule(const TrialOptions& options, const Rule& rule, const Make& make, const Check& check,
                  const Edit& edit = {});

// ---------------------------------------------------------------------------------------------------------------

namespace detail {

/// Writes events down.
struct Recorder {
  std::vector<KineticEvent>* events;
  template <class Rule>
  void operator()(const Rule& /*rule*/, const KineticEvent& event) const {
    events->push_back(event);
  }
};

/// Adds to a list of rules, std::tuple<Rules...>, a rule and before it those that it stands on, each once.
template <class List, class Rule>
struct With;
template <class List, class... Rules>
struct WithAll {
  using type = List;
};
template <class List, class First, class... Others>
struct WithAll<List, First, Others...> : WithAll<typename With<List, First>::type, Others...> {};
template <class List, class Base>
struct WithInners {
  using type = List;
};
template <class List, class... Inners>
struct WithInners<List, StandsOn<Inners...>> : WithAll<List, typename kds::detail::Told<Inners>::Rule...> {};
template <class List, class Rule>
struct BelowOf {
  using type = List;
};
template <class List, OuterRule Rule>
struct BelowOf<List, Rule> : WithInners<List, decltype(kds::detail::standing(std::declval<const Rule&>()))> {};
template <class List, class Rule>
struct Appended;
template <class... Rules, class Rule>
struct Appended<std::tuple<Rules...>, Rule> {
  using type =
      std::conditional_t<(std::is_same_v<Rules, Rule> || ...), std::tuple<Rules...>, std::tuple<Rules..., Rule>>;
};
template <class List, class Rule>
struct With : Appended<typename BelowOf<List, Rule>::type, Rule> {};

/// A structure made of a rule, and those that it stands on: one of each rule, however many stand on it.
template <class Rule, class List = typename With<std::tuple<>, Rule>::type>
class Tower;
template <class Rule, class... Rules>
class Tower<Rule, std::tuple<Rules...>> {
 public:
  Tower(MovingSet<typename Rule::Element>& elements, double now, const Rule& rule, Recorder recorder) {
    (make<Rules>(elements, now, rule, recorder), ...);
  }
  Kinetic<Rule, Recorder>& top() { return of<Rule>(); }
  auto structures() { return std::tie(of<Rules>()...); }

 private:
  template <class R>
  Kinetic<R, Recorder>& of() {
    return *std::get<std::optional<Kinetic<R, Recorder>>>(structures_);
  }
  template <class R>
  void make(MovingSet<typename Rule::Element>& elements, double now, const Rule& rule, Recorder recorder) {
    auto& structure = std::get<std::optional<Kinetic<R, Recorder>>>(structures_);
    // The inner rules are made without arguments.
    const auto own_rule = [&] {
      if constexpr (std::is_same_v<R, Rule>) {
        return rule;
      } else {
        return R{};
      }
    };
    if constexpr (OuterRule<R>) {
      const auto on = [&]<class... Inners>(const StandsOn<Inners...>*) {
        return typename kds::detail::Standing<R>::Structures(of<typename kds::detail::Told<Inners>::Rule>()...);
      };
      structure.emplace(on(static_cast<const R*>(nullptr)), now, own_rule(), recorder);
    } else {
      structure.emplace(elements, now, own_rule(), recorder);
    }
  }

  std::tuple<std::optional<Kinetic<Rules, Recorder>>...> structures_;
};

template <class Element>
Element restarted_at(const Element& element, double t) {
  if constexpr (requires { element.restarted(t); }) {
    return element.restarted(t);
  } else if constexpr (requires { restarted(element, t); }) {
    return restarted(element, t);
  } else {
    return element;
  }
}

template <class Rule, class Make, class Check, class Edit>
class Trial {
  using Element = typename Rule::Element;

 public:
  Trial(const TrialOptions& options, const Rule& rule, const Make& make, const Check& check, const Edit& edit)
      : options_(options), rule_(rule), make_(make), check_(check), edit_(edit) {}

  Findings run() {
    try {
      run_all();
    } catch (const std::exception& error) {
      found(error.what());
    }
    findings_.events = std::move(events_);
    return std::move(findings_);
  }

 private:
  void run_all() {
    Random random(options_.seed);
    const double start = beginning(options_.kind);
    for (std::size_t i = 0; i < options_.first; ++i) {
      set_.insert(static_cast<Id>(2 * i), make_(random, options_.kind, start), start);
    }
    Tower<Rule> tower(set_, start, rule_, Recorder{&events_});
    auto simulator =
        std::apply([&](auto&... structures) { return Simulator(start, structures...); }, tower.structures());
    if (options_.window < never) simulator.set_window(options_.window);
    look_at(tower, simulator);
    go_on(tower, simulator, 1, options_.steps / 2);
    const Snapshot middle = save(simulator, set_);
    const std::size_t before = events_.size();
    go_on(tower, simulator, 2, options_.steps / 2);
    const std::vector<KineticEvent> events(events_.begin() + static_cast<std::ptrdiff_t>(before), events_.end());
    const Snapshot end = save(simulator, set_);
    events_.resize(before);
    restore(middle, simulator, set_);
    go_on(tower, simulator, 2, options_.steps / 2);
    const auto again = events_.begin() + static_cast<std::ptrdiff_t>(before);
    if (!std::equal(events.begin(), events.end(), again, events_.end())) found("another run has other events");
    if (save(simulator, set_) != end) found("another run ends in another state");
    if constexpr (Reversible<Element>) {
      if (options_.backwards) go_back(tower, simulator);
    }
  }

  template <class AnySimulator>
  void go_on(Tower<Rule>& tower, AnySimulator& simulator, std::uint64_t part, int steps) {
    Random random(options_.seed + part);
    for (int step = 0; step < steps; ++step) {
      advance(tower, simulator, simulator.now() + random_delay(random, options_.kind));
      edit_something(random, simulator.now());
      edit_(tower.top(), random, simulator.now());
      look_at(tower, simulator);
    }
  }

  /// To a time, with a look at the states between events.
  template <class AnySimulator>
  void advance(Tower<Rule>& tower, AnySimulator& simulator, double target) {
    while (simulator.step(target)) {
      simulator.audit();
      if (simulator.next_time() > simulator.now() && events_.size() % options_.one_in == 0) look_at(tower, simulator);
      if (events_.size() > most_events) throw std::runtime_error("there are more than 100 000 events");
    }
    simulator.advance_to(target);
  }

  template <class AnySimulator>
  void look_at(Tower<Rule>& tower, AnySimulator& simulator) {
    simulator.audit();
    if (simulator.next_time() <= simulator.now()) return;
    ++findings_.states;
    const auto wrong = static_cast<std::uint64_t>(check_(tower.top().rule(), std::as_const(set_), simulator.now()));
    if (wrong != 0) found("the state at " + number_text(simulator.now()) + " is wrong");
    findings_.wrong += wrong - (wrong != 0);
  }

  /// A second back and forth again: there are no edits in between.
  template <class AnySimulator>
  void go_back(Tower<Rule>& tower, AnySimulator& simulator) {
    for (int turn = 0; turn < 2; ++turn) {
      reverse(simulator, set_);
      advance(tower, simulator, simulator.now() + 1);
      look_at(tower, simulator);
    }
  }

  void edit_something(Random& random, double now) {
    const std::size_t choice = random.below(5);
    const std::vector<Id> ids = set_.ids();
    if (ids.empty() || (choice == 0 && ids.size() < options_.most)) {
      Id id = 0;
      do id = static_cast<Id>(random.below(2 * options_.most));
      while (set_.contains(id));
      set_.insert(id, !ids.empty() && random.one_in(4) ? set_[ids.front()] : make_(random, options_.kind, now), now);
      return;
    }
    const Id id = ids[random.below(ids.size())];
    if (choice == 1) return set_.remove(id, now);
    if (choice == 2) return set_.update(id, set_[ids[random.below(ids.size())]], now);
    if (choice == 3) return set_.update(id, restarted_at(set_[id], now), now);
    set_.update(id, make_(random, options_.kind, now), now);
  }

  void found(const std::string& what) {
    if (findings_.wrong++ > 0) return;
    findings_.first = "seed " + std::to_string(options_.seed) + ": " + Rule::name + ": " + what;
  }

  static constexpr std::size_t most_events = 100000;

  const TrialOptions& options_;
  const Rule& rule_;
  const Make& make_;
  const Check& check_;
  const Edit& edit_;
  MovingSet<Element> set_;
  std::vector<KineticEvent> events_;
  Findings findings_;
};

}  // namespace detail

template <class Rule, class Make, class Check, class Edit>
Findings try_rule(const TrialOptions& options, const Rule& rule, const Make& make, const Check& check,
                  const Edit& edit) {
  return detail::Trial<Rule, Make, Check, Edit>(options, rule, make, check, edit).run();
}

}  // namespace kds::testing
