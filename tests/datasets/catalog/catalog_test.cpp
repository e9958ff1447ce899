#include "datasets/catalog/load_dataset.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "datasets/catalog/sha256.hpp"
#include "tests/datasets/catalog/catalog_support.hpp"

namespace corridor::catalog {
namespace {

using test::entry_text;
using test::kScans;
using test::kScansSha256;
using test::ScratchFolder;
using test::TinyData;

TEST(Sha256, IsThatOfTheStandardsExamples) {
  const ScratchFolder folder;
  EXPECT_EQ(*sha256_of_file(folder.write("empty", "")),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(*sha256_of_file(folder.write("abc", "abc")),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_FALSE(sha256_of_file(folder / "none").has_value());
  EXPECT_FALSE(sha256_of_file(folder.path()).has_value()) << "a folder has no bytes";
  EXPECT_EQ(to_hex(sha256_of("abc")), *sha256_of_file(folder / "abc"));
}

TEST(Catalog, OfTheSourceTreeIsValidAndHasEveryNameOfTheCommandLine) {
  const auto catalog =
      read_catalog(std::filesystem::path(CORRIDOR_SOURCE_DIR) / "datasets/catalog.toml");
  ASSERT_TRUE(catalog.has_value()) << catalog.error().to_line();
  for (const char* name : {"malaga",
                           "intel",
                           "fr079",
                           "aces",
                           "mines",
                           "mbot-empty",
                           "mbot-a0",
                           "corridor-r4.5-s1",
                           "corridor-r4.5-s6",
                           "corridor-r4.5-slip-s7",
                           "corridor-r4.5-vary-s8",
                           "corridor-r12-s1",
                           "M3500",
                           "M3500b",
                           "manhattanOlson3500",
                           "city10000",
                           "intel1728",
                           "intel1228",
                           "MIT",
                           "CSAIL",
                           "FRH"}) {
    EXPECT_NE(catalog->find(name), nullptr) << name;
  }
  EXPECT_EQ(catalog->find("intel")->no_return_range_m, 81.0);
  for (const CatalogEntry& entry : catalog->entries) {
    for (const DataFile& file : entry.files) {
      EXPECT_NE(file.url.empty(), entry.not_fetchable.empty()) << entry.name;
      EXPECT_TRUE(file.url.empty() || file.url.starts_with("https://")) << file.url;
    }
  }
  EXPECT_TRUE(catalog->find("M3500")->is_graph());
  for (const char* name : {"mines", "mbot-empty", "mbot-a0"}) {
    EXPECT_TRUE(catalog->find(name)->files.front().is_sum_of_content) << name;
  }
  EXPECT_EQ(catalog->find("mbot-a0")->raw.clock, formats::RawClock::kEventOffset);
  EXPECT_EQ(catalog->find("mbot-empty")->raw.clock, formats::RawClock::kData);
  EXPECT_EQ(to_text(catalog->find("mbot-empty")->truth), "reference");
  EXPECT_EQ(catalog->find("none"), nullptr);
}

TEST(Catalog, TheProgramFindsItWithoutBeingTold) {
  EXPECT_TRUE(std::filesystem::exists(main_catalog_path()));
}

TEST(Catalog, ListsEveryViolationAtOnce) {
  const ScratchFolder folder;
  std::string text =
      entry_text("colour = \"red\"\nno_return_range_m = -1\ncalibration.wheels.trak_m = 1\n") +
      entry_text();
  text.replace(text.find("relations\"\norder"), 9, "guesswork");
  text.replace(text.find(kScansSha256), 4, "wxyz");
  folder.write("catalog.toml", text);
  const auto catalog = read_catalog(folder / "catalog.toml");
  ASSERT_FALSE(catalog.has_value());
  const std::string line = catalog.error().to_line();
  for (const char* part :
       {"colour: unknown key", "truth: expected", "64 lower-case hexadecimal",
        "no_return_range_m: expected", "wheels.trak_m: unknown key", "name tiny is given twice"}) {
    EXPECT_NE(line.find(part), std::string::npos) << part << " in " << line;
  }
}

TEST(Catalog, RefusesFilesOutsideTheDataFolder) {
  const ScratchFolder folder;
  for (const char* path : {"../tiny.clf", "sub/../../tiny.clf", "/tiny.clf", ""}) {
    std::string text = entry_text();
    text.replace(text.find("sub/tiny.clf"), 12, path);
    folder.write("catalog.toml", text);
    EXPECT_FALSE(read_catalog(folder / "catalog.toml").has_value()) << path;
  }
  EXPECT_EQ(read_catalog(folder / "none.toml").error().code, ErrorCode::kNotFound);
  folder.write("catalog.toml", "[[dataset]\n");
  EXPECT_NE(read_catalog(folder / "catalog.toml").error().to_line().find("catalog.toml:1"),
            std::string::npos);
}

TEST(Catalog, ABagNamesItsTopicsAndNoOtherFormatDoes) {
  const ScratchFolder folder;
  const std::string topics =
      "topics.scan = \"/scan\"\ntopics.joints = \"/joints\"\njoints.left = \"l\"\n"
      "joints.right = \"r\"\njoints.ticks_per_turn = 4096\n";
  std::string text = entry_text(topics);
  const auto refused = read_catalog(folder.write("carmen.toml", text));
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().to_line().find("only a rosbag has topics"), std::string::npos);
  text.replace(text.find("\"carmen\""), 8, "\"rosbag\"");
  text.replace(text.find("tiny.clf"), 8, "tiny.bag");
  const auto catalog = read_catalog(folder.write("bag.toml", text));
  ASSERT_TRUE(catalog.has_value()) << catalog.error().to_line();
  const CatalogEntry& entry = catalog->entries.front();
  EXPECT_FALSE(entry.is_graph());
  ASSERT_TRUE(entry.topics.has_value() && entry.topics->joints.has_value());
  EXPECT_EQ(entry.topics->scan, "/scan");
  EXPECT_EQ(entry.topics->joints->ticks_per_turn, 4096);
  const auto wrong = read_catalog(folder.write("wrong.toml", text + "topics.lidar = \"/x\"\n"));
  ASSERT_FALSE(wrong.has_value());
  EXPECT_NE(wrong.error().to_line().find("topics.lidar: unknown key"), std::string::npos);
}

TEST(LoadDataset, ByNameTakesOrderCalibrationAndTruthFromTheCatalogue) {
  const TinyData data;
  const auto loaded = load_dataset("tiny", data.dirs, data.catalog());
  ASSERT_TRUE(loaded.has_value()) << loaded.error().to_line();
  EXPECT_EQ(loaded->name, "tiny");
  EXPECT_EQ(loaded->sha256, kScansSha256);
  EXPECT_EQ(loaded->log.robot.wheels.track_m, 0.33);
  EXPECT_EQ(loaded->log.robot.lidar.range_max_m, 50);
  EXPECT_EQ(std::get<LaserScan>(loaded->log.events[3]).is_valid, (std::vector<std::uint8_t>{1, 0}));
  ASSERT_TRUE(loaded->relations.has_value());
  EXPECT_EQ(loaded->relations->size(), 1U);
  EXPECT_FALSE(loaded->world_file.has_value());
}

TEST(LoadDataset, ByPathTakesTruthFromBesideTheFile) {
  const TinyData data;
  data.folder.write("data/sub/tiny.tum", "1.0 0 0 0 0 0 0 1\n");
  data.folder.write("data/sub/tiny.truth.toml", "[world]\n");
  const auto path = data.folder / "data/sub/tiny.clf";
  const auto loaded = load_dataset(path.string(), data.dirs, data.catalog());
  ASSERT_TRUE(loaded.has_value()) << loaded.error().to_line();
  EXPECT_EQ(loaded->name, "tiny");
  EXPECT_TRUE(loaded->relations.has_value());
  EXPECT_EQ(loaded->log.truth->size(), 1U);
  EXPECT_EQ(loaded->world_file, data.folder / "data/sub/tiny.truth.toml");
}

TEST(LoadDataset, TheDigestCoversTheLogWhatLiesBesideItAndTheCalibration) {
  const TinyData data;
  const auto digest = [&](const Catalog& catalog, const std::string& name) {
    const auto loaded = load_dataset(name, data.dirs, catalog);
    EXPECT_TRUE(loaded.has_value()) << loaded.error().to_line();
    return loaded ? loaded->digest : "";
  };
  const auto by_path = [&] {
    return digest(data.catalog(), (data.folder / "data/sub/tiny.clf").string());
  };
  std::set<std::string> seen{by_path(), digest(data.catalog(), "tiny")};
  EXPECT_EQ(seen.size(), 2U) << "the catalogue's calibration";
  Catalog other = data.catalog();
  other.entries[0].robot->wheels.track_m = 0.34;
  EXPECT_TRUE(seen.insert(digest(other, "tiny")).second) << "another track";
  const auto changes_with = [&](const std::string& suffix, const std::string& text) {
    data.folder.write("data/sub/tiny" + suffix, text);
    return seen.insert(by_path()).second;
  };
  EXPECT_TRUE(changes_with(".tum", "1.0 0 0 0 0 0 0 1\n"));
  EXPECT_TRUE(changes_with(".tum", "1.0 0.5 0 0 0 0 0 1\n"));
  EXPECT_TRUE(changes_with(".truth.toml", "[world]\n"));
  EXPECT_TRUE(changes_with(".robot.toml", "[wheels]\ntrack_m = 0.35\n"));
  EXPECT_TRUE(changes_with(".topics.toml", "[topics]\n"));
  EXPECT_TRUE(changes_with(".relations", "1.0 1.5 0.2 0 0 0 0 0\n"));
  EXPECT_TRUE(changes_with(".clf", std::string(kScans) + "# more\n"));
  EXPECT_FALSE(changes_with(".txt", "not read with the log"));
}

TEST(LoadDataset, TheDigestOfALogAloneIsThatOfItsBytes) {
  const ScratchFolder folder;
  const auto loaded = load_dataset(folder.write("a.clf", kScans).string(), {}, Catalog{});
  ASSERT_TRUE(loaded.has_value()) << loaded.error().to_line();
  EXPECT_EQ(loaded->digest, kScansSha256);
}

TEST(LoadDataset, OtherBytesUnderAKnownNameAreRefusedUnlessAskedFor) {
  const TinyData data;
  data.folder.write("data/sub/tiny.clf", std::string(kScans) + "# more\n");
  const auto refused = load_dataset("tiny", data.dirs, data.catalog());
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().to_line().find("SHA-256"), std::string::npos);
  LoadOptions options;
  options.accept_other_checksum = true;
  const auto loaded = load_dataset("tiny", data.dirs, data.catalog(), options);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().to_line();
  EXPECT_NE(loaded->log.provenance.notes.back().find("accepted on request"), std::string::npos);
}

TEST(LoadDataset, TruthThatIsMissingIsAnErrorNotALogWithoutTruth) {
  const TinyData data;
  std::filesystem::remove(data.folder / "data/sub/tiny.relations");
  const auto loaded = load_dataset("tiny", data.dirs, data.catalog());
  ASSERT_FALSE(loaded.has_value());
  EXPECT_EQ(loaded.error().code, ErrorCode::kNotFound);
}

TEST(LoadDataset, SaysWhatItLookedForAndWhere) {
  const TinyData data;
  const auto unknown = load_dataset("tinny", data.dirs, data.catalog());
  EXPECT_NE(unknown.error().to_line().find("'tinny' is neither a data set nor a log file"),
            std::string::npos);
  EXPECT_NE(unknown.error().to_line().find("the nearest names: tiny"), std::string::npos);
  DataDirs nowhere;
  nowhere.folders = {data.folder / "elsewhere"};
  const auto missing = load_dataset("tiny", nowhere, data.catalog());
  EXPECT_EQ(missing.error().code, ErrorCode::kNotFound);
  EXPECT_NE(missing.error().to_line().find("elsewhere"), std::string::npos);
  EXPECT_NE(missing.error().to_line().find("source: here"), std::string::npos);
}

TEST(LoadDataset, StepsBackInTimeAreKeptOnlyOnRequest) {
  const ScratchFolder folder;
  const auto path = folder.write("a.clf",
                                 "FLASER 2 1 2 0 0 0 0 0 0 1.5 h 1.5\n"
                                 "FLASER 2 1 2 0 0 0 0 0 0 1.0 h 1.0\n");
  EXPECT_FALSE(load_dataset(path.string(), {}, Catalog{}).has_value());
  LoadOptions options;
  options.order = formats::StampOrder::kFile;
  const auto loaded = load_dataset(path.string(), {}, Catalog{}, options);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().to_line();
  EXPECT_EQ(loaded->log.num_scans(), 2U);
}

TEST(ListDatasets, SaysWhatWasFoundWhere) {
  const TinyData data;
  Catalog catalog = data.catalog();
  catalog.entries.push_back(catalog.entries[0]);
  catalog.entries[1].name = "other";
  catalog.entries[1].files[0].path = "other.clf";
  const auto rows = list_datasets(catalog, data.dirs);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_TRUE(rows[0].is_found);
  EXPECT_EQ(rows[0].path, data.folder / "data/sub/tiny.clf");
  EXPECT_EQ(to_text(rows[0].truth), "relations");
  EXPECT_FALSE(rows[1].is_found);
  EXPECT_TRUE(rows[1].missing_files.empty());
}

TEST(ListDatasets, AnEntryWithoutAFileBesideItsLogIsIncompleteAndNotFound) {
  const TinyData data;
  std::filesystem::remove(data.folder / "data/sub/tiny.relations");
  const auto rows = list_datasets(data.catalog(), data.dirs);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_FALSE(rows[0].is_found);
  EXPECT_EQ(rows[0].path, data.folder / "data/sub/tiny.clf");
  EXPECT_EQ(rows[0].missing_files, (std::vector<std::filesystem::path>{"sub/tiny.relations"}));
}

TEST(VerifyDataset, TellsMatchingFromDifferentFromMissing) {
  const TinyData data;
  const Catalog catalog = data.catalog();
  const auto statuses = [&] {
    std::vector<FileStatus> found;
    const auto verified = verify_dataset(catalog, "tiny", data.dirs);
    for (const VerifiedFile& file : *verified) found.push_back(file.status);
    return found;
  };
  EXPECT_EQ(statuses(), (std::vector{FileStatus::kMatches, FileStatus::kMatches}));
  data.folder.write("data/sub/tiny.relations", "1 2 3\n");
  EXPECT_EQ(statuses(), (std::vector{FileStatus::kMatches, FileStatus::kDiffers}));
  std::filesystem::remove(data.folder / "data/sub/tiny.clf");
  EXPECT_EQ(statuses(), (std::vector{FileStatus::kMissing, FileStatus::kMissing}));
  EXPECT_FALSE(verify_dataset(catalog, "none", data.dirs).has_value());
}

// Environment variables are the process's: each test sets what it needs and puts it back.
class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    setenv(name, value.c_str(), 1);
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;
  ~Environment() { old_ ? setenv(name_, old_->c_str(), 1) : unsetenv(name_); }

 private:
  const char* name_;
  std::optional<std::string> old_;
};

TEST(DataDirs, AreSearchedInTheDocumentedOrder) {
  const Environment data("CORRIDOR_BENCH_DATA", "/data");
  const Environment cache("XDG_CACHE_HOME", "/cache");
  using Paths = std::vector<std::filesystem::path>;
  EXPECT_EQ(standard_data_dirs("/option").folders,
            (Paths{"/option", "/data", "/cache/corridor-bench", "/usr/share/mrpt/datasets"}));
  const Environment no_data("CORRIDOR_BENCH_DATA", "");
  const Environment no_cache("XDG_CACHE_HOME", "");
  const Environment home("HOME", "/home/user");
  EXPECT_EQ(standard_data_dirs().folders,
            (Paths{"/home/user/.cache/corridor-bench", "/usr/share/mrpt/datasets"}));
}

// Every catalogued log that this machine has loads by its name, with the bytes of the catalogue.
TEST(Catalog, EveryReadableDatasetThatIsFoundLoads) {
  const bool has_any = test::for_each_log_found(
      [](const DatasetRow& row, const Catalog& catalog, const DataDirs& dirs) {
        const auto loaded = load_dataset(row.name, dirs, catalog);
        ASSERT_TRUE(loaded.has_value()) << loaded.error().to_line();
        EXPECT_EQ(loaded->relations.has_value(), row.truth == TruthKind::kRelations) << row.name;
        EXPECT_EQ(loaded->log.truth.has_value(),
                  row.truth == TruthKind::kTum || row.truth == TruthKind::kReference)
            << row.name;
        for (const std::string& note : loaded->log.provenance.notes) {
          EXPECT_EQ(note.find("robot model"), std::string::npos) << row.name << ": " << note;
        }
      });
  if (!has_any) GTEST_SKIP() << test::kNoData;
}

}  // namespace
}  // namespace corridor::catalog
