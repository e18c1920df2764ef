// A run as a series of surfaces in the XML formats of VTK, for ParaView and its like.
#pragma once

#include "io/output_file.hpp"
#include "io/replay.hpp"
#include "io/scene.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace kds::io {

/// The bodies of a run as they are at any time, each a surface of triangles.
class VtkFrames {
 public:
  /// Both must outlive this.
  VtkFrames(const Scene& scene, const Record& record);
  ~VtkFrames();
  VtkFrames(const VtkFrames&) = delete;
  VtkFrames& operator=(const VtkFrames&) = delete;

  /// The text of a .vtp file (PolyData) of time t (s): the surfaces of the bodies that are there then, in 32-bit floats
  /// and the units of the scene; for each triangle the place of its body in the scene, `body`, whether that is a
  /// sensor, `sensor`, 1 or 0, and the velocity of its centre, `velocity`; and t, `TimeValue`. Where a body jumps at t,
  /// it is where it comes to.
  std::string at(double t) const;
  /// Corners of triangles in a frame that has all bodies.
  std::size_t corners() const;

 private:
  struct Body;

  Scene scene_;  ///< of shapes that have surfaces
  std::vector<Body> bodies_;
};

/// Whether a series can have this name, which ends in `.pvd`, and the folder that its frames are in.
bool is_series_name(const std::string& path);
std::filesystem::path frames_folder(const std::string& path);

/// A .pvd file, which lists the times, and the frames in frames_folder(), which is beside it and has its name with the
/// ending `.frames`: frame_0.vtp, frame_1.vtp, ... Frames are written by write() into a temporary folder; commit() puts
/// that in its place, and then the list, so that a list which is there has all its frames. Destroyed without commit(),
/// both are removed. A folder of that name that was there is replaced if there is nothing in it but frames, else
/// refused. (A process that is stopped while it writes frames leaves the temporary folder.)
class VtkSeries {
 public:
  /// Throws std::invalid_argument unless is_series_name(), and OutputError for what cannot be written.
  explicit VtkSeries(const std::string& path);
  ~VtkSeries();
  VtkSeries(const VtkSeries&) = delete;
  VtkSeries& operator=(const VtkSeries&) = delete;

  /// Frames at the beginning of the scene, so many times a second from then on, and at its end. Throws
  /// std::invalid_argument unless frames_per_second is finite and > 0, std::length_error where there would be more than
  /// a thousand million corners of triangles in all, and OutputError.
  void write(const Scene& scene, const Record& record, double frames_per_second = 60);
  void close();
  void commit();

 private:
  std::string path_;
  std::filesystem::path folder_, temporary_;
  OutputFile list_;
};

}  // namespace kds::io
