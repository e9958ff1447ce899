// The topics of a bag as tables of a TOML document that is parsed already: the door behind
// bag_topics.hpp, for those whose document holds more. Internal to datasets/: it shows the TOML
// library, so only .cpp files include it.
#pragma once

#include <toml++/toml.h>

#include <vector>

#include "datasets/formats/bag/bag_topics.hpp"
#include "datasets/formats/toml_problems.hpp"

namespace corridor::formats {

// The tables [topics] and [joints]; what else the document holds is not looked at.
BagTopics read_bag_topics(const toml::table& document, std::vector<TomlProblem>& problems);

}  // namespace corridor::formats
