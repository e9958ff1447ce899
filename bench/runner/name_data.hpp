// Names for the data of a plan, under which a reader of the results tells them apart.
#pragma once

#include <string>
#include <vector>

#include "bench/runner/case_spec.hpp"
#include "bench/runner/systems.hpp"

namespace corridor::runner {

// One source of data, looked at once.
struct DataItem {
  DataKind kind = DataKind::kSimulated;
  std::string name;
  std::string source;  // as in CaseSpec
  std::string digest;
  LogSensors sensors = {};
};

// Data with their name as it is, unless others have it too: then files are named with as many of
// their folders as are needed, "monday/run" and "tuesday/run". A file given twice counts once.
std::vector<DataItem> with_own_names(std::vector<DataItem> items);

}  // namespace corridor::runner
