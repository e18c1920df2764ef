// The event queue that structures use unless told otherwise.
#pragma once

#include "kds/dary_queue.hpp"

namespace kds {

using DefaultEventQueue = DaryQueue<>;

}  // namespace kds
