// Reading catalogues: the one of the source tree and those of data folders, every violation listed.
#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "datasets/catalog/catalog.hpp"
#include "datasets/catalog/entry_reader.hpp"
#include "datasets/catalog/find_folder.hpp"
#include "datasets/formats/file_bytes.hpp"

namespace corridor::catalog {
namespace {

// Of a catalogue in a data folder.
constexpr const char* kCatalogName = "catalog.toml";

void refuse_repeated_names(const Catalog& catalog, std::vector<formats::TomlProblem>& problems) {
  for (const CatalogEntry& entry : catalog.entries) {
    const CatalogEntry* first = catalog.find(entry.name);
    if (first == &entry) continue;
    problems.push_back({entry.line, fmt::format("name {} is given twice, first in line {}",
                                                entry.name, first->line)});
  }
}

Catalog take_catalog(const toml::table& document, std::vector<formats::TomlProblem>& problems) {
  Catalog catalog;
  formats::find_unknown_keys(document, "", {"dataset"}, problems);
  const toml::array* datasets = document["dataset"].as_array();
  if (datasets == nullptr) {
    problems.push_back({0, "dataset: missing or no list of tables; expected [[dataset]]"});
    return catalog;
  }
  for (const toml::node& node : *datasets) {
    if (const toml::table* table = node.as_table()) {
      catalog.entries.push_back(read_entry(*table, problems));
    } else {
      problems.push_back({node.source().begin.line, "dataset: not a table; expected [[dataset]]"});
    }
  }
  refuse_repeated_names(catalog, problems);
  return catalog;
}

// The file is named once: a catalogue is one Error, however many entries it has.
std::string text_of(const std::vector<formats::TomlProblem>& problems) {
  std::vector<std::string> lines;
  for (const formats::TomlProblem& problem : problems) {
    lines.push_back(problem.line == 0 ? problem.text
                                      : fmt::format("line {}: {}", problem.line, problem.text));
  }
  return fmt::format("{}", fmt::join(lines, "; "));
}

std::string place_of(const CatalogEntry& entry) {
  return fmt::format("{}:{}", entry.catalog_file.string(), entry.line);
}

// Paths of `own` are relative to `folder`.
Result<void> add_entries(Catalog own, const std::filesystem::path& folder, Catalog& known) {
  for (CatalogEntry& entry : own.entries) {
    if (const CatalogEntry* other = known.find(entry.name)) {
      return fail(ErrorCode::kInvalid,
                  fmt::format("data set {} is in {} too", entry.name, place_of(*other)),
                  place_of(entry), "a name that no other catalogue has");
    }
    entry.folder = folder;
    known.entries.push_back(std::move(entry));
  }
  return {};
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
  std::vector<formats::TomlProblem> problems;
  Catalog catalog = take_catalog(document, problems);
  if (!problems.empty()) return fail(ErrorCode::kInvalid, text_of(problems), path.string());
  for (CatalogEntry& entry : catalog.entries) entry.catalog_file = path;
  return catalog;
}

Result<Catalog> known_datasets(const DataDirs& dirs) {
  Result<Catalog> known = read_catalog(main_catalog_path());
  if (!known) return known;
  std::vector<std::filesystem::path> read = {main_catalog_path()};
  for (const std::filesystem::path& folder : dirs.folders) {
    const std::filesystem::path file = folder / kCatalogName;
    std::error_code ignored;
    const auto is_same = [&](const std::filesystem::path& other) {
      return std::filesystem::equivalent(file, other, ignored);
    };
    if (!is_file(file) || std::any_of(read.begin(), read.end(), is_same)) continue;
    read.push_back(file);
    Result<Catalog> own = read_catalog(file);
    if (!own) return own;
    if (const auto added = add_entries(std::move(*own), folder, *known); !added) {
      return tl::make_unexpected(added.error());
    }
  }
  return known;
}

}  // namespace corridor::catalog
