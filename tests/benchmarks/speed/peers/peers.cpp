#include "tests/benchmarks/speed/peers/peers.hpp"

#ifdef KDS_PEER_BULLET
#include "tests/benchmarks/speed/peers/bullet.hpp"
#endif
#ifdef KDS_PEER_FCL
#include "tests/benchmarks/speed/peers/fcl.hpp"
#endif

namespace speed {

std::vector<Peer> peers() {
  std::vector<Peer> list;
#ifdef KDS_PEER_BULLET
  add_bullet(list);
#endif
#ifdef KDS_PEER_FCL
  add_fcl(list);
#endif
  return list;
}

std::vector<const char*> missing_peers() {
  std::vector<const char*> list;
#ifndef KDS_PEER_BULLET
  list.push_back("Bullet (libbullet-dev)");
#endif
#ifndef KDS_PEER_FCL
  list.push_back("FCL (libfcl-dev)");
#endif
  return list;
}

}  // namespace speed
