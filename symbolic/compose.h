#pragma once
// Laws of contact over distances. A barrier is a law over a gap; a distance gives the gap of one kind of stencil; both
// are written once, and every law is composed with every distance. What results is a stencil energy like any other.

#include <string>
#include <string_view>
#include <vector>

#include "symbolic/energy.h"

namespace ergon {

// With an offset the gap is the distance less `offset`, rest data of each stencil (m, at least 0).
enum class Offset { none, per_stencil };

// The energy of a barrier over a distance, with the cases of the distance; it requires that its gap is positive. Where
// a distance gives its square and there is no offset, gap2 is that square, without a root; of a distance that gives
// both forms, the one that the law uses is taken. Named "barrier:distance" or "barrier:distance:offset". Throws
// SourceError where the law declares a name that the distance declares too.
Energy compose(const Energy& barrier, const Energy& distance, Offset offset);

// "log_barrier:point_edge:offset" or "laws/mine.energy:point_edge" apart; `distance` is "" in the name of a file's own
// energy. Throws std::invalid_argument with what was expected.
struct ComposedName {
  std::string law;
  std::string distance;
  Offset offset = Offset::none;
};
ComposedName split_name(std::string_view name);

// All complete energies below a folder, sorted by name: those that its files hold, and each barrier over each distance,
// without and with offset. Throws SourceError.
std::vector<Energy> energies_below(const std::string& folder);

}  // namespace ergon
