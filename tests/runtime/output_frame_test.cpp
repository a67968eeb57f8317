// .vtu and .pvd files, read back by VTK's own reader. A missing reader is a failure.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <random>

#include "runtime/error.h"
#include "runtime/mesh/mesh_build.h"
#include "runtime/output/pvd.h"
#include "runtime/output/vtu.h"
#include "tests/paths.h"
#include "tests/runtime/temporary_folder.h"

namespace ergon {
namespace {

struct Outcome {
  int status = -1;
  std::string output;
};

Outcome run_reader(const std::string& arguments) {
  // The system's interpreter: the one that the package python3-vtk9 serves.
  const std::string command =
      "/usr/bin/python3 " + test::source("/tests/runtime/read_vtu.py") + " " + arguments + " 2>&1";
  Outcome outcome;
  std::FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return outcome;
  char buffer[4096];
  while (const size_t count = std::fread(buffer, 1, sizeof buffer, pipe)) outcome.output.append(buffer, count);
  const int status = pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

// Two tetrahedra, a hexahedron, a quadratic tetrahedron, a triangle, an edge and a point, with all kinds of data.
Frame mixed_frame() {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> any(-1, 1);
  Frame frame;
  frame.time = 0.1;
  frame.x.resize(3, 30);
  for (double& coordinate : frame.x.reshaped()) coordinate = any(generator) / 3;
  frame.cells = {{Element::tet4, {0, 1, 2, 3, 1, 2, 3, 4}},
                 {Element::hex8, {5, 6, 7, 8, 9, 10, 11, 12}},
                 {Element::tet10, {13, 14, 15, 16, 17, 18, 19, 20, 21, 22}},
                 {Element::tri3, {23, 24, 25}},
                 {Element::edge2, {26, 27}},
                 {Element::point, {29}}};
  const auto random_field = [&](const std::string& name, int rows, int cols) {
    Field field{name, Eigen::MatrixXd(rows, cols)};
    for (double& value : field.values.reshaped()) value = any(generator) * 1e5;
    return field;
  };
  frame.point_data = {random_field("velocity", 3, 30), random_field("temperature", 1, 30)};
  frame.point_data[0].values(0, 0) = 5e-324;  // the smallest double
  frame.point_data[0].values(1, 0) = -0.0;
  frame.point_data[0].values(2, 0) = 1.7976931348623157e308;
  frame.cell_data = {random_field("energy < \"J\" & more", 1, 7), random_field("stress", 9, 7)};
  return frame;
}

nlohmann::json rows_of(const Eigen::MatrixXd& values) {
  nlohmann::json rows = nlohmann::json::array();
  for (Eigen::Index c = 0; c < values.cols(); ++c) {
    nlohmann::json row = nlohmann::json::array();
    for (Eigen::Index r = 0; r < values.rows(); ++r) row.push_back(values(r, c));
    rows.push_back(row);
  }
  return rows;
}

nlohmann::json fields_of(const std::vector<Field>& fields) {
  nlohmann::json object = nlohmann::json::object();
  for (const Field& field : fields) object[field.name] = rows_of(field.values);
  return object;
}

nlohmann::json expected_content(const Frame& frame) {
  nlohmann::json cells = nlohmann::json::array();
  for (const CellBlock& block : frame.cells) {
    const size_t count = static_cast<size_t>(nodes_of(block.element));
    for (size_t first = 0; first < block.nodes.size(); first += count) {
      nlohmann::json cell{vtk_cell_type(block.element)};
      for (size_t i = 0; i < count; ++i) cell.push_back(block.nodes[first + i]);
      cells.push_back(cell);
    }
  }
  return {{"time", frame.time},
          {"points", rows_of(frame.x)},
          {"point_type", "double"},
          {"cells", cells},
          {"point_data", fields_of(frame.point_data)},
          {"cell_data", fields_of(frame.cell_data)}};
}

TEST(output_frame, vtk_reads_every_number_to_the_last_bit) {
  const TemporaryFolder folder;
  const Frame frame = mixed_frame();
  write_vtu(folder.path("frame.vtu"), frame);
  folder.file("expected.json", expected_content(frame).dump());
  const Outcome outcome = run_reader(folder.path("frame.vtu") + " " + folder.path("expected.json"));
  EXPECT_EQ(outcome.output, "");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(folder.files(), 2U);
}

TEST(output_frame, the_comparison_sees_a_change_in_the_last_bit) {
  const TemporaryFolder folder;
  Frame frame = mixed_frame();
  write_vtu(folder.path("frame.vtu"), frame);
  double& value = frame.point_data[1].values(0, 29);
  value = std::nextafter(value, 1e9);
  folder.file("expected.json", expected_content(frame).dump());
  const Outcome outcome = run_reader(folder.path("frame.vtu") + " " + folder.path("expected.json"));
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.output.find("point_data is"), std::string::npos) << outcome.output;
}

TEST(output_frame, a_file_that_is_cut_off_is_not_read) {
  const TemporaryFolder folder;
  const Frame frame = mixed_frame();
  write_vtu(folder.path("frame.vtu"), frame);
  const std::string whole = folder.content("frame.vtu");
  folder.file("frame.vtu", whole.substr(0, whole.size() / 2));
  folder.file("expected.json", expected_content(frame).dump());
  EXPECT_NE(run_reader(folder.path("frame.vtu") + " " + folder.path("expected.json")).status, 0);
}

TEST(output_frame, an_empty_frame_is_a_valid_file) {
  const TemporaryFolder folder;
  Frame frame;
  frame.x.resize(3, 1);
  frame.x.setZero();
  write_vtu(folder.path("frame.vtu"), frame);
  folder.file("expected.json", expected_content(frame).dump());
  const Outcome outcome = run_reader(folder.path("frame.vtu") + " " + folder.path("expected.json"));
  EXPECT_EQ(outcome.output, "");
  EXPECT_EQ(outcome.status, 0);
}

TEST(output_frame, a_series_names_its_frames_after_each_step) {
  const TemporaryFolder folder;
  PvdSeries series(folder.path("run.pvd"));
  for (int step = 0; step < 3; ++step) {
    const Mesh mesh = box_tets({1, 1, 1}, {1, 1, step + 1});
    Frame frame;
    frame.time = 0.1 * step;
    frame.x = mesh.X;
    frame.cells = {{mesh.element, mesh.cells}};
    const std::string name = "frame & " + std::to_string(step) + ".vtu";
    write_vtu(folder.path(name), frame);
    series.add(frame.time, name);
    if (step == 0) {
      EXPECT_EQ(run_reader("--series " + folder.path("run.pvd")).output, "0.0 8 6\n");
    }
  }
  EXPECT_EQ(series.frames(), 3U);
  const Outcome outcome = run_reader("--series " + folder.path("run.pvd"));
  EXPECT_EQ(outcome.output, "0.0 8 6\n0.1 12 12\n0.2 16 18\n");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(folder.files(), 4U);
}

TEST(output_frame, fields_of_the_wrong_size_are_named) {
  const TemporaryFolder folder;
  const std::string path = folder.path("frame.vtu");
  const auto message = [&](auto change) -> std::string {
    Frame frame = mixed_frame();
    change(frame);
    try {
      write_vtu(path, frame);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message([](Frame& f) { f.point_data[0].values.conservativeResize(3, 29); }),
            path + ": field 'velocity' is 3 x 29; it must have a column for each of the 30 points");
  EXPECT_EQ(message([](Frame& f) { f.cell_data[1].values.conservativeResize(9, 8); }),
            path + ": field 'stress' is 9 x 8; it must have a column for each of the 7 cells");
  EXPECT_EQ(message([](Frame& f) { f.point_data[1].name = "velocity"; }),
            path + ": two fields on the points are named 'velocity'");
  EXPECT_EQ(message([](Frame& f) { f.cell_data[0].name = ""; }), path + ": a field on the cells has no name");
  EXPECT_EQ(message([](Frame& f) { f.cells[0].nodes[2] = 30; }),
            path + ": a Tet4 cell names point 30, but there are only 30");
  EXPECT_EQ(message([](Frame& f) { f.cells[0].nodes.pop_back(); }),
            path + ": 7 node numbers do not divide into Tet4 cells");
  EXPECT_EQ(folder.files(), 0U);
}

}  // namespace
}  // namespace ergon
