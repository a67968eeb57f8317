#pragma once
// The attachments of a scene: which vertices each joins, and their potentials. It establishes that every vertex in an
// attachment's box is joined, to something that is near enough.

#include <string>
#include <vector>

#include "scenes/builder.h"
#include "scenes/object_laws.h"

namespace ergon {

struct UsedAttachment {
  UsedLaw law;
  // The first of its places among those of the object, and of what that is joined to; set by add_places.
  int own_place = -1, to_place = -1;
  std::vector<int> stencils{};  // vertices of the scene, the joined vertex first; set by join
};

// Reads the laws and their params, in the order of the scene. Throws SourceError at the scene's line unless attachments
// of their kind can carry them.
std::vector<UsedAttachment> attachment_laws(const Scene& scene, Laws& laws);

// Gives the bodies the places that joints need of them. Throws SourceError at the scene's line for a body that carries
// no places.
void add_places(const Scene& scene, std::vector<Body>& bodies, std::vector<UsedAttachment>& attachments);

// Finds what is joined at the start of a scene whose bodies and system are known, and evaluates what varies over it.
// `folder` is what paths are relative to. Throws SourceError at the scene's line for a box without vertices, a vertex
// that has nothing near enough or only itself, a surface that is none, joints of which nothing moves.
void join(const Scene& scene, const BuiltScene& built, const std::string& folder,
          std::vector<UsedAttachment>& attachments);

// Adds the potentials to a scene whose start is known.
void add_attachments(const Scene& scene, const std::vector<UsedAttachment>& attachments, const UsedKernels& kernels,
                     BuiltScene& out);

}  // namespace ergon
