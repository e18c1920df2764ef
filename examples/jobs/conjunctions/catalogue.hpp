// Made-up catalogues of satellites.
#pragma once

#include "examples/jobs/conjunctions/orbit.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace conjunctions {

/// A catalogue with the proportions of the real one: of ten objects
/// - six are fragments and satellites in low orbits, 400 to 1 600 km high, most of them near 550, 800 and 1 400 km,
///   inclined by 50 to 100 degrees, of eccentricities below 0.02;
/// - two belong to a constellation: circular, 500 to 600 km high, inclined by 53 degrees, in planes at
///   even distances;
/// - one is on an elongated orbit, perigee 250 to 1 000 km high, apogee up to 20 000 km;
/// - one is higher up, half of these near the geostationary ring.
/// Nodes, perigees and anomalies are random. The same number and seed give the same elements on every system.
std::vector<Elements> made_up_catalogue(std::size_t objects, std::uint64_t seed);

/// Objects in one thin shell, 10 km thick, at random inclinations: many conjunctions among few.
std::vector<Elements> dense_shell(std::size_t objects, std::uint64_t seed);

}  // namespace conjunctions
