// A hash of everything an event log says, bit for bit, and the log itself in hexadecimal for when hashes differ.
#pragma once

#include "collision/shapes/feature.hpp"
#include "tests/collision/event_log.hpp"

#include <bit>
#include <cstdint>
#include <cstdio>

namespace kds::replay {

/// FNV-1a over 64-bit words, lowest byte first: the same on every machine.
class EventHash {
 public:
  /// With `print`, every record goes to standard output as well, a line each.
  explicit EventHash(bool print) : print_(print) {}

  void number(double x) {
    word(std::bit_cast<std::uint64_t>(x));
    if (print_) std::printf(" %a", x);
  }
  void integer(std::uint64_t x) {
    word(x);
    if (print_) std::printf(" %llu", static_cast<unsigned long long>(x));
  }
  void end_record() {
    ++records_;
    if (print_) std::printf("\n");
  }

  void event(const collision::tests::Event& e) {
    integer(static_cast<std::uint64_t>(e.kind));
    integer(e.a);
    integer(e.b);
    number(e.contact.time);
    for (int d = 0; d < 3; ++d) number(e.contact.point[d]);
    for (int d = 0; d < 3; ++d) number(e.contact.normal[d]);
    feature(e.contact.feature_a);
    feature(e.contact.feature_b);
    end_record();
  }

  std::uint64_t value() const { return hash_; }
  std::uint64_t records() const { return records_; }

 private:
  void feature(const collision::Feature& f) {
    integer(static_cast<std::uint64_t>(f.kind));
    integer(f.first);
    integer(f.second);
  }

  void word(std::uint64_t x) {
    for (int byte = 0; byte < 8; ++byte, x >>= 8) hash_ = (hash_ ^ (x & 0xff)) * 0x100000001b3;
  }

  std::uint64_t hash_ = 0xcbf29ce484222325;
  std::uint64_t records_ = 0;
  bool print_;
};

}  // namespace kds::replay
