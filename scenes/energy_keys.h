#pragma once
// The keys of [[object.energy]].

#include "scenes/keys.h"
#include "scenes/scene.h"

namespace ergon {

Section<EnergyUse> energy_section();

}  // namespace ergon
