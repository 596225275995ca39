// The arrays of a run lie behind each other, and the sanitizer sees what runs over the end of one.

#include <clutchwork/workspace/arena.hpp>

#include "check.hpp"

using namespace clutchwork;

int test_arena() {
  alignas(16) static unsigned char memory[4096];
  double *first = nullptr, *second = nullptr, *empty = nullptr;
  Arena counted(nullptr), carved(memory);
  counted.take(first, 3), counted.take(empty, 0), counted.take(second, 2);
  CHECK(first == nullptr && counted.size() < std::int64_t(sizeof memory));
  carved.take(first, 3), carved.take(empty, 0), carved.take(second, 2);
  CHECK(carved.size() == counted.size());
  CHECK(reinterpret_cast<unsigned char*>(first) == memory && first + 3 <= empty && empty + 1 <= second);
  CHECK(reinterpret_cast<std::uintptr_t>(second) % 16 == 0);
#ifdef __SANITIZE_ADDRESS__
  CHECK(__asan_address_is_poisoned(first + 3) != 0 && __asan_address_is_poisoned(first + 2) == 0);
  drop_fences(memory, std::int64_t(sizeof memory));
  CHECK(__asan_address_is_poisoned(first + 3) == 0);
#endif
  return check::result();
}
