#include "tests/fuzz/random_worlds/log.hpp"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <sstream>

namespace kds::fuzz {
namespace {

bool same(double x, double y) { return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y); }
bool same(const Vector3d& x, const Vector3d& y) { return same(x[0], y[0]) && same(x[1], y[1]) && same(x[2], y[2]); }

std::string number(double x, bool exactly) {
  char letters[64];
  std::snprintf(letters, sizeof letters, exactly ? "%a" : "%.17g", x);
  return letters;
}

std::string_view kind_at(const std::vector<Line>& lines, std::size_t at) {
  return at < lines.size() ? line_names[static_cast<std::size_t>(lines[at].kind)] : "nothing";
}
std::string line_at(const std::vector<Line>& lines, std::size_t at) {
  return at < lines.size() ? shown(lines[at]) : "nothing";
}

}  // namespace

bool same(const Line& x, const Line& y) {
  const Contact& c = x.contact;
  const Contact& d = y.contact;
  return x.kind == y.kind && x.a == y.a && x.b == y.b && same(c.time, d.time) && same(c.point, d.point) &&
         same(c.normal, d.normal) && c.feature_a == d.feature_a && c.feature_b == d.feature_b && x.text == y.text;
}

std::string shown(const Line& line, bool exactly) {
  std::ostringstream out;
  out << line_names[static_cast<std::size_t>(line.kind)] << ' ' << line.a << ' ' << line.b << " at "
      << number(line.contact.time, exactly);
  if (exactly) out << " (" << number(line.contact.time, false) << ')';
  out << " point";
  for (const double x : line.contact.point) out << ' ' << number(x, exactly);
  out << " normal";
  for (const double x : line.contact.normal) out << ' ' << number(x, exactly);
  out << ' ' << line.contact.feature_a << ' ' << line.contact.feature_b << ' ' << line.text;
  return out.str();
}

Difference compare(const std::vector<Line>& found, const std::vector<Line>& expected, std::size_t most) {
  const std::size_t compared = std::min(most, std::max(found.size(), expected.size()));
  Difference result;
  for (std::size_t i = 0; i < compared; ++i) {
    if (i < found.size() && i < expected.size() && same(found[i], expected[i])) continue;
    result.any = true;
    result.at = i;
    result.what = std::string(kind_at(found, i)) + " for " + std::string(kind_at(expected, i));
    result.text = "  found    " + line_at(found, i) + "\n  expected " + line_at(expected, i) + "\n";
    return result;
  }
  return result;
}

}  // namespace kds::fuzz
