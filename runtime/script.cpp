#include "runtime/script.h"

#include <Eigen/Geometry>

namespace ergon {

namespace {

ScriptKey state_at(double time, const std::vector<ScriptKey>& keys) {
  ScriptKey before;
  for (const ScriptKey& key : keys) {
    if (time < key.time) {
      const double part = (time - before.time) / (key.time - before.time);
      return {time, before.translate + part * (key.translate - before.translate),
              before.rotate + part * (key.rotate - before.rotate)};
    }
    before = key;
  }
  return before;
}

// The shapes on both sides of a time, and how far it is from the first to the second.
struct Between {
  const Eigen::Matrix3Xd& before;
  const Eigen::Matrix3Xd& after;
  double part;
};

Between shapes_at(double time, const std::vector<ScriptShape>& shapes) {
  size_t next = 1;
  while (next < shapes.size() && shapes[next].time <= time) ++next;
  const ScriptShape& before = shapes[next - 1];
  if (next == shapes.size()) return {before.x, before.x, 0};
  return {before.x, shapes[next].x, (time - before.time) / (shapes[next].time - before.time)};
}

}  // namespace

void Script::add(std::vector<int> vertices, const Eigen::Matrix3Xd& start, const Eigen::Vector3d& center,
                 std::vector<ScriptKey> keys, std::vector<ScriptShape> shapes) {
  Part part{std::move(vertices), center, std::move(keys), {}, {}};
  part.shapes.push_back({0, Eigen::Matrix3Xd(3, part.vertices.size())});
  for (size_t i = 0; i < part.vertices.size(); ++i)
    part.shapes[0].x.col(static_cast<Eigen::Index>(i)) = start.col(part.vertices[i]);
  for (ScriptShape& shape : shapes) part.shapes.push_back(std::move(shape));
  for (ScriptShape& shape : part.shapes) shape.x.colwise() -= center;
  vertices_.insert(vertices_.end(), part.vertices.begin(), part.vertices.end());
  parts_.push_back(std::move(part));
}

void Script::turn(int vertex, const Eigen::Vector3d& along) {
  parts_.back().twists.emplace_back(vertex, along);
  vertices_.push_back(vertex);
}

void Script::place(double time, Eigen::Matrix3Xd& x) const {
  for (const Part& part : parts_) {
    const ScriptKey now = state_at(time, part.keys);
    const double angle = now.rotate.norm();
    const Eigen::Vector3d axis = angle > 0 ? Eigen::Vector3d(now.rotate / angle) : Eigen::Vector3d::UnitZ();
    const Eigen::Matrix3d rotation = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    const Eigen::Vector3d center = part.center + now.translate;
    const Between shape = shapes_at(time, part.shapes);
    for (size_t i = 0; i < part.vertices.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const Eigen::Vector3d from = shape.before.col(k);
      x.col(part.vertices[i]) = center + rotation * (from + shape.part * (shape.after.col(k) - from));
    }
    for (const auto& [vertex, along] : part.twists) x.col(vertex) = Eigen::Vector3d(now.rotate.dot(along), 0, 0);
  }
}

}  // namespace ergon
