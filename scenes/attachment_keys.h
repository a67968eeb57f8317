#pragma once
// The table [[attachment]].

#include "scenes/keys.h"
#include "scenes/scene.h"

namespace ergon {

Section<SceneAttachment> attachment_section();
// Names in [[attachment]] are those of objects, or of what they may be attached to. Throws SourceError.
void check_attachments(const Scene& scene);

}  // namespace ergon
