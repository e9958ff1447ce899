// SHA-256 [FIPS 180-4] through OpenSSL's libcrypto: the one place of the tree that computes it.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

#include "slam/core/result.hpp"

namespace corridor::catalog {

using Sha256 = std::array<unsigned char, 32>;

Sha256 sha256_of(std::string_view bytes);

// Lower-case hexadecimal.
std::string to_hex(const Sha256& digest);

// The same of a file's bytes; an Error if it cannot be read to its end.
Result<std::string> sha256_of_file(const std::filesystem::path& path);

}  // namespace corridor::catalog
