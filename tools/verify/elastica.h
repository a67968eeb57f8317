#pragma once
// Closed forms of the planar bending of an inextensible beam of length 1 that is clamped level at one end.

namespace ergon {

struct ElasticaTip {
  double down, back;  // of its free end from where it was, in lengths of the beam
};

// Under a force P at its tip that keeps its direction, down; load = P L^2/(EI), from 0 on. Bisshopp, Drucker 1945,
// Large deflection of cantilever beams, Quart. Appl. Math. 3: elliptic integrals.
ElasticaTip elastica_tip(double load);

// Under its own weight; load = rho g A L^3/(EI): theta'' = -load (1 - s) cos(theta), theta(0) = 0, theta'(1) = 0.
ElasticaTip heavy_elastica_tip(double load);

}  // namespace ergon
