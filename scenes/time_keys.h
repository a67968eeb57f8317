#pragma once
// The keys of [time].

#include "scenes/keys.h"
#include "scenes/scene.h"

namespace ergon {

Section<TimeSettings> time_section();

}  // namespace ergon
