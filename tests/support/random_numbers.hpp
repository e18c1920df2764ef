// Random numbers for tests: those that the library offers its users.
#pragma once

#include "kds/testing/random.hpp"

namespace kds::tests {
using testing::Random;
}  // namespace kds::tests
