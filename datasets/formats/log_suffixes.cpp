// What the name of a log says: its format, and what else is named like it.
#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

#include "datasets/formats/log_io.hpp"

namespace corridor::formats {
namespace {

// Longer suffixes before those they end with.
constexpr std::array<std::pair<std::string_view, LogFormat>, 13> kSuffixes = {{
    {".clf", LogFormat::kCarmen},
    {".clf.gz", LogFormat::kCarmen},
    {".lcm.log", LogFormat::kLcm},
    {".lcm.log.gz", LogFormat::kLcm},
    {".log", LogFormat::kCarmen},
    {".log.gz", LogFormat::kCarmen},
    {".rawlog", LogFormat::kRawlog},
    {".rawlog.gz", LogFormat::kRawlog},
    {".bag", LogFormat::kRosbag},
    {".lcm", LogFormat::kLcm},
    {".lcm.gz", LogFormat::kLcm},
    {".dat", LogFormat::kTicks},
    {".dat.gz", LogFormat::kTicks},
}};

std::size_t known_suffix_length(std::string_view name) {
  for (const auto& [suffix, format] : kSuffixes) {
    if (name.ends_with(suffix)) return suffix.size();
  }
  return 0;
}

std::string suffixes_text(bool with_read_only) {
  std::string text;
  for (const auto& [suffix, format] : kSuffixes) {
    if (!with_read_only && !is_writable(format)) continue;
    if (!text.empty()) text += ' ';
    text += suffix;
  }
  return text;
}

}  // namespace

std::string_view to_text(LogFormat format) {
  switch (format) {
    case LogFormat::kCarmen:
      return "carmen";
    case LogFormat::kRawlog:
      return "rawlog";
    case LogFormat::kRosbag:
      return "rosbag";
    case LogFormat::kLcm:
      return "lcm";
    case LogFormat::kTicks:
      return "ticks";
  }
  return "unknown";
}

bool is_writable(LogFormat format) {
  return format != LogFormat::kLcm && format != LogFormat::kTicks;
}

std::optional<LogFormat> format_from_suffix(const std::filesystem::path& log) {
  const std::string name = log.filename().string();
  for (const auto& [suffix, format] : kSuffixes) {
    if (name.ends_with(suffix)) return format;
  }
  return std::nullopt;
}

std::string readable_suffixes() { return suffixes_text(/*with_read_only=*/true); }

std::string writable_suffixes() { return suffixes_text(/*with_read_only=*/false); }

std::filesystem::path sidecar_of(const std::filesystem::path& log, std::string_view suffix) {
  std::string name = log.filename().string();
  name.resize(name.size() - known_suffix_length(name));
  return log.parent_path() / (name + std::string(suffix));
}

std::vector<std::filesystem::path> namesakes_of(const std::filesystem::path& log) {
  std::vector<std::filesystem::path> found;
  for (const auto& [suffix, format] : kSuffixes) {
    std::filesystem::path other = sidecar_of(log, suffix);
    std::error_code error;
    if (other.filename() == log.filename() || !std::filesystem::is_regular_file(other, error))
      continue;
    found.push_back(std::move(other));
  }
  return found;
}

}  // namespace corridor::formats
