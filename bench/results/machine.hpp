// The machine a result was measured on. Times of different machines are never compared.
#pragma once

#include <cstdint>
#include <string>

namespace corridor::results {

struct Machine {
  std::string machine_id;  // hash of everything below
  std::string cpu_model;
  std::int64_t num_cores = 0;
  std::int64_t memory_mib = 0;
  std::string kernel;
  std::string compiler;  // of this program

  bool operator==(const Machine&) const = default;
};

// Of the machine this runs on; what the system does not tell is "unknown" or 0.
Machine this_machine();

}  // namespace corridor::results
