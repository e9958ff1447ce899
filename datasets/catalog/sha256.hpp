// SHA-256 of a file, through OpenSSL's libcrypto.
#pragma once

#include <filesystem>
#include <string>

#include "slam/core/result.hpp"

namespace corridor::catalog {

// Lower-case hexadecimal.
Result<std::string> sha256_of_file(const std::filesystem::path& path);

}  // namespace corridor::catalog
