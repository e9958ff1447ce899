#include "datasets/catalog/entry_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "datasets/catalog/entry_files.hpp"
#include "datasets/catalog/public_url.hpp"
#include "datasets/formats/bag/topics_table.hpp"
#include "datasets/formats/robot_table.hpp"
#include "datasets/formats/toml_text.hpp"

namespace corridor::catalog {
namespace {

constexpr std::size_t kSha256Digits = 64;
constexpr std::array kKeys = {"name",
                              "title",
                              "format",
                              "files",
                              "truth",
                              "order",
                              "licence",
                              "source",
                              "topics",
                              "joints",
                              "best_chi2",
                              "cut_after_s",
                              "calibration",
                              "companions",
                              "no_return_range_m",
                              "not_fetchable",
                              "best_chi2_source",
                              "order_of_other_files",
                              "companions_not_fetchable"};
constexpr std::array<std::string_view, 4> kFileKeys = {"path", "sha256", "content_sha256", "url"};

bool is_sha256(std::string_view text) {
  return text.size() == kSha256Digits &&
         text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

constexpr const char* kFileForm =
    R"(expected { path = "...", sha256 = "..." or content_sha256 = "...", url = "..." or none })";

class EntryReader {
 public:
  EntryReader(const toml::table& table, std::vector<formats::TomlProblem>& problems)
      : table_(table), problems_(problems) {}

  CatalogEntry read() {
    const std::size_t num_problems_before = problems_.size();
    formats::find_unknown_keys(table_, "", {kKeys.begin(), kKeys.end()}, problems_);
    entry_.name = text("name");
    entry_.title = text("title");
    entry_.format = text("format");
    entry_.licence = text("licence");
    entry_.source = text("source");
    take_files();
    take_fetching();
    take_companions();
    take_choices();
    entry_.no_return_range_m = positive_number("no_return_range_m");
    entry_.cut_after_s = positive_number("cut_after_s");
    take_best_chi2();
    take_calibration();
    take_topics();
    if (problems_.size() == num_problems_before) {
      for (const EntryProblem& problem : unfit_files(entry_)) complain(problem.key, problem.what);
    }
    return std::move(entry_);
  }

 private:
  void complain(std::string_view key, std::string_view what) {
    const toml::node* node = table_.get(key);
    complain(node == nullptr ? table_ : *node, key, what);
  }

  void complain(const toml::node& node, std::string_view key, std::string_view what) {
    problems_.push_back({node.source().begin.line, fmt::format("{}: {}", key, what)});
  }

  std::string text(std::string_view key) {
    const auto value = table_[key].value<std::string>();
    if (!value || value->empty()) complain(key, "missing or not a text");
    return value.value_or("");
  }

  void take_files() {
    const toml::array* files = table_["files"].as_array();
    if (files == nullptr || files->empty()) complain("files", "missing, empty or not a list");
    entry_.files = files_of("files");
  }

  std::vector<DataFile> files_of(std::string_view key) {
    std::vector<DataFile> taken;
    const toml::array* files = table_[key].as_array();
    if (files == nullptr) return taken;
    for (const toml::node& node : *files) {
      if (const toml::table* file = node.as_table()) {
        if (auto good = file_of(*file, key)) taken.push_back(std::move(*good));
      } else {
        complain(node, key, kFileForm);
      }
    }
    return taken;
  }

  std::optional<DataFile> file_of(const toml::table& table, std::string_view key) {
    const auto path = table["path"].value<std::string>();
    const auto sha256 = table["sha256"].value<std::string>();
    const auto content_sha256 = table["content_sha256"].value<std::string>();
    const auto url = table["url"].value<std::string>();
    bool is_known = true;
    for (const auto& [file_key, node] : table) {
      is_known = is_known && node.is_string() &&
                 std::find(kFileKeys.begin(), kFileKeys.end(), file_key.str()) != kFileKeys.end();
    }
    if (!is_known || !path || sha256.has_value() == content_sha256.has_value()) {
      complain(table, key, kFileForm);
      return std::nullopt;
    }
    DataFile file{*path, sha256.value_or(content_sha256.value_or("")), content_sha256.has_value(),
                  url.value_or("")};
    if (!is_sha256(file.sha256)) {
      complain(table, key, "sha256 of " + *path + " is not 64 lower-case hexadecimal digits");
    }
    if (url) {
      if (const auto good = check_public_url(*url); !good) {
        complain(table, key, "url of " + *path + ": " + good.error().to_line());
      }
    }
    const std::filesystem::path relative = file.path.lexically_normal();
    if (path->empty() || relative.is_absolute() || *relative.begin() == ".." ||
        !relative.has_filename()) {
      complain(table, key, *path + " does not lie in a data folder");
    }
    return file;
  }

  void take_companions() {
    entry_.companions = files_of("companions");
    const bool is_stated = table_.contains("companions");
    if (is_stated != table_.contains("companions_not_fetchable")) {
      complain("companions", "expected together with companions_not_fetchable, the reason");
    } else if (is_stated) {
      entry_.companions_not_fetchable = text("companions_not_fetchable");
      if (entry_.companions.empty()) complain("companions", "empty or not a list");
    }
    for (const DataFile& file : entry_.companions) {
      if (!file.url.empty()) complain("companions", "nothing fetches them; expected no url");
    }
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
    if (stated != "stamp" && stated != "file") complain(key, "expected stamp or file");
    return stated == "file" ? formats::StampOrder::kFile : formats::StampOrder::kStamp;
  }

  std::optional<double> positive_number(std::string_view key) {
    const auto node = table_[key];
    if (!node) return std::nullopt;
    const auto value = node.value<double>();
    if (!value || !(*value > 0) || !std::isfinite(*value)) {
      complain(key, "expected a number > 0");
    }
    return value;
  }

  void take_best_chi2() {
    entry_.best_chi2 = positive_number("best_chi2");
    const bool is_stated = table_.contains("best_chi2");
    if (is_stated != table_.contains("best_chi2_source")) {
      complain("best_chi2", "expected together with best_chi2_source, who found it");
    } else if (is_stated) {
      entry_.best_chi2_source = text("best_chi2_source");
      if (!entry_.is_graph()) complain("best_chi2", "only a pose graph has one");
    }
  }

  void take_calibration() {
    const auto node = table_["calibration"];
    if (!node) return;
    if (!node.is_table() || formats::states_nothing(*node.as_table())) {
      complain("calibration", "not a table, or one that states nothing");
      return;
    }
    formats::RobotOverride stated = formats::read_robot_table(
        *node.as_table(), "calibration", formats::RobotTables::kOverride, {}, problems_);
    entry_.robot = std::move(stated.robot);
    entry_.robot_keys = std::move(stated.keys);
    entry_.raw = stated.raw;
  }

  // The tables [topics] and [joints] of LOG.topics.toml, as keys of the entry.
  void take_topics() {
    if (!table_.contains("topics") && !table_.contains("joints")) return;
    for (const char* key : {"topics", "joints"}) {
      const toml::table* tables = table_[key].as_table();
      if (tables == nullptr || !formats::states_nothing(*tables)) continue;
      complain(key, "states nothing");
      return;
    }
    if (entry_.format != "rosbag") {
      complain(table_.contains("topics") ? "topics" : "joints", "only a rosbag has topics");
      return;
    }
    entry_.topics = formats::read_bag_topics(table_, problems_);
  }

  const toml::table& table_;
  std::vector<formats::TomlProblem>& problems_;
  CatalogEntry entry_;
};

}  // namespace

CatalogEntry read_entry(const toml::table& table, std::vector<formats::TomlProblem>& problems) {
  CatalogEntry entry = EntryReader(table, problems).read();
  entry.line = table.source().begin.line;
  return entry;
}

}  // namespace corridor::catalog
