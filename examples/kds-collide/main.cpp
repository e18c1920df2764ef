// kds-collide: a scene in, events out.
#include "examples/kds-collide/tool.hpp"

int main(int argc, char** argv) { return kds_collide::run_tool(argc, argv, "kds-collide"); }
