// Reading catalog.toml: every key checked, every violation listed.
#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "datasets/catalog/catalog.hpp"
#include "datasets/catalog/public_url.hpp"
#include "datasets/formats/bag/bag_topics.hpp"
#include "datasets/formats/file_bytes.hpp"
#include "datasets/formats/robot_toml.hpp"

namespace corridor::catalog {
namespace {

constexpr std::size_t kSha256Digits = 64;
constexpr std::array<std::string_view, 15> kKeys = {"name",
                                                    "title",
                                                    "format",
                                                    "files",
                                                    "truth",
                                                    "order",
                                                    "licence",
                                                    "source",
                                                    "topics",
                                                    "joints",
                                                    "cut_after_s",
                                                    "calibration",
                                                    "no_return_range_m",
                                                    "not_fetchable",
                                                    "order_of_other_files"};
constexpr std::array<std::string_view, 4> kFileKeys = {"path", "sha256", "content_sha256", "url"};

bool is_sha256(std::string_view text) {
  return text.size() == kSha256Digits &&
         text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

constexpr const char* kFileForm =
    R"(expected { path = "...", sha256 = "..." or content_sha256 = "...", url = "..." or none })";

class EntryReader {
 public:
  EntryReader(const toml::table& table, const std::string& where, std::vector<std::string>& wrong)
      : table_(table), where_(where), wrong_(wrong) {}

  CatalogEntry read() {
    for (const auto& [key, node] : table_) {
      if (std::find(kKeys.begin(), kKeys.end(), key.str()) == kKeys.end()) {
        complain(std::string(key.str()), "unknown key");
      }
    }
    entry_.name = text("name");
    entry_.title = text("title");
    entry_.format = text("format");
    entry_.licence = text("licence");
    entry_.source = text("source");
    take_files();
    take_fetching();
    take_choices();
    entry_.no_return_range_m = positive_number("no_return_range_m");
    entry_.cut_after_s = positive_number("cut_after_s");
    take_calibration();
    take_topics();
    return std::move(entry_);
  }

 private:
  void complain(const std::string& key, const std::string& what) {
    wrong_.push_back(fmt::format("line {}: {}: {}", table_.source().begin.line, key, what));
  }

  std::string text(std::string_view key) {
    const auto value = table_[key].value<std::string>();
    if (!value || value->empty()) complain(std::string(key), "missing or not a text");
    return value.value_or("");
  }

  void take_files() {
    const toml::array* files = table_["files"].as_array();
    if (files == nullptr || files->empty()) {
      complain("files", "missing, empty or not a list");
      return;
    }
    for (const toml::node& node : *files) {
      if (const toml::table* file = node.as_table()) {
        take_file(*file);
      } else {
        complain("files", kFileForm);
      }
    }
  }

  void take_file(const toml::table& table) {
    const auto path = table["path"].value<std::string>();
    const auto sha256 = table["sha256"].value<std::string>();
    const auto content_sha256 = table["content_sha256"].value<std::string>();
    const auto url = table["url"].value<std::string>();
    bool is_known = true;
    for (const auto& [key, node] : table) {
      is_known = is_known && node.is_string() &&
                 std::find(kFileKeys.begin(), kFileKeys.end(), key.str()) != kFileKeys.end();
    }
    if (!is_known || !path || sha256.has_value() == content_sha256.has_value()) {
      complain("files", kFileForm);
      return;
    }
    DataFile file{*path, sha256.value_or(content_sha256.value_or("")), content_sha256.has_value(),
                  url.value_or("")};
    if (!is_sha256(file.sha256)) {
      complain("files", "sha256 of " + *path + " is not 64 lower-case hexadecimal digits");
    }
    if (url) {
      if (const auto good = check_public_url(*url); !good) {
        complain("files", "url of " + *path + ": " + good.error().to_line());
      }
    }
    const std::filesystem::path relative = file.path.lexically_normal();
    if (path->empty() || relative.is_absolute() || *relative.begin() == ".." ||
        !relative.has_filename()) {
      complain("files", *path + " does not lie in a data folder");
    }
    entry_.files.push_back(std::move(file));
  }

  // What cannot be fetched says why, and nothing else does.
  void take_fetching() {
    if (table_.contains("not_fetchable")) entry_.not_fetchable = text("not_fetchable");
    if (entry_.files.empty()) return;
    const bool has_urls = std::all_of(entry_.files.begin(), entry_.files.end(),
                                      [](const DataFile& file) { return !file.url.empty(); });
    if (has_urls == entry_.not_fetchable.empty()) return;
    complain("not_fetchable", has_urls ? "every file has a url; expected no such key"
                                       : "missing; expected the reason, or a url of every file");
  }

  void take_choices() {
    const std::string truth = text("truth");
    if (truth == "tum") {
      entry_.truth = TruthKind::kTum;
    } else if (truth == "relations") {
      entry_.truth = TruthKind::kRelations;
    } else if (truth == "reference") {
      entry_.truth = TruthKind::kReference;
    } else if (truth != "none") {
      complain("truth", "expected tum, relations, reference or none");
    }
    entry_.order = order("order");
    if (table_.contains("order_of_other_files")) {
      entry_.order_of_other_files = order("order_of_other_files");
    }
  }

  formats::StampOrder order(std::string_view key) {
    const std::string stated = text(key);
    if (stated != "stamp" && stated != "file") complain(std::string(key), "expected stamp or file");
    return stated == "file" ? formats::StampOrder::kFile : formats::StampOrder::kStamp;
  }

  std::optional<double> positive_number(std::string_view key) {
    const auto node = table_[key];
    if (!node) return std::nullopt;
    const auto value = node.value<double>();
    if (!value || !(*value > 0) || !std::isfinite(*value)) {
      complain(std::string(key), "expected a number > 0");
    }
    return value;
  }

  void take_calibration() {
    const auto node = table_["calibration"];
    if (!node) return;
    if (!node.is_table()) {
      complain("calibration", "not a table");
      return;
    }
    std::ostringstream toml_text;
    toml_text << toml::default_formatter(*node.as_table());
    auto stated = formats::override_robot(
        RobotModel{}, toml_text.str(), fmt::format("{}: calibration of {}", where_, entry_.name));
    if (!stated) {
      wrong_.push_back(stated.error().to_line());
    } else {
      entry_.robot = std::move(stated->robot);
      entry_.raw = stated->raw;
    }
  }

  // The tables [topics] and [joints] of LOG.topics.toml, as keys of the entry.
  void take_topics() {
    toml::table stated;
    for (const char* key : {"topics", "joints"}) {
      if (const toml::node* node = table_.get(key)) stated.insert(key, *node);
    }
    if (stated.empty()) return;
    if (entry_.format != "rosbag") {
      complain("topics", "only a rosbag has topics");
      return;
    }
    std::ostringstream toml_text;
    toml_text << toml::default_formatter(stated);
    auto topics = formats::bag_topics_from_toml(
        toml_text.str(), fmt::format("{}: topics of {}", where_, entry_.name));
    if (!topics) {
      wrong_.push_back(topics.error().to_line());
    } else {
      entry_.topics = std::move(*topics);
    }
  }

  const toml::table& table_;
  const std::string& where_;
  std::vector<std::string>& wrong_;
  CatalogEntry entry_;
};

void refuse_repeated_names(const Catalog& catalog, std::vector<std::string>& wrong) {
  for (const CatalogEntry& entry : catalog.entries) {
    if (catalog.find(entry.name) != &entry) {
      wrong.push_back(fmt::format("name {} is given twice", entry.name));
    }
  }
}

Catalog take_catalog(const toml::table& document, const std::string& where,
                     std::vector<std::string>& wrong) {
  Catalog catalog;
  for (const auto& [key, node] : document) {
    if (key.str() != "dataset") wrong.push_back(fmt::format("{}: unknown key", key.str()));
  }
  const toml::array* datasets = document["dataset"].as_array();
  if (datasets == nullptr) {
    wrong.emplace_back("dataset: missing or not a list of tables");
    return catalog;
  }
  for (const toml::node& node : *datasets) {
    const toml::table* table = node.as_table();
    if (table == nullptr) {
      wrong.emplace_back("dataset: not a table");
      continue;
    }
    catalog.entries.push_back(EntryReader(*table, where, wrong).read());
  }
  refuse_repeated_names(catalog, wrong);
  return catalog;
}

}  // namespace

Result<Catalog> read_catalog(const std::filesystem::path& path) {
  const auto text = formats::read_file_bytes(path);
  if (!text) return tl::make_unexpected(text.error());
  toml::table document;
  try {
    document = toml::parse(std::string_view(*text));
  } catch (const toml::parse_error& error) {
    return fail(ErrorCode::kMalformed, std::string(error.description()),
                fmt::format("{}:{}", path.string(), error.source().begin.line), "TOML");
  }
  std::vector<std::string> wrong;
  Catalog catalog = take_catalog(document, path.string(), wrong);
  if (!wrong.empty()) {
    return fail(ErrorCode::kInvalid, fmt::format("{}", fmt::join(wrong, "; ")), path.string(),
                "a valid catalogue");
  }
  return catalog;
}

}  // namespace corridor::catalog
