#pragma once
// A scene as its author wrote it: plain values in SI units, each with the place it was read from. Nothing here knows of
// meshes in memory, kernels or solvers.

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "scenes/attachment.h"
#include "scenes/energy_use.h"

namespace ergon {

// All points with min <= x <= max, in metres, after the object has been scaled, rotated and translated.
struct BoxSelector : Located {
  static constexpr double inf = std::numeric_limits<double>::infinity();
  Vector3 min = {-inf, -inf, -inf};
  Vector3 max = {inf, inf, inf};
};

// The cells whose centre is in a box, or those of a physical group of the mesh file.
struct SceneRegion : BoxSelector {
  std::string name;
  std::string group;  // name or number; "": by the box
};

// Vertices in a box that do not move along some axes.
struct FixedBox : BoxSelector {
  std::string axes = "xyz";
};

// A force on the vertices in a box that keeps its direction and size, spread evenly over the faces among them, or else
// the edges, or else the vertices. One of the two is given.
struct SceneLoad : BoxSelector {
  Vector3 force = {0, 0, 0};     // N, of all together
  Vector3 traction = {0, 0, 0};  // Pa, on faces at rest
};

struct BoxSource : Located {
  Vector3 size = {1, 1, 1};  // m
  std::array<int, 3> cells = {1, 1, 1};
};

struct SphereSource : Located {
  double radius = 0;  // m
  int cuts = 8;       // of each edge of an icosahedron
};

struct TubeSource : Located {
  double inner = 0;   // m, radius
  double outer = 0;   // m, radius
  double length = 0;  // m, along x
  int around = 32;    // cells
  int along = 16;
};

struct TorusSource : Located {
  double radius = 0;   // m, of the circle amid, around z
  double section = 0;  // m, radius of the cross-section
  int around = 32;     // cells
  int across = 12;
};

struct CurveSource : Located {
  std::vector<Vector3> points;  // m
  bool closed = false;
  std::optional<int> cells;  // of a smooth curve through the points; absent: straight from point to point
};

// Where the shape of an object or obstacle comes from and where it starts. One source is given.
struct SceneShape : Located {
  std::string name;
  std::string mesh;              // path relative to the scene file
  std::optional<BoxSource> box;  // one corner at the origin before the shape is moved
  std::optional<SphereSource> sphere;
  std::optional<TubeSource> tube;
  std::optional<TorusSource> torus;
  std::optional<CurveSource> curve;
  std::vector<Vector3> points;  // m, loose
  double scale = 1;
  Vector3 rotate = {0, 0, 0};     // rad, about x, then y, then z (fixed axes)
  Vector3 translate = {0, 0, 0};  // m
  double offset = 0;              // m, that other surfaces keep from this one, beside their own
  bool touches_itself = true;
};

// A state of a scripted motion; linear in between.
struct MotionKey : Located {
  double time = 0;                // s
  Vector3 translate = {0, 0, 0};  // m, from the start
  Vector3 rotate = {0, 0, 0};     // rad, a rotation vector: its direction is the axis, its length the angle
};

// A shape that an obstacle has taken at a time; its vertices go straight from one to the next.
struct ShapeKey : Located {
  double time = 0;   // s
  std::string mesh;  // path relative to the scene file; with the cells of the obstacle's own mesh
};

// Vertices in a box that follow a script.
struct ScriptedBox : BoxSelector {
  Vector3 center = {0, 0, 0};  // m, that rotations are about; moves along
  std::vector<MotionKey> motion;
};

// Objects like the one before, each displaced against it.
struct Copies : Located {
  int count = 1;
  Vector3 translate = {0, 0, 0};  // m
};

struct SceneObject : SceneShape {
  std::string kinematics = "free";
  double stiffness = 1e8;  // Pa, of an affine body against strains
  double max_edge = 0;     // m, of the tetrahedra that fill a surface; 0: continued from the surface
  std::string element = "automatic";
  std::optional<int> quadrature;   // exactness; absent: the element's own
  double density = 0;              // kg/m^3
  double thickness = 0;            // m, of a membrane
  double cross_section = 0;        // m^2, of a line
  Vector3 axis = {0, 0, 1};        // what the first axis of a rod's cross-section points to
  std::optional<double> gyration;  // m, of a rod's cross-section; absent: of a disc
  double volume = 0;               // m^3, of a loose point
  Vector3 velocity = {0, 0, 0};    // m/s
  std::string mass = "automatic";  // lumped, consistent, or what suits the element
  double mass_damping = 0;         // 1/s
  std::vector<EnergyUse> energies;
  std::vector<SceneRegion> regions;
  std::vector<FixedBox> fixed;
  std::vector<ScriptedBox> scripted;
  std::vector<SceneLoad> loads;
  std::optional<Copies> copies;  // none once a scene has been read: each is an object of its own

  // Automatic is hex27 for a box: of all elements it is least off where things bend and where they are struck, at the
  // time that it takes (docs/accuracy.md).
  std::string element_name() const {
    if (element != "automatic") return element;
    return box ? "hex27" : curve ? "edge2" : "tet4";
  }

  // A surface is filled with tetrahedra unless its triangles are asked for.
  bool keeps_surface() const { return element == "tri3" || element == "tri6"; }

  bool affine() const { return kinematics == "affine"; }
};

// A surface without degrees of freedom, at rest or moved by a script.
struct SceneObstacle : SceneShape {
  std::string element = "hex8";  // of a box
  Vector3 center = {0, 0, 0};    // m, that rotations are about; moves along
  std::vector<MotionKey> motion;
  std::vector<ShapeKey> shapes;
};

// What holds between two objects, or for one with itself, instead of what [contact] says.
struct ContactPair : Located {
  std::string first, second;
  bool ignore = false;
  std::optional<double> mu, mu_kinetic;
};

// A vertex whose path is written: the one of an object that is nearest to a point at the start.
struct SceneProbe : Located {
  std::string name;
  std::string object;
  Vector3 near = {0, 0, 0};  // m
};

// Contact of objects and obstacles with one another and themselves.
struct ContactSettings : Located {
  std::string barrier = "log_barrier";  // its law: a name in the catalogue, or a path relative to the scene file
  double dhat = 1e-3;                   // m
  double mu = 0;                        // 0: no friction
  std::optional<double> mu_kinetic;     // absent: mu
  double epsv = 1e-3;                   // m/s
  double fall = 1e-3;                   // m/s
  std::optional<double> stiffness;      // kappa of the barrier; absent: chosen and adapted by the solver
  bool area_weights = false;            // stencils count by area; stiffness is then per m^2
  std::vector<ContactPair> pairs;
};

// The half-space dot(normal, x) < height.
struct SceneGround : Located {
  Vector3 normal = {0, 0, 1};       // any length
  double height = 0;                // m, along the unit normal
  double mu = 0;                    // 0: no friction
  double epsv = 1e-3;               // m/s
  double dhat = 1e-3;               // m
  std::optional<double> stiffness;  // N/m; absent: chosen and adapted by the solver
};

struct TimeSettings : Located {
  std::string integrator = "automatic";  // or one of integrator_names()
  double dt = 0;                         // s
  std::optional<double> min_dt;          // s; absent: of the integrator
  std::optional<double> tolerance;       // m; absent: dt does not follow the error
  std::optional<double> end;             // s; exactly one of `end` and `steps`
  std::optional<int> steps;

  bool quasi_static() const { return integrator == "quasi_static"; }
};

// How the first state differs from what the objects say.
struct StartSettings : Located {
  double noise = 0;  // m/s
  int seed = 1;
};

struct SolverSettings : Located {
  double tolerance = 1e-4;  // m/s
  int max_iterations = 1000;
  int friction_iterations = 2;
  double friction_tolerance = 0.05;  // fraction of the sum of normal forces
  std::string projection = "progressive";
  std::string precision = "double";
  bool accept_unconverged = false;
};

struct OutputSettings : Located {
  std::string folder;         // "": out/ and the name of the scene file; relative to the working directory
  double frame_interval = 0;  // s; 0: every step
  bool frames = true;
  bool forces = false;  // of contact, in frames and report
};

struct Scene : Located {
  std::string file;
  std::string description;
  Vector3 gravity = {0, 0, -9.81};  // m/s^2
  TimeSettings time;
  StartSettings start;
  SolverSettings solver;
  OutputSettings output;
  std::vector<SceneObject> objects;
  std::vector<SceneObstacle> obstacles;
  std::vector<SceneGround> grounds;
  std::vector<SceneProbe> probes;
  std::vector<SceneAttachment> attachments;
  std::optional<ContactSettings> contact;  // absent: surfaces do not collide, only grounds act

  // One of integrator_names(). Automatic is bdf2, as it costs what implicit Euler does and its error goes with dt^2,
  // with implicit Euler for steps in which it would create energy, as in hard impacts.
  std::string integrator() const { return time.integrator == "automatic" ? "bdf2" : time.integrator; }
};

}  // namespace ergon
