#pragma once
// Text inside XML attributes.

#include <string>
#include <string_view>

namespace ergon {

// `text` with the characters that XML keeps for itself replaced; control characters become '?'.
std::string xml_text(std::string_view text);

}  // namespace ergon
