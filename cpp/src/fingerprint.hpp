#pragma once
#include <cstdint>
#include <cstring>

/// Fingerprints of bytes, word by word.
namespace clutchwork {

/// One word more; every change of a single word changes the result.
inline std::uint64_t mix(std::uint64_t h, std::uint64_t word) {
  h = (h ^ word) * 0x9e3779b97f4a7c15u;
  return h ^ (h >> 32);
}

inline std::uint64_t fingerprint(const unsigned char* bytes, std::int64_t n) {
  std::uint64_t h = std::uint64_t(n), word;
  for (std::int64_t at = 0; at + 8 <= n; at += 8) std::memcpy(&word, bytes + at, 8), h = mix(h, word);
  return h;
}

/// What stands before a saved state, as words.
namespace state_head {
enum : std::int64_t { magic, schema, layout, system, size, checksum, words };
inline constexpr std::int64_t bytes = 8 * words;
inline constexpr std::uint64_t name = 0x3145544154535743u;  // CWSTATE1

/// The checksum of a state: of all its words but that one.
inline std::uint64_t checksum_of(const unsigned char* state, std::int64_t n) {
  return mix(fingerprint(state, 8 * checksum), fingerprint(state + bytes, n - bytes));
}
}  // namespace state_head

}  // namespace clutchwork
