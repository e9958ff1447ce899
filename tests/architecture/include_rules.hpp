// Which part of the tree may include which: the arrows of slam/README.md, section "One direction",
// and the doors of the heavy packages, section "Doors". The tables in the .cpp are those two
// sections.
#pragma once

#include <string>
#include <vector>

#include "tests/architecture/source_tree.hpp"

namespace corridor::architecture {

// Every #include "..." that names no file of ours from the root, or follows no allowed arrow.
std::vector<std::string> forbidden_arrows(const SourceTree& tree);

// Every #include <package/...> of a heavy package outside its door, or in a header.
std::vector<std::string> packages_outside_their_door(const SourceTree& tree);

// Every .cpp that has a header of the same name and does not include it first: the order by which
// the build itself proves that the header compiles alone.
std::vector<std::string> own_headers_not_first(const SourceTree& tree);

// Headers that no .cpp of the same name includes first; the build compiles a file of its own for
// each. That list is made by CMake; this is what it must contain.
std::vector<std::string> headers_without_source(const SourceTree& tree);

}  // namespace corridor::architecture
