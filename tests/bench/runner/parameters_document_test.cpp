// baselines/parameters.md is what the parameter structs of the rivals say.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "bench/runner/systems.hpp"
#include "tests/support/documents.hpp"

namespace corridor::runner {
namespace {

constexpr const char* kDocument = "baselines/parameters.md";
constexpr const char* kWriteAnew =
    "CORRIDOR_WRITE_DOCUMENTS=1 build/release/bin/bench_runner_test "
    "--gtest_filter='ParametersDocument.*'";

// One row per parameter; a profile's value where it is not the first profile's.
std::string table_of(const SystemInfo& info) {
  std::string head = fmt::format("| parameter | unit | {}", info.profiles.front().name);
  std::string rule = "|---|---|---";
  for (std::size_t i = 1; i < info.profiles.size(); ++i) {
    head += fmt::format(" | {}", info.profiles[i].name);
    rule += "|---";
  }
  std::string text = fmt::format("{} | meaning |\n{}|---|\n", head, rule);
  const std::vector<ParamRow> rows = info.param_table(info.profiles.front().name);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    text += fmt::format("| `{}` | {} | {}", rows[row].name, rows[row].unit, rows[row].value);
    for (std::size_t i = 1; i < info.profiles.size(); ++i) {
      const std::string value = info.param_table(info.profiles[i].name)[row].value;
      text += fmt::format(" | {}", value == rows[row].value ? "" : value);
    }
    text += fmt::format(" | {} |\n", rows[row].meaning);
  }
  return text;
}

std::string document() {
  std::string text = fmt::format(
      "# Parameters of the rivals\n\nMade from the parameter structs; a test compares. Do not "
      "edit: "
      "`{}` writes it anew.\nAn empty field is the first profile's value.\n",
      kWriteAnew);
  for (const char* name : {"gmapping", "karto", "mrpt-icp", "mrpt-rbpf"}) {
    const SystemInfo info = *find_system(name);
    text += fmt::format("\n## {}\n\n", name);
    for (const ProfileInfo& profile : info.profiles) {
      text += fmt::format("- `{}@{}`: {}\n", name, profile.name, profile.description);
    }
    text += fmt::format("\n{}", table_of(info));
  }
  return text;
}

TEST(ParametersDocument, SaysWhatTheStructsSay) {
  if (std::getenv("CORRIDOR_WRITE_DOCUMENTS") != nullptr) {
    std::ofstream(std::filesystem::path(CORRIDOR_SOURCE_DIR) / kDocument) << document();
  }
  EXPECT_EQ(testing::text_of_document(kDocument), document()) << "write it anew: " << kWriteAnew;
}

}  // namespace
}  // namespace corridor::runner
