#include "codegen/hash.h"

#include <cstdint>

#include <fmt/format.h>

namespace ergon {

std::string content_hash(std::string_view bytes) {
  constexpr std::uint64_t prime = 1099511628211ull;
  std::uint64_t a = 14695981039346656037ull, b = 0x6c62272e07bb0142ull;
  for (char c : bytes) {
    a = (a ^ static_cast<unsigned char>(c)) * prime;
    b = (b ^ (static_cast<unsigned char>(c) + 0x5bu)) * prime;
    b ^= b >> 29;
  }
  return fmt::format("{:016x}{:016x}", a, b);
}

}  // namespace ergon
