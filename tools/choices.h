#pragma once
// Options that several commands share.

#include <string>
#include <string_view>
#include <vector>

#include "runtime/potential.h"
#include "tools/installation.h"

namespace ergon {

// clamp, abs, none. Throws InputError naming the nearest.
Projection projection_named(const std::string& name);

// double, float, mixed. Throws InputError naming the nearest.
Precision precision_named(const std::string& name);

// Of this process, for all that runs in parallel. Throws InputError below 1.
void set_threads(int threads);

// Picks `word` out of `choices`. Throws InputError "OPTION: ..." naming the nearest.
size_t chosen(std::string_view option, const std::string& word, const std::vector<std::string>& choices);

}  // namespace ergon
