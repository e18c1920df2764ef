// Worlds of some degrees, of which there are two, and with splines five.
#include "collision/world.hpp"

template <int Degree>
void run() {
  kds::collision::World<Degree> world({});
  world.advance_to(1);
}

template <int... Degrees>
void run_all() {
  (run<Degrees>(), ...);
}
template void run_all<DEGREES>();
