#pragma once
// A series of frames that ParaView opens as one animation.

#include <string>
#include <vector>

namespace ergon {

// A .pvd file that names every frame added so far. It is written anew, as a whole, after each frame, so that a run that
// is broken off leaves a series that opens.
class PvdSeries {
 public:
  explicit PvdSeries(std::string path) : path_(std::move(path)) {}

  // `file` is relative to the folder of the .pvd file; `time` is in s. Throws OutputError when the file cannot be
  // written; the frame then does not belong to the series.
  void add(double time, const std::string& file);

  size_t frames() const { return frames_.size(); }

 private:
  std::string path_;
  std::vector<std::string> frames_;
};

}  // namespace ergon
