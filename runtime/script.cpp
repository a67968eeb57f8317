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

}  // namespace

void Script::add(std::vector<int> vertices, const Eigen::Matrix3Xd& start, const Eigen::Vector3d& center,
                 std::vector<ScriptKey> keys) {
  Part part{std::move(vertices), {}, center, std::move(keys)};
  part.start.resize(3, static_cast<int>(part.vertices.size()));
  for (size_t i = 0; i < part.vertices.size(); ++i) {
    part.start.col(static_cast<int>(i)) = start.col(part.vertices[i]) - center;
  }
  vertices_.insert(vertices_.end(), part.vertices.begin(), part.vertices.end());
  parts_.push_back(std::move(part));
}

void Script::place(double time, Eigen::Matrix3Xd& x) const {
  for (const Part& part : parts_) {
    const ScriptKey now = state_at(time, part.keys);
    const double angle = now.rotate.norm();
    const Eigen::Vector3d axis = angle > 0 ? Eigen::Vector3d(now.rotate / angle) : Eigen::Vector3d::UnitZ();
    const Eigen::Matrix3d rotation = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    const Eigen::Vector3d center = part.center + now.translate;
    for (size_t i = 0; i < part.vertices.size(); ++i) {
      x.col(part.vertices[i]) = center + rotation * part.start.col(static_cast<int>(i));
    }
  }
}

}  // namespace ergon
