#include "runtime/mesh/mesh_import.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmsh.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>

#include "runtime/error.h"
#include "runtime/mesh/closed_surface.h"
#include "runtime/mesh/mesh_tools.h"

namespace ergon {
namespace {

// Gmsh's state is global to the process: one session at a time.
std::mutex& gmsh_mutex() {
  static std::mutex mutex;
  return mutex;
}

// Gmsh, started quiet and with its own defaults rather than a user's, for the life of this object.
class GmshSession {
 public:
  GmshSession() : lock_(gmsh_mutex()) {
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::option::setNumber("General.NumThreads", 1);
    gmsh::logger::start();
  }
  ~GmshSession() {
    try {
      gmsh::finalize();
    } catch (...) {  // nothing is left to be done with it
    }
  }
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;

  // Runs `work`; what Gmsh throws or logs as an error becomes an InputError quoting its last message.
  template <class Work>
  void run(const std::string& source, const char* what, Work work) {
    bool failed = false;
    try {
      work();
    } catch (const std::exception&) {
      failed = true;
    } catch (const std::string&) {
      failed = true;
    } catch (int) {  // Gmsh 4.8 throws its error code
      failed = true;
    }
    std::vector<std::string> log;
    gmsh::logger::get(log);
    std::string message;
    for (const std::string& line : log) {
      if (line.starts_with("Error: ")) message = line.substr(7);
    }
    if (message.empty() && failed) gmsh::logger::getLastError(message);
    if (failed || !message.empty()) {
      throw InputError(
          fmt::format("{}: Gmsh could not {}: {}", source, what, message.empty() ? "it gave no reason" : message));
    }
  }

 private:
  std::unique_lock<std::mutex> lock_;
};

// Gmsh's numbers of the cells that a Mesh can hold.
struct GmshCell {
  int type;
  Element element;
};
constexpr GmshCell kGmshCells[] = {{4, Element::tet4}, {11, Element::tet10}, {5, Element::hex8}, {2, Element::tri3}};

int gmsh_type_of(Element element) {
  for (const GmshCell& cell : kGmshCells) {
    if (cell.element == element) return cell.type;
  }
  return 0;
}

// A .msh file must say so: Gmsh would run any other text as a script.
void check_is_msh(const std::string& path) {
  std::ifstream file(path);
  std::string word;
  if (!file) throw InputError(fmt::format("{}: cannot be opened: {}", path, std::strerror(errno)));
  if (path.size() < 4 || path.substr(path.size() - 4) != ".msh") {
    throw InputError(path + ": unknown mesh format; a mesh is read from a .msh file of Gmsh");
  }
  file >> word;
  if (word != "$MeshFormat") throw InputError(path + ": is not a Gmsh mesh: it does not start with $MeshFormat");
}

Element element_in_model(const std::string& path) {
  for (int dimension = 3; dimension >= 2; --dimension) {
    std::vector<int> types;
    gmsh::model::mesh::getElementTypes(types, dimension);
    if (types.empty()) continue;
    std::vector<std::string> names;
    for (const int type : types) {
      std::string name;
      int order = 0, nodes = 0, primary = 0, ignored = 0;
      std::vector<double> coordinates;
      gmsh::model::mesh::getElementProperties(type, name, ignored, order, nodes, coordinates, primary);
      names.push_back(name);
    }
    const auto known = std::find_if(std::begin(kGmshCells), std::end(kGmshCells),
                                    [&](const GmshCell& cell) { return cell.type == types[0]; });
    if (types.size() > 1) {
      throw InputError(
          fmt::format("{}: holds more than one kind of cell: {}; mesh it with one kind", path, fmt::join(names, ", ")));
    }
    if (known == std::end(kGmshCells)) {
      throw InputError(fmt::format("{}: cells of the kind '{}' are not supported; known are Tet4, Tet10, Hex8 and Tri3",
                                   path, names[0]));
    }
    return known->element;
  }
  throw InputError(path + ": holds no tetrahedra, hexahedra or triangles");
}

Mesh mesh_of_model(Element element, const std::string& path) {
  std::vector<std::size_t> tags, nodes, cell_tags, cell_nodes;
  std::vector<double> coordinates, ignored;
  gmsh::model::mesh::getNodes(tags, coordinates, ignored, -1, -1, false, false);
  gmsh::model::mesh::getElementsByType(gmsh_type_of(element), cell_tags, cell_nodes);
  std::map<std::size_t, std::array<double, 3>> points;  // by tag
  for (size_t i = 0; i < tags.size(); ++i) {
    points[tags[i]] = {coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]};
  }
  nodes = cell_nodes;
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  Mesh mesh;
  mesh.element = element;
  mesh.source = path;
  mesh.X.resize(3, static_cast<Eigen::Index>(nodes.size()));
  for (size_t i = 0; i < nodes.size(); ++i) {
    const auto place = points.find(nodes[i]);
    if (place == points.end())
      throw InputError(fmt::format("{}: a cell names node {}, which does not exist", path, nodes[i]));
    const Eigen::Vector3d point(place->second[0], place->second[1], place->second[2]);
    if (!point.allFinite()) {
      throw InputError(fmt::format("{}: node {} is ({}, {}, {}); it must be finite", path, nodes[i], point.x(),
                                   point.y(), point.z()));
    }
    mesh.X.col(static_cast<Eigen::Index>(i)) = point;
  }
  mesh.cells.reserve(cell_nodes.size());
  for (const std::size_t node : cell_nodes) {
    mesh.cells.push_back(static_cast<int>(std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin()));
  }
  if (element == Element::tet10) {
    // Gmsh lists the nodes of edges (2, 3) and (1, 3) the other way round than VTK.
    for (size_t c = 0; c < mesh.cells.size(); c += 10) std::swap(mesh.cells[c + 8], mesh.cells[c + 9]);
  }
  return mesh;
}

// Each solid is an outer boundary and the cavities directly in it.
void add_solids(const Mesh& surface, const std::vector<SurfacePart>& parts) {
  const int count = static_cast<int>(parts.size());
  std::vector<std::size_t> tags(static_cast<size_t>(surface.vertices()));
  for (size_t i = 0; i < tags.size(); ++i) tags[i] = i + 1;
  std::vector<double> coordinates(surface.X.data(), surface.X.data() + surface.X.size());
  for (int part = 0; part < count; ++part) gmsh::model::addDiscreteEntity(2, part + 1);
  gmsh::model::mesh::addNodes(2, 1, tags, coordinates);
  for (int part = 0; part < count; ++part) {
    std::vector<std::size_t> corners;
    for (const auto& t : parts[static_cast<size_t>(part)].triangles) {
      for (const int v : t) corners.push_back(static_cast<std::size_t>(v) + 1);
    }
    gmsh::model::mesh::addElementsByType(part + 1, 2, {}, corners);
    gmsh::model::geo::addSurfaceLoop({part + 1}, part + 1);
  }
  for (int part = 0; part < count; ++part) {
    if (parts[static_cast<size_t>(part)].depth % 2 != 0) continue;
    std::vector<int> loops{part + 1};
    for (int inner = 0; inner < count; ++inner) {
      if (parts[static_cast<size_t>(inner)].depth % 2 != 0 && parts[static_cast<size_t>(inner)].parent == part) {
        loops.push_back(inner + 1);
      }
    }
    gmsh::model::geo::addVolume(loops, part + 1);
  }
  gmsh::model::geo::synchronize();
}

// The filled mesh must have exactly the given vertices and boundary, and the volume it encloses.
void check_filled(const Mesh& surface, const Mesh& solid, const std::vector<SurfacePart>& parts) {
  std::vector<std::array<int, 3>> wanted;
  double volume = 0;
  for (const SurfacePart& part : parts) {
    wanted.insert(wanted.end(), part.triangles.begin(), part.triangles.end());
    volume += (part.depth % 2 == 0 ? 1 : -1) * enclosed_volume(solid.X, part.triangles);
  }
  std::vector<std::array<int, 3>> found = surface_triangles(solid);
  for (auto* triangles : {&wanted, &found}) {
    for (auto& t : *triangles) std::sort(t.begin(), t.end());
    std::sort(triangles->begin(), triangles->end());
  }
  const bool same_vertices =
      solid.vertices() >= surface.vertices() && solid.X.leftCols(surface.vertices()) == surface.X;
  if (!same_vertices || wanted != found) {
    throw InputError(solid.source +
                     ": Gmsh did not keep the surface's triangles; repair the surface (thin or "
                     "touching parts)");
  }
  double sum = 0;
  for (const double v : rest_volumes(solid)) sum += v;
  if (!(std::abs(sum - volume) <= 1e-9 * volume)) {
    throw InputError(fmt::format("{}: Gmsh filled {:.6g} m^3 of the {:.6g} m^3 that the surface encloses", solid.source,
                                 sum, volume));
  }
}

}  // namespace

Mesh read_mesh(const std::string& path) {
  check_is_msh(path);
  GmshSession session;
  session.run(path, "read the mesh", [&] { gmsh::merge(path); });
  return mesh_of_model(element_in_model(path), path);
}

Mesh fill_surface(const Mesh& surface, const FillOptions& options) {
  if (!(options.max_edge_length >= 0) || !std::isfinite(options.max_edge_length)) {
    throw InputError(
        fmt::format("{}: the maximum edge length is {} m; it must be positive, or 0 for sizes continued "
                    "from the surface",
                    surface.source, options.max_edge_length));
  }
  if (!(options.improve_below >= 0 && options.improve_below <= 1)) {
    throw InputError(fmt::format("{}: tetrahedra are to be improved below a quality of {}; it must be between 0 and 1",
                                 surface.source, options.improve_below));
  }
  check_mesh(surface);
  const std::vector<SurfacePart> parts = closed_parts(surface);
  GmshSession session;
  session.run(surface.source, "fill the surface", [&] {
    gmsh::option::setNumber("Mesh.Algorithm3D", 1);
    gmsh::option::setNumber("Mesh.OptimizeThreshold", options.improve_below);
    if (options.max_edge_length > 0) gmsh::option::setNumber("Mesh.MeshSizeMax", options.max_edge_length);
    gmsh::model::add("solid");
    add_solids(surface, parts);
    gmsh::model::mesh::generate(3);
  });
  const Mesh solid = mesh_of_model(Element::tet4, surface.source);
  check_filled(surface, solid, parts);
  check_mesh(solid);
  return solid;
}

}  // namespace ergon
