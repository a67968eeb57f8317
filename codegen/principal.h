#pragma once
// Pass 6: the Hessian of an isotropic density in its principal frame. Establishes `principal` of the module: the blocks
// of the Hessian at F = diag(s), from which the runtime forms and projects it at any F by a singular value
// decomposition. They come from the differentiated graph by putting diag(s) into it, so no difference of singular
// values is ever divided by. Of a density in principal stretches, of which the graph knows derivatives by the stretches
// alone, flips are divided differences by algebra (codegen/divided_difference.h).
//
// Blocks, in order, with g(s) the density at diag(s):
//   solid (3x3 F)     stretch g_00 g_10 g_11 g_20 g_21 g_22; twist and flip of axes (1,2), (2,0), (0,1)
//   membrane (3x2 F)  stretch g_00 g_10 g_11; twist and flip of axes (0,1); normal g_0/s_0, g_1/s_1
//   line (3x1 F)      stretch g_00; normal g_0/s_0
// where twist = (g_i + g_j)/(s_i + s_j) and flip = (g_i - g_j)/(s_i - s_j), for a solid all twists before all flips.
//
// Source: Smith, de Goes, Kim 2019, Analytic eigensystems for isotropic distortion energies, TOG 38(1).

#include "codegen/module.h"

namespace ergon {

// Leaves `principal` empty for what is not isotropic (symbolic/isotropy.h) or needs no projection. Throws SourceError
// for a function of stretches of which no divided difference is known.
void find_principal(Module& module);

}  // namespace ergon
