#include "runtime/mesh/mesh_import.h"

#include <fmt/format.h>
#include <gmsh.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>

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
    omp_set_num_threads(threads_);
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
  int threads_ = omp_get_max_threads();  // Gmsh sets it for the whole process
  std::unique_lock<std::mutex> lock_;
};

// The tetrahedra of Gmsh's model; vertices in the order of their tags.
Mesh mesh_of_model(const std::string& source) {
  constexpr int kTetrahedron = 4;
  std::vector<std::size_t> tags, cell_tags, cell_nodes;
  std::vector<double> coordinates, ignored;
  gmsh::model::mesh::getNodes(tags, coordinates, ignored, -1, -1, false, false);
  gmsh::model::mesh::getElementsByType(kTetrahedron, cell_tags, cell_nodes);
  std::vector<size_t> order(tags.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return tags[a] < tags[b]; });
  Mesh mesh;
  mesh.element = Element::tet4;
  mesh.source = source;
  mesh.X.resize(3, static_cast<Eigen::Index>(tags.size()));
  std::vector<std::size_t> sorted;
  for (const size_t i : order) {
    mesh.X.col(static_cast<Eigen::Index>(sorted.size())) = Eigen::Map<const Eigen::Vector3d>(&coordinates[3 * i]);
    sorted.push_back(tags[i]);
  }
  for (const std::size_t node : cell_nodes) {
    mesh.cells.push_back(static_cast<int>(std::lower_bound(sorted.begin(), sorted.end(), node) - sorted.begin()));
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
  const Mesh solid = mesh_of_model(surface.source);
  check_filled(surface, solid, parts);
  check_mesh(solid);
  return solid;
}

}  // namespace ergon
