// What an answer is worth.
#pragma once

#include "tests/benchmarks/roots/truth.hpp"

#include <cstddef>
#include <vector>

namespace bench_roots {

enum class Verdict {
  right,           ///< the right crossing, or rightly none
  missed,          ///< there is one, and none was reported
  phantom,         ///< there is none, and one was reported
  wrong_crossing,  ///< another root was reported: a later or earlier crossing, a touch, or no root at all
};

struct Judgement {
  Verdict verdict = Verdict::right;
  bool crossing = false;  ///< a crossing was rightly reported, so that the following means something
  double ulps = 0;        ///< |answer - root| in spacings of the doubles at the root
  bool early = false;     ///< before the root, so that the polynomial is not negative yet
  bool enclosed = true;   ///< false if an enclosure was given and the root is not in it
};

/// An answer this far from the crossing, relative to the crossing's time, is none to that question. Generous: doubles
/// cannot place a triple root better than to 1e-5 or so, and that counts as error, in ulps, not as wrong.
inline constexpr double astray = 0x1p-10;

/// Judges the answer to "when, in [0, horizon], is the polynomial first negative just after?"; infinity is "never", as
/// is what lies beyond the horizon. NaN and times before now are answers to nothing: missed or phantom.
///
/// Right is what is nearer to the true crossing than to any other real root, and not astray; or within one spacing of
/// the doubles, which no solver in doubles can be asked to do better. Polynomials whose dip no double sees may be
/// answered either way.
Judgement judge(const Truth& truth, double horizon, double answer);

/// The same, with an enclosure to hold the answer to: the true crossing lies in [lower, upper].
Judgement judge(const Truth& truth, double horizon, double answer, double lower, double upper);

/// Judgements counted.
class Tally {
 public:
  void add(const Judgement& judgement);
  void add(const Tally& other);

  std::size_t count = 0;
  std::size_t missed = 0;
  std::size_t phantom = 0;
  std::size_t wrong_crossing = 0;
  std::size_t early = 0;
  std::size_t crossings = 0;   ///< rightly reported
  std::size_t unenclosed = 0;  ///< of them, outside the enclosure given

  std::size_t wrong() const { return missed + phantom + wrong_crossing; }
  /// Largest error of the crossings rightly reported; and what all but one in a thousand of them keep within.
  double ulps_max() const;
  double ulps_999() const;

 private:
  std::vector<double> ulps_;
};

}  // namespace bench_roots
