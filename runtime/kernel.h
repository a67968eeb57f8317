#pragma once
// What the runtime knows of a compiled energy: this plain C struct, found in a kernel library by the symbol
// `ergon_kernel`. Nothing else crosses the border between compiler and runtime.
//
// A kernel is a function of q = (weights (x) I3) x: `q_vectors` 3-vectors, each a weighted sum of the stencil's points.
// For a stencil energy the weights are constants found by the frontier pass; for a density q is F, column by column,
// and the weights are the gradients of the element's shape functions at a quadrature point, which the runtime supplies.
// The chain to points and the projection of the Hessian are the runtime's.
//
// Lane layout: every array below is [component][lanes], aligned to 64 bytes. The library is built for one width.

#ifdef __cplusplus
extern "C" {
#endif

#define ERGON_KERNEL_ABI 7

enum ErgonRole { ERGON_PARAM = 0, ERGON_REST = 1, ERGON_LAG = 2 };

typedef struct ErgonInput {
  const char* name;
  int role; /* ErgonRole */
  int rows;
  int cols;
  int offset; /* first component in `params` (ERGON_PARAM) or in the raw element data (rest and lag) */
} ErgonInput;

/* Entry points in single precision: as those of ErgonKernel, over floats. Params and raw data stay double. */
typedef struct ErgonSingle {
  void (*prepare_uniforms)(const double* params, float* u);
  void (*prepare_elements)(const double* raw, const float* u, float* e);
  void (*conditions)(const float* q, const float* e, const float* u, float* active, float* require);
  void (*value)(const float* q, const float* e, const float* u, float* value, float* require);
  void (*gradient)(const float* q, const float* e, const float* u, float* value, float* gradient);
  void (*hessian)(const float* q, const float* e, const float* u, float* value, float* gradient, float* hessian);
  void (*principal)(const float* s, const float* e, const float* u, float* blocks);
  void (*projected)(const float* q, const float* e, const float* u, float negative, float* value, float* gradient,
                    float* hessian, float* changed);
} ErgonSingle;

typedef struct ErgonKernel {
  int abi;
  int lanes;
  const char* energy;    /* name in the energy file */
  const char* case_name; /* "" when the energy has no cases */
  const char* geometry;  /* "solid", "membrane", "line", or the stencil: "point", "edge", ... */
  int density;           /* 1: weights come from elements; value is per rest volume (area, length) */
  int points;            /* points of the stencil; 0 for a density */
  int q_vectors;         /* 3-vectors in q: 3 for a solid's F, 2 for a membrane's */
  const double* weights; /* stencil: [q_vectors][points], row by row; 0 for a density */

  int n_inputs;
  const ErgonInput* inputs;
  int params;    /* doubles in `params` */
  int raw;       /* doubles of raw rest and lag data per element */
  int uniforms;  /* doubles that prepare_uniforms writes */
  int elements;  /* doubles per lane that prepare_elements writes */
  int requires_; /* number of `require` margins */
  int actives;   /* number of `active` margins */

  int constant_gradient; /* the gradient does not depend on q */
  int constant_hessian;  /* the Hessian does not depend on q */
  int zero_hessian;
  int psd_hessian; /* positive semi-definite by construction: no projection needed */

  int operations_value; /* per lane, counted on the graph */
  int operations_gradient;
  int operations_hessian;
  int divisions_hessian;

  /* Once per material: params[params] -> u[uniforms]. */
  void (*prepare_uniforms)(const double* params, double* u);
  /* When rest, lag or params change: raw[raw][lanes] -> e[elements][lanes]. */
  void (*prepare_elements)(const double* raw, const double* u, double* e);
  /* Margins, positive where the condition holds: active[actives][lanes], require[requires_][lanes]. */
  void (*conditions)(const double* q, const double* e, const double* u, double* active, double* require);
  /* value[lanes]; require[lanes] is the smallest margin (+inf when there is none). */
  void (*value)(const double* q, const double* e, const double* u, double* value, double* require);
  /* gradient[3*q_vectors][lanes] */
  void (*gradient)(const double* q, const double* e, const double* u, double* value, double* gradient);
  /* hessian: lower triangle packed by rows, entry (i, j <= i) at i*(i+1)/2 + j */
  void (*hessian)(const double* q, const double* e, const double* u, double* value, double* gradient, double* hessian);

  const char* const* point_names; /* stencil: [points], the names of its dofs; 0 for a density */

  /* 1: q of a density is F - I, so the weights are applied to x - X; of a membrane or line in the axes of the element
     at rest, where I is the first columns of the identity */
  int displacement;

  /* An isotropic density; otherwise 0. Blocks of the Hessian with respect to F at F = diag(s), s[q_vectors][lanes]:
     their order is in codegen/principal.h; 12, 7 or 2 of them for 3, 2 or 1 vectors. */
  void (*principal)(const double* s, const double* e, const double* u, double* blocks);
  int operations_principal;

  /* The projected Hessian where the compiler knows it in closed form, else 0: as hessian, with every eigenvalue x < 0
     replaced by -x*negative (0: clamped, 1: its absolute value). changed[lanes] is positive where there was one. */
  void (*projected)(const double* q, const double* e, const double* u, double negative, double* value, double* gradient,
                    double* hessian, double* changed);

  /* Where this is not 0 the kernel is one in single precision: these are its entry points, and those above are 0. */
  const ErgonSingle* single;

  /* Where this is not 0 the Hessian falls apart: parts[q_vectors], the part of each 3-vector of q, numbered from 0 in
     order of their first vectors, -1 for one that is in no entry. `hessian` then writes the lower triangles of the
     parts, each packed by rows over its vectors in ascending order, one after the other. */
  const int* parts;

  /* 1: a density in principal stretches. In conditions, value, gradient and hessian q is then s[q_vectors][lanes], the
     singular values of F (signs as in runtime/lanes/svd3.h), or, with `displacement`, those less 1, and derivatives are
     by these; principal is never 0. runtime/lanes/stretch_frame.h leads from F and back. */
  int stretches;

  /* Lags that the energy renews itself once a step has ended: their numbers among `inputs`, and their new values at the
     end of the step, one lag after the other: renewed[...][lanes]. 0 without any; never in single precision. */
  int n_updates;
  const int* updates;
  void (*update)(const double* q, const double* e, const double* u, double* renewed);
} ErgonKernel;

#ifdef __cplusplus
}
#endif
