#pragma once
// The frames of a scene: all bodies in one grid, each in the order in which its mesh was read, so that a frame's points
// and cells are those of the source.

#include <string>

#include "runtime/output/pvd.h"
#include "runtime/output/vtu.h"
#include "runtime/solver/time_step.h"
#include "scenes/body.h"

namespace ergon {

// With forces: point data contact_force and friction_force, N.
Frame frame_of(const std::vector<Body>& bodies, const State& state, const ContactForces* forces = nullptr);

// Writes NAME.pvd and NAME_frames/000000.vtu, 000001.vtu ... into a folder.
class FrameWriter {
 public:
  // Removes the frames of an earlier run from NAME_frames. Throws OutputError when that is not possible.
  FrameWriter(const std::string& folder, const std::string& name, double interval);

  // True when the state's time has reached that of the next frame. `interval` 0: always.
  bool due(const State& state) const;
  void write(const std::vector<Body>& bodies, const State& state, const ContactForces* forces = nullptr);

  int frames() const { return frames_; }
  long last_step() const { return last_step_; }  // -1 before the first frame

 private:
  std::string folder_;
  std::string name_;
  PvdSeries series_;
  double interval_;  // s
  int frames_ = 0;
  long last_step_ = -1;
};

}  // namespace ergon
