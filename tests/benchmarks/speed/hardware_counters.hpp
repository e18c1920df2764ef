// Instructions, cache misses and page faults of a stretch of a program, where the system lets it count them.
#pragma once

#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace speed {

/// What was counted, in user mode; -1 where the processor, the virtual machine or its keeper refuses.
struct HardwareCounts {
  std::int64_t instructions = -1;
  std::int64_t cache_misses = -1;  ///< of the last level
  std::int64_t page_faults = -1;
};

/// Counts from construction on, this thread alone; see perf_event_open(2). Costs nothing between its calls.
class HardwareCounters {
 public:
  HardwareCounters() {
    handles_ = {open(PERF_TYPE_HARDWARE, PERF_COUNT_HW_INSTRUCTIONS),
                open(PERF_TYPE_HARDWARE, PERF_COUNT_HW_CACHE_MISSES),
                open(PERF_TYPE_SOFTWARE, PERF_COUNT_SW_PAGE_FAULTS)};
  }
  ~HardwareCounters() {
    for (const int handle : handles_) {
      if (handle >= 0) close(handle);
    }
  }
  HardwareCounters(const HardwareCounters&) = delete;
  HardwareCounters& operator=(const HardwareCounters&) = delete;

  HardwareCounts read() const { return {value(0), value(1), value(2)}; }

 private:
  static int open(std::uint32_t type, std::uint64_t what) {
    perf_event_attr attributes;
    std::memset(&attributes, 0, sizeof attributes);
    attributes.size = sizeof attributes;
    attributes.type = type;
    attributes.config = what;
    attributes.exclude_kernel = 1;
    attributes.exclude_hv = 1;
    return static_cast<int>(syscall(SYS_perf_event_open, &attributes, 0, -1, -1, 0));
  }
  std::int64_t value(std::size_t i) const {
    std::int64_t count = -1;
    if (handles_[i] < 0 || ::read(handles_[i], &count, sizeof count) != sizeof count) return -1;
    return count;
  }

  std::array<int, 3> handles_{};
};

}  // namespace speed
