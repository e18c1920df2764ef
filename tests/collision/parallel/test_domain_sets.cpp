#include "collision/parallel/domain_sets.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <vector>

namespace kds::collision::test_domain_sets {
namespace {

using kds::tests::Random;
using Members = std::vector<DomainIndex>;

Members drawn(Random& random, std::size_t domains, std::size_t most) {
  std::set<DomainIndex> members;
  for (std::size_t n = random.below(most + 1); n > 0; --n)
    members.insert(static_cast<DomainIndex>(random.below(domains)));
  return {members.begin(), members.end()};
}

}  // namespace

TEST_CASE("Domain sets: one number for each, whatever is asked in between", "[parallel]") {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    INFO("seed " << seed);
    Random random(seed);
    const std::size_t domains = 1 + random.below(random.one_in(2) ? 5 : 1000);
    DomainSets sets(domains);
    std::map<Members, DomainSets::Number> numbers;
    for (int i = 0; i < 2000; ++i) {
      const Members members = drawn(random, domains, random.one_in(10) ? 60 : 4);
      const DomainSets::Number number = sets.number_of(members);
      const auto [known, fresh] = numbers.try_emplace(members, number);
      REQUIRE(known->second == number);
      if (members.size() == 1) REQUIRE(number == members[0]);
    }
    std::set<DomainSets::Number> different;
    for (const auto& [members, number] : numbers) {
      REQUIRE(std::ranges::equal(sets[number], members));
      different.insert(number);
    }
    REQUIRE(different.size() == numbers.size());
    REQUIRE(sets.size() >= domains);
    REQUIRE(sets.size() <= domains + numbers.size());
  }
}

TEST_CASE("Domain sets: as many domains as there can be, and all of them in one set", "[parallel]") {
  DomainSets sets(most_domains);
  Members all(most_domains);
  std::iota(all.begin(), all.end(), DomainIndex{0});
  CHECK(sets[65534].front() == 65534);
  const auto number = sets.number_of(all);
  CHECK(number == most_domains);
  CHECK(std::ranges::equal(sets[number], all));
  CHECK(sets.number_of({}) == most_domains + 1);
  CHECK(sets.number_of(all) == number);
  CHECK(std::ranges::find(all, no_domain) == all.end());
}

}  // namespace kds::collision::test_domain_sets
