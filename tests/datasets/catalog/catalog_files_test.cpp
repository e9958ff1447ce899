// The files of a data set: how the catalogue states them, what counts as the right one, graphs.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "datasets/catalog/load_dataset.hpp"
#include "datasets/catalog/load_graph.hpp"
#include "datasets/catalog/sha256.hpp"
#include "datasets/formats/file_bytes.hpp"
#include "datasets/formats/log_health.hpp"
#include "tests/datasets/catalog/catalog_support.hpp"

namespace corridor::catalog {
namespace {

using test::entry_text;
using test::kScans;
using test::kScansSha256;
using test::ScratchFolder;
using test::TinyData;

TEST(Catalog, ListsEveryViolationOfAFileAndItsAddress) {
  const ScratchFolder folder;
  const auto refused = [&](const std::string& file, const std::string& more = "") {
    std::string text = entry_text(more);
    const std::size_t begin = text.find("  { path");
    text.replace(begin, text.find("]", begin) - begin, file + ",\n");
    text.replace(text.find("truth = \"relations\""), 19, "truth = \"none\"");
    const auto catalog = read_catalog(folder.write("catalog.toml", text));
    return catalog ? std::string("accepted") : catalog.error().to_line();
  };
  const std::string sum = std::string("\"") + kScansSha256 + "\"";
  const auto with_url = [&](const std::string& url) {
    return refused("{ path = \"a.clf\", sha256 = " + sum + ", url = \"" + url + "\" }");
  };
  EXPECT_NE(with_url("https://h/a").find("every file has a url"), std::string::npos);
  EXPECT_NE(with_url("http://h/a").find("http leaves this machine"), std::string::npos);
  EXPECT_NE(with_url("ftp://h/a").find("neither https nor http"), std::string::npos);
  const std::string form = "or content_sha256";
  EXPECT_NE(refused("{ path = \"a.clf\" }").find(form), std::string::npos);
  EXPECT_NE(refused("{ path = \"a.clf\", sha256 = " + sum + ", content_sha256 = " + sum + " }")
                .find(form),
            std::string::npos);
  EXPECT_NE(refused("{ path = \"a.clf\", sha256 = " + sum + ", md5 = \"0\" }").find(form),
            std::string::npos);
  EXPECT_NE(refused("{ path = \"b/../../a.clf\", sha256 = " + sum + " }").find("data folder"),
            std::string::npos);
  EXPECT_EQ(refused("{ path = \"a.clf\", content_sha256 = " + sum + " }"), "accepted");
}

TEST(Catalog, AFileWithoutAddressAsksForTheReason) {
  const ScratchFolder folder;
  std::string text = entry_text();
  const std::string reason = "not_fetchable = \"made here\"\n";
  text.replace(text.find(reason), reason.size(), "");
  const auto catalog = read_catalog(folder.write("catalog.toml", text));
  ASSERT_FALSE(catalog.has_value());
  EXPECT_NE(catalog.error().to_line().find("not_fetchable: missing"), std::string::npos);
}

// A log kept packed, known by the sum of its content.
Catalog packed_catalog(const TinyData& data) {
  Catalog catalog = data.catalog();
  catalog.entries[0].files = {{"sub/packed.clf.gz", kScansSha256, true, ""}};
  return catalog;
}

TEST(VerifyDataset, KnowsAPackedFileByItsContentWhateverItsBytes) {
  const TinyData data;
  const Catalog catalog = packed_catalog(data);
  const auto status = [&](const std::string& bytes) {
    data.folder.write("data/sub/packed.clf.gz", bytes);
    return verify_dataset(catalog, "tiny", data.dirs)->front().status;
  };
  const std::string packed = *formats::gzip(kScans);
  EXPECT_EQ(status(packed), FileStatus::kMatches);
  std::string other_system = packed;
  other_system[9] = '\7';  // gzip's note of the system it was made on
  EXPECT_EQ(status(other_system), FileStatus::kMatches);
  EXPECT_EQ(status(kScans), FileStatus::kMatches) << "not packed at all";
  EXPECT_EQ(status(*formats::gzip("something else")), FileStatus::kDiffers);
  EXPECT_EQ(status(packed.substr(0, packed.size() - 5)), FileStatus::kDiffers) << "truncated";
}

TEST(LoadDataset, ALogThatIsPackedInAnotherWayIsTheSameDataset) {
  const TinyData data;
  const auto digest = [&](const std::string& bytes) {
    data.folder.write("data/sub/packed.clf.gz", bytes);
    const auto loaded = load_dataset("tiny", data.dirs, packed_catalog(data));
    EXPECT_TRUE(loaded.has_value()) << loaded.error().to_line();
    return loaded ? loaded->digest : "";
  };
  std::string packed = *formats::gzip(kScans);
  const std::string first = digest(packed);
  packed[9] = '\7';
  EXPECT_EQ(digest(packed), first);
}

TEST(LoadDataset, OtherFilesAreReadInTheirOwnOrderWhereTheCatalogueSaysSo) {
  const TinyData data;
  Catalog catalog = data.catalog();
  catalog.entries[0].order_of_other_files = formats::StampOrder::kFile;
  data.folder.write("data/sub/tiny.clf",
                    "FLASER 2 1 2 0 0 0 0 0 0 1.5 h 1.5\n"
                    "FLASER 2 1 2 0 0 0 0 0 0 1.0 h 1.0\n");
  EXPECT_FALSE(load_dataset("tiny", data.dirs, catalog).has_value()) << "not asked for";
  LoadOptions options;
  options.accept_other_checksum = true;
  const auto loaded = load_dataset("tiny", data.dirs, catalog, options);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().to_line();
  EXPECT_EQ(loaded->log.num_scans(), 2U);
}

// The LiDAR's clock is 0.1 s ahead of the wheels'; the relations carry its stamps.
TEST(LoadDataset, PutsALidarWithAClockOfItsOwnOntoTheWheelsClock) {
  const ScratchFolder folder;
  const auto path = folder.write("a.clf",
                                 "ODOM 0 0 0 0 0 0 1.0 h 1.0\nODOM 0.1 0 0 0 0 0 1.05 h 1.05\n"
                                 "FLASER 2 1 2 0 0 0 0.1 0 0 1.1 h 1.1\n"
                                 "FLASER 2 1 2 0 0 0 0.2 0 0 1.5 h 1.5\n");
  folder.write("a.robot.toml", "[lidar]\ntime_offset_s = 0.1\n");
  folder.write("a.relations", "1.1 1.5 0.1 0 0 0 0 0\n");
  const auto loaded = load_dataset(path.string(), {}, Catalog{});
  ASSERT_TRUE(loaded.has_value()) << loaded.error().to_line();
  EXPECT_EQ(loaded->lidar_time_offset_s, 0.1);
  EXPECT_EQ(loaded->log.robot.lidar.time_offset_s, 0);
  EXPECT_EQ(loaded->relations->front().t1, timestamp_from_seconds(1.0));
  EXPECT_EQ(loaded->relations->front().t2, timestamp_from_seconds(1.4));
  ASSERT_TRUE(std::holds_alternative<LaserScan>(loaded->log.events[1])) << "before the second ODOM";
  EXPECT_EQ(stamp_of(loaded->log.events[1]), timestamp_from_seconds(1.0));
  LoadOptions options;
  options.keep_lidar_clock = true;
  const auto kept = load_dataset(path.string(), {}, Catalog{}, options);
  ASSERT_TRUE(kept.has_value()) << kept.error().to_line();
  EXPECT_EQ(kept->lidar_time_offset_s, 0);
  EXPECT_EQ(kept->log.robot.lidar.time_offset_s, 0.1);
  EXPECT_EQ(kept->relations->front().t1, timestamp_from_seconds(1.1));
}

TEST(LoadGraph, ByNameAndByPathAndNoLog) {
  const TinyData data;
  constexpr const char* kGraph =
      "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n";
  const auto path = data.folder.write("data/tiny.g2o", kGraph);
  Catalog catalog = data.catalog();
  CatalogEntry& entry = catalog.entries.emplace_back();
  entry.name = "graph";
  entry.format = "g2o";
  entry.files = {{"tiny.g2o", to_hex(sha256_of(kGraph)), false, ""}};
  ASSERT_TRUE(load_graph("graph", data.dirs, catalog).has_value());
  EXPECT_EQ(load_graph("graph", data.dirs, catalog)->graph.edges.size(), 1U);
  EXPECT_TRUE(load_graph(path.string(), data.dirs, catalog).has_value());
  EXPECT_NE(load_graph("tiny", data.dirs, catalog).error().to_line().find("is no pose graph"),
            std::string::npos);
  EXPECT_NE(load_dataset("graph", data.dirs, catalog).error().to_line().find("is a pose graph"),
            std::string::npos);
  data.folder.write("data/tiny.g2o", std::string(kGraph) + "\n");
  EXPECT_NE(load_graph("graph", data.dirs, catalog).error().to_line().find("SHA-256"),
            std::string::npos);
}

TEST(LoadGraph, TakesTruePosesAndKnowsTheBestChi2OfAFileByItsBytes) {
  const TinyData data;
  const std::string text =
      "VERTEX_SE2 7 1 0 0\nVERTEX_SE2 3 0 0 0\nEDGE_SE2 3 7 1 0 0 1 0 0 1 0 1\n";
  const auto path = data.folder.write("data/tiny.g2o", text);
  const Catalog none;
  const auto alone = load_graph(path.string(), data.dirs, none);
  ASSERT_TRUE(alone.has_value()) << alone.error().to_line();
  EXPECT_TRUE(alone->true_poses.empty());
  EXPECT_FALSE(alone->best_chi2.has_value());

  data.folder.write("data/tiny.truth-nodes.dat", "0 0 0\n1 2 0.5\n");
  Catalog catalog;
  CatalogEntry& entry = catalog.entries.emplace_back();
  entry.name = "graph";
  entry.format = "g2o";
  entry.files = {{"elsewhere.g2o", to_hex(sha256_of(text)), false, ""}};
  entry.best_chi2 = 5;
  const auto with_truth = load_graph(path.string(), data.dirs, catalog);
  ASSERT_TRUE(with_truth.has_value()) << with_truth.error().to_line();
  ASSERT_EQ(with_truth->true_poses.size(), 2U);
  EXPECT_EQ(with_truth->true_poses[0].id, 3U) << "the first line is of the lowest pose";
  EXPECT_EQ(with_truth->true_poses[1].T_map_base.x_m(), 1);
  EXPECT_NE(with_truth->digest, alone->digest) << "scores follow from the truth too";
  EXPECT_EQ(with_truth->best_chi2, 5);
}

TEST(LoadGraph, RefusesTruePosesThatAreNotTheGraphs) {
  const TinyData data;
  const auto path = data.folder.write(
      "data/tiny.g2o", "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n");
  const auto refusal = [&](const char* truth) {
    data.folder.write("data/tiny.truth-nodes.dat", truth);
    const auto loaded = load_graph(path.string(), data.dirs, Catalog());
    return loaded ? std::string("accepted") : loaded.error().to_line();
  };
  EXPECT_NE(refusal("0 0 0\n").find("1 true poses; expected 2"), std::string::npos);
  EXPECT_NE(refusal("0 0 0\n1 0 0\n2 0 0\n").find("3 true poses; expected 2"), std::string::npos);
  EXPECT_NE(refusal("0 0 0\n1 0\n").find("tiny.truth-nodes.dat:2"), std::string::npos);
  EXPECT_NE(refusal("0 0 0\n1 nan 0\n").find("not a true pose"), std::string::npos);
  EXPECT_NE(refusal("").find("0 true poses"), std::string::npos);
}

TEST(LoadGraph, MakesAWalkByItsNameAnywhere) {
  const auto walk = load_graph("walk-50-s3", DataDirs(), Catalog());
  ASSERT_TRUE(walk.has_value());
  EXPECT_EQ(walk->graph.vertices.size(), 50U);
  EXPECT_EQ(walk->true_poses.size(), 50U);
  EXPECT_TRUE(is_graph_name("walk-50-s3", Catalog()));
  EXPECT_FALSE(is_graph_name("walk-50", Catalog()));
}

TEST(Catalog, ABestChi2IsAGraphsAndSaysWhoFoundIt) {
  const ScratchFolder folder;
  const auto refusal = [&](const std::string& more) {
    const auto catalog = read_catalog(folder.write("catalog.toml", entry_text(more)));
    return catalog ? std::string("accepted") : catalog.error().to_line();
  };
  EXPECT_NE(refusal("best_chi2 = 3.5\n").find("best_chi2_source, who found it"), std::string::npos);
  EXPECT_NE(refusal("best_chi2 = -1\nbest_chi2_source = \"me\"\n").find("expected a number > 0"),
            std::string::npos);
  EXPECT_NE(refusal("best_chi2 = 3.5\nbest_chi2_source = \"me\"\n").find("only a pose graph"),
            std::string::npos);
}

TEST(Catalog, CompanionsHaveAChecksumAndAReasonAndAreVerifiedWhereTheyAre) {
  const TinyData data;
  const std::string sum = std::string("sha256 = \"") + kScansSha256 + "\"";
  const auto read = [&](const std::string& more) {
    return read_catalog(data.folder.write("other.toml", entry_text(more)));
  };
  const std::string list = "companions = [ { path = \"sub/other.txt\", " + sum + " } ]\n";
  const std::string reason = "companions_not_fetchable = \"made here\"\n";
  for (const std::string& wrong : {list, reason, "companions = []\n" + reason}) {
    const auto refused = read(wrong);
    ASSERT_FALSE(refused.has_value()) << wrong;
    EXPECT_NE(refused.error().to_line().find("companions"), std::string::npos);
  }
  const auto catalog = read(list + reason);
  ASSERT_TRUE(catalog.has_value()) << catalog.error().to_line();
  EXPECT_EQ(verify_dataset(*catalog, "tiny", data.dirs)->size(), 2U) << "not there, not asked for";
  data.folder.write("data/sub/other.txt", kScans);
  const auto there = verify_dataset(*catalog, "tiny", data.dirs);
  ASSERT_EQ(there->size(), 3U);
  EXPECT_EQ(there->back().status, FileStatus::kMatches);
  data.folder.write("data/sub/other.txt", "changed");
  EXPECT_EQ(verify_dataset(*catalog, "tiny", data.dirs)->back().status, FileStatus::kDiffers);
  EXPECT_TRUE(load_dataset("tiny", data.dirs, *catalog).has_value()) << "it is not read";
}

// In folders that the catalogue names: others are the user's own.
TEST(Catalog, KnowsEveryFileOfTheDataFoldersItNames) {
  const auto catalog =
      read_catalog(std::filesystem::path(CORRIDOR_SOURCE_DIR) / "datasets/catalog.toml");
  ASSERT_TRUE(catalog.has_value()) << catalog.error().to_line();
  std::set<std::filesystem::path> known;
  std::set<std::filesystem::path> folders;
  for (const CatalogEntry& entry : catalog->entries) {
    for (const auto& files : {entry.files, entry.companions}) {
      for (const DataFile& file : files) {
        known.insert(file.path);
        if (file.path.has_parent_path()) folders.insert(file.path.parent_path());
      }
    }
  }
  std::size_t num_found = 0;
  for (const auto& data_dir : standard_data_dirs().folders) {
    for (const auto& folder : folders) {
      std::error_code none;
      for (const auto& file : std::filesystem::directory_iterator(data_dir / folder, none)) {
        if (!file.is_regular_file()) continue;
        EXPECT_TRUE(known.contains(folder / file.path().filename())) << file.path();
        ++num_found;
      }
    }
  }
  if (num_found == 0) GTEST_SKIP() << "no data found; set $CORRIDOR_BENCH_DATA to their folder";
}

TEST(Catalog, EveryFileThatIsFoundHasItsChecksum) {
  const auto catalog =
      read_catalog(std::filesystem::path(CORRIDOR_SOURCE_DIR) / "datasets/catalog.toml");
  ASSERT_TRUE(catalog.has_value());
  std::size_t num_found = 0;
  for (const CatalogEntry& entry : catalog->entries) {
    const auto verified = verify_dataset(*catalog, entry.name, standard_data_dirs());
    ASSERT_TRUE(verified.has_value()) << verified.error().to_line();
    for (const VerifiedFile& file : *verified) {
      EXPECT_NE(file.status, FileStatus::kDiffers) << file.path;
      num_found += file.status == FileStatus::kMatches ? 1 : 0;
    }
  }
  if (num_found == 0) GTEST_SKIP() << "no data found; set $CORRIDOR_BENCH_DATA to their folder";
}

// The report's rules have margins that no sound recording comes near.
TEST(Catalog, EveryLogThatIsFoundIsFitAndUnderNoSuspicion) {
  const bool has_any = test::for_each_log_found(
      [](const DatasetRow& row, const Catalog& catalog, const DataDirs& dirs) {
        const auto source = find_log(row.name, dirs, catalog);
        ASSERT_TRUE(source.has_value()) << source.error().to_line();
        const auto found = formats::read_log_as_found(source->path, source->options);
        ASSERT_TRUE(found.has_value()) << found.error().to_line();
        const formats::LogHealth health = formats::examine(found->log);
        EXPECT_TRUE(health.defects.empty()) << row.name << ": " << health.defects.front();
        EXPECT_TRUE(health.suspicions.empty()) << row.name << ": " << health.suspicions.front();
      });
  if (!has_any) GTEST_SKIP() << test::kNoData;
}

// Every catalogued graph that this machine has is what a solver can take.
TEST(Catalog, EveryGraphThatIsFoundLoads) {
  const auto catalog =
      read_catalog(std::filesystem::path(CORRIDOR_SOURCE_DIR) / "datasets/catalog.toml");
  ASSERT_TRUE(catalog.has_value());
  const DataDirs dirs = standard_data_dirs();
  std::size_t num_loaded = 0;
  for (const CatalogEntry& entry : catalog->entries) {
    const auto verified = verify_dataset(*catalog, entry.name, dirs);
    if (!entry.is_graph() || verified->front().status == FileStatus::kMissing) continue;
    const auto graph = load_graph(entry.name, dirs, *catalog);
    ASSERT_TRUE(graph.has_value()) << graph.error().to_line();
    EXPECT_GT(graph->graph.edges.size(), graph->graph.vertices.size()) << entry.name;
    EXPECT_TRUE(graph->best_chi2.has_value()) << entry.name;
    EXPECT_EQ(graph->true_poses.empty(), entry.name != "manhattanOlson3500") << entry.name;
    ++num_loaded;
  }
  if (num_loaded == 0) GTEST_SKIP() << "no graph found; set $CORRIDOR_BENCH_DATA to their folder";
}

}  // namespace
}  // namespace corridor::catalog
