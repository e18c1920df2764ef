// A world of some degree, of which there are two.
#include "collision/world.hpp"

void run() {
  kds::collision::World<DEGREE> world({});
  world.advance_to(1);
}
