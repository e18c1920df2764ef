// A progress bar on standard error.
#pragma once

#include "io/events.hpp"

#include <chrono>
#include <cstdint>

namespace kds_collide {

/// Draws how far the clock has come, how many contacts there were and how long the rest will take, at most ten times
/// a second, and wipes itself away when it goes. Use it only where standard error is a terminal.
class ProgressBar final : public kds::io::EventSink {
 public:
  /// `counts`: whether it is told of all contacts; else it does not say how many there were.
  ProgressBar(double begin, double end, bool counts);
  ~ProgressBar() override;
  void on_event(const kds::io::Event& event) override;
  void on_time(double time) override;

 private:
  using Clock = std::chrono::steady_clock;

  void draw(Clock::time_point now);

  double begin_;
  double end_;
  bool counts_;
  double time_;
  std::uint64_t contacts_ = 0;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_draw_ = start_;
  bool drawn_ = false;
};

}  // namespace kds_collide
