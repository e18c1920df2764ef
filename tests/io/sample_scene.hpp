// A scene that uses what the format has.
#pragma once

namespace kds::io::tests {

/// An OBJ file.
inline constexpr const char* tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// It needs the file ring.obj beside it.
inline constexpr const char* valid_scene = R"({
  "scene": 1,
  "end_time": 1.0,
  "response": "none",
  "domain": {"min": [0,0,0], "max": [80,80,80], "walls": "reflect"},
  "meshes": {"ring": {"file": "ring.obj"}},
  "bodies": [
    {"name": "a", "shape": {"sphere": {"radius": 1.0}},
     "motion": [{"start": 0.0, "position": [[10,10,10], [0.5,0,0], [0,0,-4.9]]}]},
    {"name": "b", "shape": {"box": {"half_extents": [1,2,3]}}, "mass": 2.0,
     "motion": [{"start": 0.0, "position": [[20,10,10], [-0.5,0,0]]}]},
    {"name": "c", "shape": {"mesh": "ring", "scale": 2.0}, "orientation": [0.6,0.8,0,0], "fixed": true,
     "motion": [{"start": 0.0, "position": [[30,10,10]]}, {"start": 0.5, "position": [[30,10,10], [0,1,0]]}]}
  ]
})";

}  // namespace kds::io::tests
