#include "scenes/law_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

namespace ergon {

std::string listed(std::vector<std::string> names) {
  if (names.size() < 2) return fmt::format("{}", fmt::join(names, ""));
  const std::string last = names.back();
  names.pop_back();
  return fmt::format("{} and {}", fmt::join(names, ", "), last);
}

bool is_rest_position(const Energy& energy, const Symbol& rest) {
  std::string dof = rest.name;
  dof[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(dof[0])));
  const Symbol* found = energy.find(dof);
  return dof != rest.name && found != nullptr && found->role == Role::dof && rest.shape == found->shape;
}

void check_always_acts(const Energy& energy, const Place& place, const char* carrier) {
  if (energy.cases.empty() && energy.active.empty()) return;
  throw SourceError(place, fmt::format("{} acts only under its conditions (case, active), as contact does; {} "
                                       "carries energies that always act",
                                       energy.name, carrier));
}

void check_lags(const Energy& energy, const Place& place, const std::vector<std::string>& given) {
  for (const Symbol* lag : energy.with_role(Role::lag)) {
    const auto of_point = [&](const Symbol* dof) {
      return lag->name == dof->name + "hat" || lag->name == dof->name + "lag";
    };
    if (energy.renews(lag->name) || std::find(given.begin(), given.end(), lag->name) != given.end()) continue;
    const std::vector<const Symbol*> dofs = energy.with_role(Role::dof);
    if (energy.kind == Energy::Kind::density && lag->name != "dt" && lag->name != "Flag")
      throw SourceError(place,
                        fmt::format("a scene does not renew the lag '{}' of {}: of a density it knows dt and Flag, "
                                    "and those that the density renews itself by `update`",
                                    lag->name, energy.name));
    if (energy.kind != Energy::Kind::density && lag->name != "dt" && std::none_of(dofs.begin(), dofs.end(), of_point))
      throw SourceError(place, fmt::format("a scene does not renew the lag '{}' of {}: it knows dt, xhat and xlag",
                                           lag->name, energy.name));
  }
}

void check_damping(const Energy& energy, const EnergyUse& use) {
  const Symbol* dt = energy.find("dt");
  if (use.stiffness_damping == 0 || dt == nullptr || dt->role != Role::lag) return;
  throw SourceError(use.at("stiffness_damping"),
                    fmt::format("{} damps itself (it has the lag dt) and stores no energy; 'stiffness_damping' belongs "
                                "to a law that does",
                                energy.name));
}

}  // namespace ergon
