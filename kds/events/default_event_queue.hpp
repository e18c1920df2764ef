// The event queue that structures use unless told otherwise.
#pragma once

#include "kds/events/calendar_queue.hpp"

namespace kds {

/// The quickest of those in this folder, by tests/benchmarks/bench_event_queue.cpp: at 6 000 slots, in the pattern of
/// a kinetic list, almost three times as fast as the d-ary heap and seven times as fast as the pairing heap. Sorted
/// lists have a queue of their own, which knows that slots are places (place_queue.hpp).
using DefaultEventQueue = CalendarQueue<>;

}  // namespace kds
