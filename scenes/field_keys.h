#pragma once
// The keys of a param that varies: E = { formula = "E0*(1 + X[2]/L)", E0 = "1 MPa", L = "10 cm" }.

#include <memory>

#include "scenes/keys.h"

namespace ergon {

Section<FieldValue> field_section();

// Throws SourceError, also for what is wrong in the formula.
std::shared_ptr<const FieldValue> read_field(const toml::table& table, const std::string& file);

}  // namespace ergon
