#include "examples/kds-collide/progress_bar.hpp"

#include <algorithm>
#include <cstdio>
#include <string>

namespace kds_collide {

using namespace kds::io;

ProgressBar::ProgressBar(double begin, double end, bool counts)
    : begin_(begin), end_(end), counts_(counts), time_(begin) {}

ProgressBar::~ProgressBar() {
  if (drawn_) std::fputs("\r\x1b[K", stderr);
}

void ProgressBar::on_event(const Event& event) {
  if (event.kind == EventKind::contact) ++contacts_;
  on_time(event.time);
}

void ProgressBar::on_time(double time) {
  time_ = time;
  const auto now = Clock::now();
  if (now < next_draw_) return;
  next_draw_ = now + std::chrono::milliseconds(100);
  draw(now);
}

void ProgressBar::draw(Clock::time_point now) {
  constexpr std::size_t width = 30;
  const double done = end_ > begin_ ? std::clamp((time_ - begin_) / (end_ - begin_), 0.0, 1.0) : 1.0;
  const auto filled = static_cast<std::size_t>(done * width);
  std::string bar;
  for (std::size_t i = 0; i < width; ++i) bar += i < filled ? "\u2588" : "\u2591";
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  std::fprintf(stderr, "\r\x1b[K%s %3.0f %%  t = %.4g s", bar.c_str(), 100 * done, time_);
  if (counts_) std::fprintf(stderr, "  %llu contacts", static_cast<unsigned long long>(contacts_));
  // Before a second is over an estimate would jump about.
  if (elapsed > 1 && done > 0) std::fprintf(stderr, "  %.0f s left", elapsed * (1 - done) / done);
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace kds_collide
