#pragma once
#include <string>
#include <vector>

/// Where the resource of an FMU is, and what it holds.
namespace clutchwork::fmi {

/// A path from what an importer gives: a URI (file:///a%20b, file://localhost/a, file:/a) or a plain path.
std::string path_of(const char* location);

/// The path of this library; empty where the system does not tell.
std::string library_path();

bool read_file(const std::string& path, std::vector<unsigned char>& bytes);

/// The path of the resource below what an importer gives; beside this library where nothing is there.
std::string resource_path(const char* location);

}  // namespace clutchwork::fmi
