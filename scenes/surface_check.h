#pragma once
// Which surfaces of a scene intersect or are closer than their offsets, in words and as a mesh to look at.

#include <array>
#include <string>
#include <vector>

#include "runtime/contact/intersections.h"
#include "runtime/output/vtu.h"
#include "scenes/builder.h"

namespace ergon {

struct SurfaceFaults {
  std::vector<Intersection> crossing;
  std::vector<std::vector<int>> close;  // vertices of stencils whose gap is not positive
  bool none() const { return crossing.empty() && close.empty(); }
};

// Of a scene with [contact]; x: 3 x vertices of its system, m.
SurfaceFaults find_surface_faults(const BuiltScene& built, const Eigen::Matrix3Xd& x);

// "vertex 12 of 'cloth'", by the numbers of the object's own mesh.
std::string vertex_text(const BuiltScene& built, int vertex);

// The first few faults with objects, vertices and place. `faults` holds one at least.
std::string to_text(const SurfaceFaults& faults, const BuiltScene& built, const Eigen::Matrix3Xd& x);

// The faulty edges and triangles, each once; the cell field `object` says whose they are.
Frame frame_of(const SurfaceFaults& faults, const BuiltScene& built, const Eigen::Matrix3Xd& x);

// Throws SourceError at the first faulty object of the scene's start, after `report` was given a mesh of the faults.
void check_surface_start(const Scene& scene, const BuiltScene& built, const FaultReport& report);

}  // namespace ergon
