#include "scenes/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "runtime/error.h"

namespace ergon {
namespace fs = std::filesystem;
namespace {

bool is_frame(const fs::path& path) {
  const std::string stem = path.stem().string();
  return path.extension() == ".vtu" && stem.size() >= 6 && stem.find_first_not_of("0123456789") == std::string::npos;
}

// A vector per vertex, from the order in which it is computed.
Eigen::MatrixXd in_order_of_source(const std::vector<Body>& bodies, const Eigen::Matrix3Xd& field) {
  Eigen::MatrixXd out(3, vertices_of(bodies));
  for (const Body& body : bodies) {
    for (size_t i = 0; i < body.vertex_from.size(); ++i) {
      out.col(body.first_vertex + body.vertex_from[i]) = field.col(body.first_vertex + static_cast<int>(i));
    }
  }
  return out;
}

}  // namespace

Frame frame_of(const std::vector<Body>& bodies, const State& state, const ContactForces* forces) {
  Frame frame;
  frame.time = state.time;
  frame.x = in_order_of_source(bodies, state.x);
  frame.point_data.push_back({"velocity", in_order_of_source(bodies, state.v)});
  if (forces != nullptr) {
    frame.point_data.push_back({"contact_force", in_order_of_source(bodies, forces->normal)});
    frame.point_data.push_back({"friction_force", in_order_of_source(bodies, forces->friction)});
  }
  int cells = 0;
  for (const Body& body : bodies) cells += body.mesh.cell_count();
  Field object{"object", Eigen::MatrixXd(1, cells)};
  cells = 0;
  for (size_t b = 0; b < bodies.size(); ++b) {
    const Body& body = bodies[b];
    CellBlock block{body.mesh.element, body.mesh.cells};
    for (int& node : block.nodes) node += body.first_vertex;
    frame.cells.push_back(std::move(block));
    object.values.middleCols(cells, body.mesh.cell_count()).setConstant(static_cast<double>(b));
    cells += body.mesh.cell_count();
  }
  frame.cell_data.push_back(std::move(object));
  return frame;
}

FrameWriter::FrameWriter(const std::string& folder, const std::string& name, double interval)
    : folder_(folder), name_(name), series_((fs::path(folder) / (name + ".pvd")).string()), interval_(interval) {
  const fs::path frames = fs::path(folder) / (name + "_frames");
  try {
    fs::create_directories(frames);
    std::vector<fs::path> old;
    for (const auto& entry : fs::directory_iterator(frames))
      if (is_frame(entry.path())) old.push_back(entry.path());
    for (const fs::path& path : old) fs::remove(path);
  } catch (const fs::filesystem_error& bad) {
    throw OutputError(fmt::format("{}: cannot be used for frames: {}", frames.string(), bad.code().message()));
  }
}

bool FrameWriter::due(const State& state) const { return frames_ == 0 || state.time >= interval_ * (frames_ - 1e-9); }

void FrameWriter::write(const std::vector<Body>& bodies, const State& state, const ContactForces* forces) {
  const std::string file = fmt::format("{}_frames/{:06}.vtu", name_, frames_);
  write_vtu((fs::path(folder_) / file).string(), frame_of(bodies, state, forces));
  series_.add(state.time, file);
  ++frames_;
  last_step_ = state.step;
}

}  // namespace ergon
