#include <cstdlib>
#include <new>

/// What containers call of the C++ library. Without exceptions there is nothing left to do where memory ends, and with
/// these here no FMU needs a runtime library, or a version of one.

void* operator new(std::size_t n) {
  void* made = std::malloc(n > 0 ? n : 1);
  if (made == nullptr) std::abort();
  return made;
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

#ifdef __GLIBCXX__
namespace std {
[[noreturn]] void __throw_bad_alloc() { std::abort(); }
[[noreturn]] void __throw_bad_array_new_length() { std::abort(); }
[[noreturn]] void __throw_length_error(const char*) { std::abort(); }
[[noreturn]] void __throw_logic_error(const char*) { std::abort(); }
[[noreturn]] void __throw_out_of_range_fmt(const char*, ...) { std::abort(); }
}  // namespace std
#endif
