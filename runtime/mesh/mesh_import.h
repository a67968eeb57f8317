#pragma once
// Meshes from files, and solids from surfaces. Every result is finite, names only its own vertices, and is the same for
// the same input. Gmsh fills surfaces; it keeps global state, so that calls of fill_surface wait for one another.

#include <map>
#include <string>
#include <vector>

#include "runtime/mesh/mesh.h"

namespace ergon {

// Reads a .msh file of Gmsh, format 2 or 4.1, text or binary. (Not through Gmsh itself: 4.8 crashes on a cell that
// names a missing node.) Cells of the highest dimension present are kept, of any element but points, in VTK's order of
// nodes. Vertices of no kept cell are left out; the others are in the order of their tags. Throws InputError with the
// line (text): missing file, another format, no cells, more than one kind of cell, cells of another kind, a node that
// does not exist or exists twice, a coordinate that is not finite, a file that is cut off.
Mesh read_mesh(const std::string& path);

// The physical groups of such a file that hold some of the cells of read_mesh(path), which are counted in its order
// from 0; by name, or by number where a group has none. Throws as above.
std::map<std::string, std::vector<int>> read_mesh_groups(const std::string& path);

// Reads a triangle surface from .obj, .stl (text or binary) or .ply (text or binary). Vertices with equal coordinates
// are merged, triangles that lose a side by that and vertices of no triangle are left out, quadrilaterals are cut in
// two; what remains keeps its order. The surface need not be closed.
// Throws InputError with the line (or the number of the record in a binary file).
Mesh read_surface(const std::string& path);

struct FillOptions {
  // The length that edges inside the solid are to stay below, m; 0: lengths are continued from the surface. A wish:
  // the surface's edges stay as they are, and a solid few of them thick may not get finer.
  double max_edge_length = 0;
  // Tetrahedra whose quality (Gmsh's gamma: 0 flat, 1 regular) is below this are improved after filling.
  double improve_below = 0.6;
};

// Fills a closed triangle surface with tetrahedra. The surface's triangles are kept: its vertices keep their numbers
// and come first. Several closed parts may lie beside or inside one another; a part inside another is a cavity, one
// inside a cavity is solid again. Triangles may be oriented either way. Throws InputError: empty, open or branching
// surface (how many edges, one of them with coordinates), triangles that cut one another, or what Gmsh itself reports.
Mesh fill_surface(const Mesh& surface, const FillOptions& options = {});

}  // namespace ergon
