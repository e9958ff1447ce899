// What fuzzing found stays found: every known input goes through its target in every build, so that
// neither clang nor libFuzzer is needed. Seeds must be read, too: a seed that its reader refuses at
// the first byte leads a fuzzer nowhere.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {
namespace {

namespace fs = std::filesystem;

struct Target {
  const char* name;
  bool (*read)(std::string_view bytes);
};

constexpr std::array<Target, 23> kTargets = {{{"bag", bag},
                                              {"bag_chunk", bag_chunk},
                                              {"bag_framing", bag_framing},
                                              {"carmen", carmen},
                                              {"carmen_trajectory", carmen_trajectory},
                                              {"catalog", catalog},
                                              {"euroc", euroc},
                                              {"gzip", gzip},
                                              {"kitti", kitti},
                                              {"lcm", lcm},
                                              {"pose_graph", pose_graph},
                                              {"rawlog", rawlog},
                                              {"rawlog_framing", rawlog_framing},
                                              {"relations", relations},
                                              {"robot_toml", robot_toml},
                                              {"ros_map", ros_map},
                                              {"scenario", scenario},
                                              {"ticks", ticks},
                                              {"topics", topics},
                                              {"true_poses", true_poses},
                                              {"truth", truth},
                                              {"tum", tum},
                                              {"world", world}}};

fs::path folder_of(const char* kind) { return fs::path(CORRIDOR_SOURCE_DIR) / "tests/fuzz" / kind; }

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!fs::exists(folder)) return files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

// Exactly as long as the file: AddressSanitizer sees a reader that goes on behind the end.
std::vector<char> bytes_of(const fs::path& path) {
  std::vector<char> bytes(fs::file_size(path));
  std::ifstream(path, std::ios::binary)
      .read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return bytes;
}

bool is_read(const Target& target, const fs::path& path) {
  const std::vector<char> bytes = bytes_of(path);
  return target.read({bytes.data(), bytes.size()});
}

void PrintTo(const Target& target, std::ostream* out) { *out << target.name; }

class FuzzRegressions : public ::testing::TestWithParam<Target> {};

TEST_P(FuzzRegressions, SeedsAreRead) {
  const std::vector<fs::path> seeds = files_in(folder_of("corpus") / GetParam().name);
  EXPECT_FALSE(seeds.empty());
  for (const fs::path& seed : seeds) EXPECT_TRUE(is_read(GetParam(), seed)) << seed;
}

// Each was a crash, a hang or an allocation without bounds once: to come back is to pass.
TEST_P(FuzzRegressions, WhatWasFoundComesBack) {
  for (const fs::path& input : files_in(folder_of("regressions") / GetParam().name)) {
    SCOPED_TRACE(input);
    is_read(GetParam(), input);
  }
}

TEST_P(FuzzRegressions, ASeedCutAnywhereComesBack) {
  constexpr std::size_t kMaxCuts = 64;
  for (const fs::path& seed : files_in(folder_of("corpus") / GetParam().name)) {
    const std::vector<char> whole = bytes_of(seed);
    const std::size_t step = whole.size() / kMaxCuts + 1;
    for (std::size_t size = 0; size < whole.size(); size += step) {
      const std::vector<char> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
      GetParam().read({cut.data(), cut.size()});
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, FuzzRegressions, ::testing::ValuesIn(kTargets),
                         [](const auto& target) { return std::string(target.param.name); });

TEST(FuzzFolders, EachBelongsToATarget) {
  std::set<std::string> known;
  for (const Target& target : kTargets) known.insert(target.name);
  for (const char* kind : {"corpus", "regressions"}) {
    for (const fs::path& folder : files_in(folder_of(kind))) {
      EXPECT_TRUE(known.contains(folder.filename().string())) << folder;
    }
  }
}

TEST(FuzzFolders, SeedsAreSmall) {
  constexpr std::uintmax_t kMaxBytes = 16'384;
  for (const fs::path& folder : files_in(folder_of("corpus"))) {
    for (const fs::path& seed : files_in(folder)) EXPECT_LE(fs::file_size(seed), kMaxBytes) << seed;
  }
}

}  // namespace
}  // namespace corridor::fuzz
