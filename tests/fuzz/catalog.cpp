// The catalogue of data sets.
#include "datasets/catalog/catalog.hpp"

#include "tests/fuzz/inputs.hpp"
#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {

bool catalog(std::string_view bytes) {
  const MemoryFile file(bytes);
  return corridor::catalog::read_catalog(file.path()).has_value();
}

}  // namespace corridor::fuzz
