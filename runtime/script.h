#pragma once
// Vertices that follow a script: shapes and rigid motions through key frames. It establishes where they are at any
// time, free of accumulated error: each state is made from the start.

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace ergon {

// Linear in time between keys: the displacement of the centre, and the rotation vector about it (axis times angle, rad,
// of any number of turns).
struct ScriptKey {
  double time = 0;                                      // s
  Eigen::Vector3d translate = Eigen::Vector3d::Zero();  // m, from the start
  Eigen::Vector3d rotate = Eigen::Vector3d::Zero();     // rad
};

// A shape at a time, before the rigid motion. In between vertices go straight.
struct ScriptShape {
  double time = 0;     // s, above 0
  Eigen::Matrix3Xd x;  // m, of the part's vertices
};

class Script {
 public:
  // `start`: 3 x vertices of the system, of which those in `vertices` are read; keys in ascending order of time, before
  // the first of which the motion goes from the start at time 0; likewise shapes.
  void add(std::vector<int> vertices, const Eigen::Matrix3Xd& start, const Eigen::Vector3d& center,
           std::vector<ScriptKey> keys, std::vector<ScriptShape> shapes = {});

  // The twist of an edge (a vertex of the system, whose first component it is, m) turns with the part that was added
  // last. `along`: the edge's direction at the start, as long as the radius of the twist. Exact where the part turns
  // about the edge.
  void turn(int vertex, const Eigen::Vector3d& along);

  bool empty() const { return parts_.empty(); }
  const std::vector<int>& vertices() const { return vertices_; }  // of all parts, in order of addition
  // Puts the scripted vertices where they are at a time, s; leaves the others as they are.
  void place(double time, Eigen::Matrix3Xd& x) const;

 private:
  struct Part {
    std::vector<int> vertices;
    Eigen::Vector3d center;
    std::vector<ScriptKey> keys;
    std::vector<ScriptShape> shapes;  // relative to the centre; that of the start first, at time 0
    std::vector<std::pair<int, Eigen::Vector3d>> twists;
  };
  std::vector<Part> parts_;
  std::vector<int> vertices_;
};

}  // namespace ergon
