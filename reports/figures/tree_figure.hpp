// A Bayes tree before and after an update, side by side: which cliques were taken out, which are
// new, which were eliminated again where they are and which nothing happened to. The states differ
// in their outlines, not in colour alone.
#pragma once

#include <string>

#include "slam/backend/isam2/tree_snapshot.hpp"

namespace corridor::figures {

// An SVG file. `title` says of what; the same trees give the same bytes.
std::string tree_svg(const std::string& title, const backend::TreeSnapshot& before,
                     const backend::TreeSnapshot& after);

}  // namespace corridor::figures
