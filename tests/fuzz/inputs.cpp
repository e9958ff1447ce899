#include "tests/fuzz/inputs.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <stdexcept>
#include <string>

namespace corridor::fuzz {
namespace {

void write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t num_written = write(descriptor, bytes.data(), bytes.size());
    if (num_written <= 0) throw std::runtime_error("cannot write a file in memory");
    bytes.remove_prefix(static_cast<std::size_t>(num_written));
  }
}

}  // namespace

TwoParts split(std::string_view bytes) {
  const std::size_t end = bytes.find(kSeparator);
  if (end == std::string_view::npos) return {bytes, {}};
  return {bytes.substr(0, end), bytes.substr(end + kSeparator.size())};
}

MemoryFile::MemoryFile(std::string_view bytes, int place) : place_(place) {
  const int descriptor = memfd_create("fuzz", MFD_CLOEXEC);
  if (descriptor < 0 || dup2(descriptor, place_) < 0) {
    throw std::runtime_error("cannot make a file in memory");
  }
  close(descriptor);
  write_all(place_, bytes);
}

MemoryFile::~MemoryFile() { close(place_); }

std::filesystem::path MemoryFile::path() const { return "/proc/self/fd/" + std::to_string(place_); }

}  // namespace corridor::fuzz
