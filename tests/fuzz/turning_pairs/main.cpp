// Random pairs of bodies that turn: whether contacts are found where conservative advancement says.
// fuzz_turning_pairs FIRST LAST [KINDS]: seeds. Fails if one is late or early, and names it.
// fuzz_turning_pairs check [KINDS]: whether times that are wrong by a little are found.
// KINDS: capsules, half-spaces or compounds.
#include "collision/narrow_phase/narrow_phase.hpp"
#include "tests/fuzz/turning_pairs/make_pair.hpp"
#include "tests/fuzz/turning_pairs/oracle.hpp"

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

using namespace turning_pairs;
using Motion = kds::certificates::RigidMotion<2>;

struct Count {
  std::uint64_t pairs = 0, contacts = 0, wrong = 0, undecided = 0, steps = 0;
};

/// When a pair meets, and what the oracle says of a time: that of its contact, or of what `change` makes of it.
template <class Change>
Verdict verdict_of(const RandomPair& pair, double* contact, int* steps, const Change& change) {
  const auto shape_a = kds::collision::place(pair.shape_a, Eigen::Quaterniond::Identity());
  const auto shape_b = kds::collision::place(pair.shape_b, Eigen::Quaterniond::Identity());
  const kds::collision::MovingShape<Motion> a{shape_a, pair.a}, b{shape_b, pair.b};
  *contact = kds::collision::first_contact(a, b, 0, pair.horizon, kds::collision::ContactMode::transparent);
  Body body_a = body_of(pair.a), body_b = body_of(pair.b);
  body_a.pieces = pair.pieces_a, body_b.pieces = pair.pieces_b;
  return check(body_a, body_b, 0, pair.horizon, change(*contact), steps);
}

void check_seed(std::uint64_t seed, Kinds kinds, std::array<Count, families>& counts) {
  const RandomPair pair = make_pair(seed, kinds);
  double contact = 0;
  int steps = 0;
  const Verdict verdict = verdict_of(pair, &contact, &steps, [](double t) { return t; });
  Count& count = counts[pair.family];
  ++count.pairs;
  count.contacts += contact <= pair.horizon;
  count.steps += static_cast<std::uint64_t>(steps);
  count.undecided += verdict == Verdict::undecided;
  if (verdict != Verdict::late && verdict != Verdict::early) return;
  ++count.wrong;
  std::printf("seed %llu (%s): the contact at %.17g is %s\n", static_cast<unsigned long long>(seed),
              family_names[pair.family], contact, verdict == Verdict::late ? "late" : "early");
}

/// Contacts that are said to be later or earlier by a 10^8th. Where bodies slide on each other before or after, there
/// is nothing wrong with that.
int check_wrong_times(Kinds kinds) {
  int moved = 0, late = 0, early = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const RandomPair pair = make_pair(seed, kinds);
    double contact = 0;
    int steps = 0;
    if (verdict_of(pair, &contact, &steps, [](double t) { return t; }) != Verdict::right) continue;
    if (!(contact > 0 && contact < 0.5 * pair.horizon)) continue;
    ++moved;
    late += verdict_of(pair, &contact, &(steps = 0), [](double t) { return t * (1 + 1e-8); }) == Verdict::late;
    early += verdict_of(pair, &contact, &(steps = 0), [](double t) { return t * (1 - 1e-8); }) == Verdict::early;
  }
  std::printf("%d contacts moved: %d of them found late, %d early\n", moved, late, early);
  return moved >= 40 && 10 * late >= 9 * moved && 10 * early >= 9 * moved ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  struct Named {
    const char* name;
    Kinds kinds;
  };
  constexpr std::array others{Named{"capsules", Kinds::capsules}, Named{"half-spaces", Kinds::half_spaces},
                              Named{"compounds", Kinds::compounds}};
  Kinds kinds = Kinds::usual;
  std::string with;
  for (const Named& other : others) {
    if (argc < 2 || std::strcmp(argv[argc - 1], other.name) != 0) continue;
    kinds = other.kinds;
    with = std::string(", with ") + other.name;
  }
  if (kinds != Kinds::usual) --argc;
  if (argc == 2 && std::strcmp(argv[1], "check") == 0) return check_wrong_times(kinds);
  if (argc != 3) {
    return std::puts("fuzz_turning_pairs FIRST LAST [KINDS] | check [KINDS]: capsules, half-spaces or compounds"), 2;
  }
  const std::uint64_t first = std::strtoull(argv[1], nullptr, 10), last = std::strtoull(argv[2], nullptr, 10);
  std::array<Count, families> counts{};
  for (std::uint64_t seed = first; seed <= last; ++seed) check_seed(seed, kinds, counts);
  Count all;
  std::printf("seeds %llu to %llu%s\n", static_cast<unsigned long long>(first), static_cast<unsigned long long>(last),
              with.c_str());
  for (std::size_t i = 0; i < families; ++i) {
    const Count& c = counts[i];
    std::printf("%-30s %8llu pairs, %8llu meet, %llu wrong, %llu undecided, %.1f steps a pair\n", family_names[i],
                static_cast<unsigned long long>(c.pairs), static_cast<unsigned long long>(c.contacts),
                static_cast<unsigned long long>(c.wrong), static_cast<unsigned long long>(c.undecided),
                c.pairs ? static_cast<double>(c.steps) / static_cast<double>(c.pairs) : 0.0);
    all.pairs += c.pairs, all.wrong += c.wrong, all.undecided += c.undecided;
  }
  // What slides at a distance of a rounding takes the oracle for ever: few do.
  return all.wrong == 0 && 20 * all.undecided <= all.pairs ? 0 : 1;
}
