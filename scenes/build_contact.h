#pragma once
// The contact of a scene: which laws it takes, the half-spaces, the surfaces that collide.

#include <array>
#include <string>
#include <vector>

#include "scenes/builder.h"
#include "scenes/laws.h"
#include "scenes/used_kernels.h"

namespace ergon {

// Null where a scene does not need one.
struct ContactLaws {
  const Energy* ground = nullptr;
  const Energy* friction = nullptr;
  const Energy* friction_secant = nullptr;
  std::array<const Energy*, kContactKinds> surface{};  // by ContactKind; edge_edge and its parallel cases are one
};

bool has_friction(const ContactSettings& contact);

// Reads the laws; says in `skipped` what the scene does without.
ContactLaws contact_laws(const Scene& scene, Laws& laws, std::vector<std::string>& skipped);
void want_kernels(const ContactLaws& laws, UsedKernels& kernels);

// Adds contact to a scene whose bodies, system, masses and start are known.
void add_contact(const Scene& scene, const ContactLaws& laws, const UsedKernels& kernels, BuiltScene& out);

}  // namespace ergon
