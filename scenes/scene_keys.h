#pragma once
// Every key of a scene, table by table.

#include "scenes/keys.h"

namespace ergon {

Section<Scene> scene_section();

}  // namespace ergon
