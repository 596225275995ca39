#include "files.hpp"

#include <cstdio>
#include <cstring>
#ifdef _WIN32
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#elif defined(__APPLE__)
#include <dlfcn.h>
#else
#include <cstdint>
#include <cstdlib>
#endif

namespace clutchwork::fmi {

namespace {

constexpr const char* file_name = "model.cw";

int digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// Text with its percent signs resolved.
std::string decoded(const std::string& text) {
  std::string made;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escaped = text[i] == '%' && i + 2 < text.size() && digit(text[i + 1]) >= 0 && digit(text[i + 2]) >= 0;
    made += escaped ? char(16 * digit(text[i + 1]) + digit(text[i + 2])) : text[i];
    if (escaped) i += 2;
  }
  return made;
}

bool starts_with(const std::string& text, const char* head) { return text.compare(0, std::strlen(head), head) == 0; }

/// The folder that holds a path.
std::string above(const std::string& path) {
  const std::size_t at = path.find_last_of("/\\");
  return at == std::string::npos ? "." : path.substr(0, at);
}

std::FILE* opened(const std::string& path) {
#ifdef _WIN32
  wchar_t wide[4096];
  if (MultiByteToWideChar(CP_UTF8, 0, path.c_str(), -1, wide, 4096) == 0) return nullptr;
  return _wfopen(wide, L"rb");
#else
  return std::fopen(path.c_str(), "rb");
#endif
}

bool is_there(const std::string& path) {
  std::FILE* file = opened(path);
  if (file != nullptr) std::fclose(file);
  return file != nullptr;
}

}  // namespace

std::string path_of(const char* location) {
  if (location == nullptr) return "";
  std::string path = location;
  if (!starts_with(path, "file:")) return path;
  path = decoded(path.substr(5));
  if (starts_with(path, "//localhost/")) path = path.substr(11);
  if (starts_with(path, "//")) path = path.substr(2);
#ifdef _WIN32
  // "/C:/folder"
  if (path.size() > 2 && path[0] == '/' && path[2] == ':') path = path.substr(1);
#endif
  return path;
}

std::string library_path() {
#ifdef _WIN32
  HMODULE module = nullptr;
  wchar_t wide[4096];
  char path[3 * 4096];
  const DWORD by_address = GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT;
  if (!GetModuleHandleExW(by_address, reinterpret_cast<LPCWSTR>(&library_path), &module)) return "";
  if (GetModuleFileNameW(module, wide, 4096) == 0) return "";
  if (WideCharToMultiByte(CP_UTF8, 0, wide, -1, path, sizeof path, nullptr, nullptr) == 0) return "";
  return path;
#elif defined(__APPLE__)
  Dl_info found;
  return dladdr(reinterpret_cast<void*>(&library_path), &found) != 0 ? found.dli_fname : "";
#else
  // the mapped file that this function is in; dladdr would need a newer libc
  std::FILE* maps = std::fopen("/proc/self/maps", "r");
  const auto here = reinterpret_cast<std::uintptr_t>(&library_path);
  char line[4096 + 256];
  std::string found;
  while (maps != nullptr && found.empty() && std::fgets(line, sizeof line, maps) != nullptr) {
    char* after = nullptr;
    const auto low = std::uintptr_t(std::strtoull(line, &after, 16));
    const auto high = std::uintptr_t(std::strtoull(after + (*after == '-'), nullptr, 16));
    const char* path = std::strchr(line, '/');
    if (here >= low && here < high && path != nullptr) found = std::string(path, std::strcspn(path, "\n"));
  }
  if (maps != nullptr) std::fclose(maps);
  return found;
#endif
}

bool read_file(const std::string& path, std::vector<unsigned char>& bytes) {
  std::FILE* file = opened(path);
  if (file == nullptr) return false;
  unsigned char part[4096];
  for (std::size_t n; (n = std::fread(part, 1, sizeof part, file)) > 0;) bytes.insert(bytes.end(), part, part + n);
  const bool done = std::ferror(file) == 0;
  std::fclose(file);
  return done;
}

std::string resource_path(const char* location) {
  std::string folder = path_of(location);
  while (folder.size() > 1 && (folder.back() == '/' || folder.back() == '\\')) folder.pop_back();
  const std::string given = folder + "/" + file_name;
  if (!folder.empty() && is_there(given)) return given;
  // binaries/PLATFORM/LIBRARY
  const std::string own = library_path();
  if (own.empty()) return given;
  const std::string beside = above(above(above(own))) + "/resources/" + file_name;
  return is_there(beside) || folder.empty() ? beside : given;
}

}  // namespace clutchwork::fmi
