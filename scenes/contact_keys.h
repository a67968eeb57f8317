#pragma once
// The tables [[obstacle]], [contact] and [[contact.pair]].

#include "scenes/keys.h"
#include "scenes/scene.h"

namespace ergon {

Section<SceneObstacle> obstacle_section();
Section<ContactSettings> contact_section();
// Names in [[contact.pair]] are those of objects and obstacles, which all differ. Throws SourceError.
void check_names(const Scene& scene);

}  // namespace ergon
