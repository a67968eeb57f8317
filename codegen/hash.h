#pragma once
// A 128-bit content hash (two FNV-1a runs with different offsets), for cache keys and for detecting damage; not
// cryptographic.

#include <string>
#include <string_view>

namespace ergon {

// 32 hexadecimal digits.
std::string content_hash(std::string_view bytes);

}  // namespace ergon
