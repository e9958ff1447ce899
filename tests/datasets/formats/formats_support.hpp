// Shared by the tests of the formats: text files and a small log.
#pragma once

#include <filesystem>
#include <string>

#include "slam/core/sensor_log.hpp"
#include "tests/support/scratch_folder.hpp"

namespace corridor::formats::test {

using testing::ScratchFolder;

void write_text(const std::filesystem::path& path, const std::string& text);
std::string read_text(const std::filesystem::path& path);

// Four scans of 8 beams (one without return), wheel samples with ticks at each scan and between,
// IMU at 100 Hz; stamps are multiples of 100 ns; angles and limits are exact in 32-bit floats.
SensorLog small_log();

// Equality of everything a log holds but its provenance.
bool same_events(const SensorLog& a, const SensorLog& b);

}  // namespace corridor::formats::test
