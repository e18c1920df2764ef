// A world of some degree, of which there are two, and with splines five.
#include "collision/world.hpp"

void run() {
  kds::collision::World<DEGREE> world({});
  world.advance_to(1);
}
