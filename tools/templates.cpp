#include "tools/templates.h"

namespace ergon {

const std::vector<EnergyTemplate>& energy_templates() {
  static const std::vector<EnergyTemplate> all = {
      {"solid", "density over F, 3x3",
       R"(# Rubber that resists changes of shape and of volume. (This line is the summary: say what the law is for.)
density  NAME   solid
# Add where it comes from:  cite  Author Year. Title. Journal. Equation.
# F is the deformation gradient; the value is in J per rest volume, that is Pa.
param    mu   Pa   (0, inf)     shear modulus        # a name, its unit, its range, help
param    K    Pa   (0, inf)     bulk modulus
let      J = det(F)                                  # volume over volume at rest
let      I = norm2(F)*J^(-2/3) - 3                   # change of shape: 0 at rest, 1 is much
require  J > 0                                       # steps that would invert an element are shortened
value    mu/2*I + K/2*(J - 1)^2
# In a scene, of an object:  energy = [{ law = "NAME.energy", mu = "0.4 MPa", K = "20 MPa" }]
)"},
      {"membrane", "density over F, 3x2",
       R"(# Cloth that is as stiff in all directions. (This line is the summary: say what the law is for.)
density  NAME   membrane
# F takes directions of the flat rest shape to space; the value is in J per rest area, that is N/m.
param    mu   N/m   (0, inf)    shear modulus, times thickness       # a name, its unit, its range, help
param    la   N/m   [0, inf)    first parameter of Lame, times thickness
let      strain = (F'*F - identity(2))/2             # Green's strain: 0 at rest and under rotation
value    mu*norm2(strain) + la/2*tr(strain)^2
# In a scene, of an object with element = "tri3":  energy = [{ law = "NAME.energy", mu = "400 N/m", la = "800 N/m" }]
)"},
      {"line", "density over F, 3x1",
       R"(# Thread that resists stretching and can never be pressed to a point. (This line is the summary.)
density  NAME   line
# F is the derivative of the position by the length at rest; the value is in J per rest length, that is N.
param    EA   N    (0, inf)     Young's modulus times the area of the cross-section    # a name, unit, range, help
let      stretch2 = norm2(F)                         # square of the stretch
require  stretch2 > 0
value    EA/8*log(stretch2)^2
# In a scene, of an object that is a curve:  energy = [{ law = "NAME.energy", EA = "100 N" }]
)"},
      {"point", "energy of one point",
       R"(# Pulls every point towards a place, in proportion to its distance. (This line is the summary.)
energy   NAME   point
frame    fixed                                       # the place stays where it is: no invariance under rotation
dof      x           m                               # the position, a vector of 3
param    k           N/m  (0, inf)    stiffness      # a name, its unit, its range, help
param    place[3]    m                where to
value    k/2*norm2(x - place)
# In a scene, of any object:  energy = [{ law = "NAME.energy", k = "1 N/m", place = [0, 0, "50 cm"] }]
)"},
      {"edge", "energy of two points, as a spring",
       R"(# Spring that stiffens as it is stretched. (This line is the summary: say what the law is for.)
energy   NAME   edge
dof      x0 x1        m                              # the points, vectors of 3
rest     X0[3] X1[3]  m                rest positions    # named like a dof with a capital: filled in by the program
param    k            N/m   (0, inf)   stiffness at rest # a name, its unit, its range, help
let      L2 = norm2(X1 - X0)
require  L2 > 0
let      strain = (norm2(x1 - x0)/L2 - 1)/2          # Green's strain: 0 at the rest length
value    k*L2/2*strain^2
# In a scene, of any object:  energy = [{ law = "NAME.energy", k = "10 N/m" }]
)"},
      {"corner", "energy of three points that follow each other on a line",
       R"(# Bending of a line that is straight at rest. (This line is the summary: say what the law is for.)
energy   NAME   corner
dof      x0 x1 x2  m                                 # the points, vectors of 3
rest     L0 L1     m      (0, inf)   lengths of both edges at rest    # filled in by the program
param    EI        N*m^2  (0, inf)   bending stiffness    # a name, its unit, its range, help
let      bend = (x2 - x1)/L1 - (x1 - x0)/L0          # change of direction; 0 while straight
value    EI/(L0 + L1)*norm2(bend)
# In a scene, of an object that is a curve:  energy = [{ law = "NAME.energy", EI = "1e-4 N*m^2" }]
)"},
      {"triangle", "energy of three points",
       R"(# Keeps the area of a triangle. (This line is the summary: say what the law is for.)
energy   NAME   triangle
dof      x0 x1 x2            m                       # the points, vectors of 3
rest     X0[3] X1[3] X2[3]   m                 rest positions    # named like a dof with a capital: filled in
param    k                   N/m   (0, inf)    stiffness         # a name, its unit, its range, help
let      A2 = norm2(cross(X1 - X0, X2 - X0))/4       # square of the area at rest
let      a2 = norm2(cross(x1 - x0, x2 - x0))/4       # square of the area: no root, so smooth everywhere
require  A2 > 0
value    k/8*sqrt(A2)*(a2/A2 - 1)^2
# In a scene, of an object with element = "tri3":  energy = [{ law = "NAME.energy", k = "100 N/m" }]
)"},
      {"tetrahedron", "energy of four points",
       R"(# Keeps the volume of a tetrahedron. (This line is the summary: say what the law is for.)
energy   NAME   tetrahedron
dof      x0 x1 x2 x3   m                             # the points, vectors of 3
rest     V             m^3  (0, inf)   volume at rest
param    K             Pa   (0, inf)   bulk modulus  # a name, its unit, its range, help
let      J = det(columns(x1 - x0, x2 - x0, x3 - x0))/(6*V)
value    K*V/2*(J - 1)^2
# In a scene, of an object with element = "tet4":  energy = [{ law = "NAME.energy", K = "1 MPa" }]
)"},
      {"hinge", "energy of two triangles that share an edge",
       R"(# Bending: resists the change of the angle between two triangles. (This line is the summary.)
energy   NAME   hinge
# x0 and x1 are the ends of the shared edge, x2 and x3 the other corners of the two triangles.
dof      x0 x1 x2 x3               m                 # the points, vectors of 3
rest     X0[3] X1[3] X2[3] X3[3]   m               rest positions     # named like a dof with a capital: filled in
param    k                         J    (0, inf)   bending stiffness  # a name, its unit, its range, help
let      E = X1 - X0
let      area = (norm(cross(E, X2 - X0)) + norm(cross(E, X3 - X0)))/2    # of both triangles at rest
require  norm2(cross(E, X2 - X0)) > 0
require  norm2(cross(E, X3 - X0)) > 0
let      bend = dihedral(x0, x1, x2, x3) - dihedral(X0, X1, X2, X3)      # in radians
value    3*k*norm2(E)/area*bend^2
# In a scene, of an object with element = "tri3":  energy = [{ law = "NAME.energy", k = "1e-4 J" }]
)"},
      {"patch", "energy of a triangle and those across its edges",
       R"(# Bending: resists what lies across the edges of a triangle coming nearer. (This line is the summary.)
energy   NAME   patch
# x3, x4, x5 lie across the edges opposite to x0, x1, x2; at a border they are any points near by, and `inner` is 0.
dof      x0 x1 x2 x3 x4 x5                     m                # the points, vectors of 3
rest     X0[3] X1[3] X2[3] X3[3] X4[3] X5[3]   m                rest positions    # named like a dof with a capital
rest     inner0 inner1 inner2                  1   [0, 1]       1 where there is a triangle across, otherwise 0
param    k                                     N/m (0, inf)     stiffness         # a name, its unit, its range, help
let      area2 = norm(cross(X1 - X0, X2 - X0))                  # twice the area at rest
require  area2 > 0
let      d = inner0*(x3 - x0) + inner1*(x4 - x1) + inner2*(x5 - x2)
let      D = inner0*(X3 - X0) + inner1*(X4 - X1) + inner2*(X5 - X2)
value    k/area2*(norm2(d) - norm2(D))^2
# In a scene, of an object with element = "tri3":  energy = [{ law = "NAME.energy", k = "1e-4 N/m" }]
)"},
      {"shell_triangle", "energy of a triangle of a shell and the normals amid its edges",
       R"(# Bending: resists turns of the normals amid the edges of a triangle. (This line is the summary.)
energy   NAME   shell_triangle
# p0, p1, p2 are the tips of the normals amid the edges opposite to x0, x1, x2; at rest a normal is as long as its edge.
# The triangle on the other side of an edge sees the same normal, and nothing else holds it: a law gives it its length.
dof      x0 x1 x2 p0 p1 p2              m                  # the points, vectors of 3
rest     X0[3] X1[3] X2[3]              m                  rest positions    # named like a dof with a capital: filled in
rest     P0[3] P1[3] P2[3]              m                  of the tips
param    k                              N/m  (0, inf)      stiffness         # a name, its unit, its range, help
let      a = [norm2(p0 - x0), norm2(p1 - x1), norm2(p2 - x2)]
let      b = [norm2(p0 - x1), norm2(p1 - x2), norm2(p2 - x0)]
let      c = [norm2(p0 - x2), norm2(p1 - x0), norm2(p2 - x1)]
let      A = [norm2(P0 - X0), norm2(P1 - X1), norm2(P2 - X2)]
let      B = [norm2(P0 - X1), norm2(P1 - X2), norm2(P2 - X0)]
let      C = [norm2(P0 - X2), norm2(P1 - X0), norm2(P2 - X1)]
require  norm2(X1 - X0) > 0
value    k/8*(norm2(a - A) + norm2(b - B) + norm2(c - C))/norm2(X1 - X0)
# In a scene, of an object with element = "tri3":  energy = [{ law = "NAME.energy", k = "1e-2 N/m" }]
)"},
      {"rod_corner", "energy of two edges of a rod that twists",
       R"(# Resists twist of a rod. (This line is the summary: say what the law is for.)
energy   NAME   rod_corner
# x0, x1, x2 are the points of two edges; u0[0]/r and u1[0]/r are the angles by which the edges have turned about
# themselves, beside references that follow the edges from where the step began without turning about them.
dof      x0 x1 x2   m                                # vectors of 3
dof      u0 u1      m                                # only [0] has a meaning; 0 at rest
rest     L0 L1      m      (0, inf)   lengths of both edges at rest             # filled in by the program
rest     r          m      (0, inf)   radius of gyration of the cross-section   # also filled in
param    GJ         N*m^2  (0, inf)   stiffness against twist                   # a name, its unit, its range, help
rest     T0[3] T1[3]   1              directions of both edges as drawn         # also
lag      moved0[3] moved1[3]   1      change of these when the step begins
lag      drift      1                 the angle between the references when the step begins
frame    fixed                                       # angles are told from where the step began
require  norm2(T0 + moved0) > 0
require  norm2(T1 + moved1) > 0
let      s0 = (T0 + moved0)/norm(T0 + moved0)         # where the step began
let      s1 = (T1 + moved1)/norm(T1 + moved1)
let      t0 = (x1 - x0)/norm(x1 - x0)
let      t1 = (x2 - x1)/norm(x2 - x1)
let      c0 = norm2(t0 + t1)/2 + dot(s0, t0 + t1)
let      c1 = norm2(s1 + t1)/2 + dot(s0, s1 + t1)
require  c0 > 0
require  c1 > 0
let      swept = 2*atan(dot(s0, cross(t1, t0))/c0) + 2*atan(dot(s0, cross(s1, t1))/c1)
let      twist = (u1[0] - u0[0])/r + drift + swept   # references turn as the edges sweep a solid angle
update   moved0 = t0 - T0
update   moved1 = t1 - T1
update   drift = drift + swept                       # kept for the next step
value    GJ*twist^2/(L0 + L1)
# In a scene, of an object that is a curve:  energy = [{ law = "NAME.energy", GJ = "1e-4 N*m^2" }]
)"},
      {"point_point", "energy of two points that are not joined by an edge",
       R"(# Holds two points together. (This line is the summary: say what the law is for.)
energy   NAME   point_point
dof      p q   m                                     # the points, vectors of 3
param    k     N/m   (0, inf)   stiffness            # a name, its unit, its range, help
value    k/2*norm2(p - q)
# In a scene:  attachment = [{ object = "a", min = [-inf, -inf, 0.1], to = "b", within = 1e-3, law = "NAME.energy", k = 10 }]
)"},
      {"point_edge", "energy of a point and an edge",
       R"(# Holds a point to a place on an edge. (This line is the summary: say what the law is for.)
energy   NAME   point_edge
dof      p e0 e1   m                                 # the point and the ends of the edge, vectors of 3
rest     w         1     [0, 1]     where on the edge: 0 at e0, 1 at e1    # one value for each stencil
param    k         N/m   (0, inf)   stiffness                              # one value for all
value    k/2*norm2(p - (1 - w)*e0 - w*e1)
# From C++: Potential::on_stencils takes the stencils, and `w` for each (tools/examples/own_arrays.cpp).
)"},
      {"point_triangle", "energy of a point and a triangle",
       R"(# Holds a point to a place on a triangle. (This line is the summary: say what the law is for.)
energy   NAME   point_triangle
dof      p t0 t1 t2   m                              # the point and the corners of the triangle, vectors of 3
rest     w1 w2        1    [0, 1]    weights of t1 and t2 in the place; that of t0 is what is left of 1
param    k            N/m  (0, inf)  stiffness       # one value for all; `rest` has one for each stencil
value    k/2*norm2(p - (1 - w1 - w2)*t0 - w1*t1 - w2*t2)
# In a scene:  attachment = [{ object = "a", min = [-inf, -inf, 0.1], to = "b", at = "surface", within = 1e-3, law = "NAME.energy", k = 10 }]
)"},
      {"edge_edge", "energy of two edges",
       R"(# Holds two threads together where they cross. (This line is the summary: say what the law is for.)
energy   NAME   edge_edge
dof      a0 a1 b0 b1   m                             # the ends of both edges, vectors of 3
rest     u v           1     [0, 1]     where on each edge: 0 at its first end, 1 at its second
param    k             N/m   (0, inf)   stiffness    # one value for all; `rest` has one for each stencil
value    k/2*norm2((1 - u)*a0 + u*a1 - (1 - v)*b0 - v*b1)
# From C++: Potential::on_stencils takes the stencils, and `u`, `v` for each (tools/examples/own_arrays.cpp).
)"},
      {"barrier", "law of contact over a gap",
       R"(# Keeps a gap open: zero beyond dhat, infinite at contact. (This line is the summary.)
barrier  NAME
# `gap` (m) and `gap2` (its square) are known; the program puts a distance, as that of a point and a triangle, in.
param    dhat    m     (0, inf)    activation distance
lag      kappa   N/m   (0, inf)    stiffness, which a scene renews between solves
active   gap < dhat
value    kappa*(dhat - gap)^3/gap                    # value, force and stiffness all begin at 0
# In a scene:  contact = { barrier = "NAME.energy", dhat = "1 mm" }
)"},
      {"distance", "gap of two points, under any law of contact",
       R"(# The distance of two points. (This line is the summary: say what the gap is between.)
distance NAME   point_point
dof      p q   m                                     # the points of the stencil, vectors of 3
let      gap2 = norm2(p - q)                         # `gap2` (m^2), `gap` (m) or both; no `value`
# From C++, under a law of contact: compose(law, distance, Offset::none) of symbolic/compose.h.
)"},
  };
  return all;
}

}  // namespace ergon
