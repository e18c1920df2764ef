// The list of the examples, with all its events written down.
#pragma once

#include "examples/list_in_forty_lines.hpp"
#include "kds/framework/kinetic.hpp"

#include <vector>

namespace kds::tests {

using Log = std::vector<KineticEvent>;

struct ToLog {
  Log* log;
  template <class Rule>
  void operator()(const Rule&, const KineticEvent& event) const {
    log->push_back(event);
  }
};

template <int Degree, class Queue = DefaultEventQueue>
using List = Kinetic<examples::ListRule<Motion<Degree>>, ToLog, Queue>;

}  // namespace kds::tests
