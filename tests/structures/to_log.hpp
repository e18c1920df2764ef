// Events of a kinetic structure, written down.
#pragma once

#include "kds/framework/kinetic.hpp"

#include <vector>

namespace kds::tests {

using KineticLog = std::vector<KineticEvent>;

struct ToLog {
  KineticLog* log;
  template <class Rule>
  void operator()(const Rule&, const KineticEvent& event) const {
    log->push_back(event);
  }
};

}  // namespace kds::tests
