#pragma once
// Projection of small symmetric matrices, one per lane. Included only by files in runtime/lanes.
