// A data set by its name is the files that its catalogue lists, and what it says of them is true.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/datasets/catalog/catalog_support.hpp"

namespace corridor::catalog {
namespace {

using test::entry_text;
using test::kScans;
using test::kScansSha256;
using test::ScratchFolder;
using test::TinyData;

std::string joined(const std::vector<std::string>& notes) {
  std::string text;
  for (const std::string& note : notes) text += note + "\n";
  return text;
}

TEST(LoadDataset, ByNameLeavesWhatIsNotListedAndSaysSo) {
  const TinyData data;
  const Catalog catalog = data.catalog();
  const std::string digest = load_dataset("tiny", data.dirs, catalog)->digest;
  data.folder.write("data/sub/tiny.tum", "1.0 0 0 0 0 0 0 1\n");
  data.folder.write("data/sub/tiny.robot.toml", "[wheels]\ntrack_m = 0.77\n");
  data.folder.write("data/sub/tiny.truth.toml", "[world]\n");
  data.folder.write("data/sub/tiny.topics.toml", "[topics]\nscan = \"/x\"\n");
  const auto loaded = load_dataset("tiny", data.dirs, catalog);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().to_line();
  EXPECT_FALSE(loaded->log.truth.has_value());
  EXPECT_EQ(loaded->log.robot.wheels.track_m, 0.33);
  EXPECT_FALSE(loaded->world_file.has_value());
  EXPECT_TRUE(loaded->relations.has_value()) << "it is listed";
  EXPECT_EQ(loaded->digest, digest);
  const std::string notes = joined(loaded->log.provenance.notes);
  for (const char* file : {"tiny.tum", "tiny.robot.toml", "tiny.truth.toml", "tiny.topics.toml"}) {
    EXPECT_NE(notes.find(std::string(file) + " lies beside the log and is not used"),
              std::string::npos)
        << notes;
  }
  EXPECT_EQ(notes.find("tiny.relations lies"), std::string::npos) << notes;
  const auto path = (data.folder / "data/sub/tiny.clf").string();
  const auto by_path = load_dataset(path, data.dirs, catalog);
  ASSERT_TRUE(by_path.has_value()) << by_path.error().to_line();
  EXPECT_TRUE(by_path->log.truth.has_value());
  EXPECT_EQ(by_path->log.robot.wheels.track_m, 0.77);
}

TEST(LoadDataset, AListedRobotModelOverridesTheCataloguesCalibration) {
  const TinyData data;
  const std::string model = "[wheels]\ntrack_m = 0.77\n";
  data.folder.write("data/sub/tiny.robot.toml", model);
  Catalog catalog = data.catalog();
  // sha256sum of the model above.
  catalog.entries[0].files.push_back(
      {"sub/tiny.robot.toml", "ee34ff33cddfe4a4bc625414f308b931b1374c1202769328f0c0d8ec94d92739",
       false, ""});
  const auto loaded = load_dataset("tiny", data.dirs, catalog);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().to_line();
  EXPECT_EQ(loaded->log.robot.wheels.track_m, 0.77);
}

// The tiny entry with other words for format and truth, and other files.
std::string refusal(const std::string& format, const std::string& truth,
                    const std::vector<std::string>& files) {
  std::string text = "[[dataset]]\nname = \"a\"\ntitle = \"t\"\nformat = \"" + format +
                     "\"\ntruth = \"" + truth +
                     "\"\norder = \"stamp\"\nlicence = \"l\"\nsource = \"s\"\n"
                     "not_fetchable = \"made here\"\nfiles = [\n";
  for (const std::string& file : files) {
    text += "  { path = \"" + file + "\", sha256 = \"" + kScansSha256 + "\" },\n";
  }
  const ScratchFolder folder;
  const auto catalog = read_catalog(folder.write("catalog.toml", text + "]\n"));
  return catalog ? "accepted" : catalog.error().to_line();
}

TEST(Catalog, RefusesATruthThatItsFilesDoNotHold) {
  EXPECT_EQ(refusal("carmen", "none", {"d/a.clf"}), "accepted");
  EXPECT_EQ(refusal("carmen", "tum", {"d/a.clf", "d/a.tum", "d/a.truth.toml"}), "accepted");
  EXPECT_EQ(refusal("lcm", "reference", {"a.lcm.log.gz"}), "accepted");
  const auto says = [](const std::string& line, const std::string& what) {
    EXPECT_NE(line.find("catalog.toml: line 5: truth: " + what), std::string::npos) << line;
  };
  says(refusal("carmen", "tum", {"d/a.clf"}), "tum; expected d/a.tum among the files");
  says(refusal("carmen", "tum", {"a.clf", "a.tum", "a.relations"}),
       "tum, but a.relations is listed; expected relations");
  says(refusal("carmen", "none", {"a.clf", "a.tum"}), "none, but a.tum is listed; expected tum");
  says(refusal("carmen", "relations", {"a.clf", "a.tum"}), "relations, but a.tum is listed");
  says(refusal("carmen", "reference", {"a.clf"}), "only lcm logs hold a reference");
  says(refusal("g2o", "tum", {"a.g2o"}), "expected none of a pose graph");
}

TEST(Catalog, RefusesAFormatThatIsUnknownOrNotThatOfTheFile) {
  const auto says = [](const std::string& line, const std::string& what) {
    EXPECT_NE(line.find("catalog.toml: line 4: format: " + what), std::string::npos) << line;
  };
  says(refusal("clf", "none", {"a.clf"}), "\"clf\"; expected carmen, rawlog, lcm, ticks or rosbag");
  says(refusal("rawlog", "none", {"a.clf.gz"}), "a.clf.gz is carmen by its name, not rawlog");
  says(refusal("carmen", "none", {"a.txt"}), "a.txt is no log by its name, not carmen");
  says(refusal("toro", "none", {"a.g2o"}), "a.g2o is no toro by its name");
  for (const char* name : {"a.log", "a.log.gz"}) {
    EXPECT_EQ(refusal("carmen", "none", {name}), "accepted");
    EXPECT_EQ(refusal("lcm", "none", {name}), "accepted") << "its bytes tell";
  }
  EXPECT_EQ(refusal("toro", "none", {"a.graph"}), "accepted");
}

TEST(LoadDataset, TheBytesOfALogMustBeOfItsFormat) {
  const TinyData data;
  data.folder.write("data/a.log", kScans);
  Catalog catalog = data.catalog();
  catalog.entries[0].files = {{"a.log", kScansSha256, false, ""}};
  catalog.entries[0].truth = TruthKind::kNone;
  EXPECT_TRUE(load_dataset("tiny", data.dirs, catalog).has_value());
  catalog.entries[0].format = "lcm";
  const auto loaded = load_dataset("tiny", data.dirs, catalog);
  ASSERT_FALSE(loaded.has_value());
  EXPECT_NE(loaded.error().to_line().find("the log is a carmen log"), std::string::npos);
}

TEST(Catalog, RefusesFilesThatAreNotReadWithTheLog) {
  for (const char* other : {"d/a.txt", "a.robot.toml", "d/b.robot.toml", "d/a.clf"}) {
    const std::string line = refusal("carmen", "none", {"d/a.clf", other});
    EXPECT_NE(line.find("line 10: files: expected the log and, beside it, once each: d/a with one"),
              std::string::npos)
        << line;
  }
}

TEST(Catalog, CitesTheLineOfTheKey) {
  const ScratchFolder folder;
  std::string text = entry_text(
      "calibration.wheels.track_m = 0.3\ncalibration.wheels.trak_m = 1\n"
      "calibration.imu.rate_hz = -1\n\n[[dataset]]\nname = \"b\"\n");
  text.replace(text.find(kScansSha256), 4, "wxyz");
  const auto path = folder.write("catalog.toml", text);
  const auto catalog = read_catalog(path);
  ASSERT_FALSE(catalog.has_value());
  const std::string line = catalog.error().to_line();
  for (const char* part :
       {"line 6: files: sha256 of sub/tiny.clf",
        "line 15: unknown key calibration.wheels.trak_m; expected one of track_m left_m_per_tick",
        "line 16: calibration.imu.rate_hz = -1", "line 18: title: missing"}) {
    EXPECT_NE(line.find(part), std::string::npos) << part << " in " << line;
  }
  EXPECT_EQ(line.find(path.string()), line.rfind(path.string())) << "once is enough: " << line;
}

TEST(Catalog, SaysOfACalibrationWhatLogRobotTomlIsTold) {
  const ScratchFolder folder;
  const auto path =
      folder.write("catalog.toml", entry_text("[dataset.calibration.wheels]\n"          // 14
                                              "track_m = \"0.33\"\n"                    // 15
                                              "[dataset.calibration.lidar]\n"           // 16
                                              "range_max_m = inf\n"                     // 17
                                              "[dataset.calibration.laser]\n"           // 18
                                              "x_m = 1\n"                               // 19
                                              "[dataset.calibration.imu]\n"             // 20
                                              "x_m = 1\n"                               // 21
                                              "rate = \"; ; line 1: rate: as text\"\n"  // 22
                                              ));
  const auto catalog = read_catalog(path);
  ASSERT_FALSE(catalog.has_value());
  EXPECT_EQ(catalog.error().to_line(),
            path.string() +
                ": line 15: calibration.wheels.track_m is a text; expected number; "
                "line 17: calibration.lidar.range_max_m is not finite; expected a number; "
                "line 22: unknown key calibration.imu.rate; expected one of x_m y_m yaw_deg "
                "rate_hz gyro_noise_radps accel_noise_mps2 gyro_bias_walk_radps_sqrt_s "
                "accel_bias_walk_mps2_sqrt_s; "
                "line 18: unknown key calibration.laser; expected one of robot wheels lidar imu "
                "raw");
}

TEST(Catalog, ACalibrationOfEmptyTablesStatesNothing) {
  const ScratchFolder folder;
  for (const char* text : {"calibration = {}\n", "calibration = { wheels = {}, lidar = {} }\n"}) {
    const auto path = folder.write("catalog.toml", entry_text(text));
    const auto catalog = read_catalog(path);
    ASSERT_FALSE(catalog.has_value()) << text;
    EXPECT_EQ(catalog.error().to_line(),
              path.string() + ": line 14: calibration: not a table, or one that states nothing");
  }
}

TEST(Catalog, KnowsWhichValuesOfACalibrationAreStated) {
  const TinyData data;
  EXPECT_EQ(data.catalog().entries.front().robot_keys, formats::RobotKeys{"wheels.track_m"});
}

// A folder of somebody's own: the tiny log, and a catalogue that knows it.
struct OwnData {
  explicit OwnData(const std::string& name) {
    folder.write("sub/tiny.clf", kScans);
    folder.write("sub/tiny.relations", test::kRelations);
    folder.write("catalog.toml", entry_text("", name));
  }
  ScratchFolder folder;
};

TEST(OwnCatalog, OfADataFolderAddsToTheMainOneAndLooksInItsFolderOnly) {
  const OwnData own("mine");
  const ScratchFolder other;
  other.write("sub/tiny.clf", "another log");
  const DataDirs dirs{{other.path(), own.folder.path(), own.folder / "."}};
  const auto known = known_datasets(dirs);
  ASSERT_TRUE(known.has_value()) << known.error().to_line();
  EXPECT_NE(known->find("malaga"), nullptr);
  EXPECT_FALSE(known->find("malaga")->folder.has_value());
  const auto loaded = load_dataset("mine", dirs);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().to_line();
  EXPECT_EQ(loaded->log.provenance.source, (own.folder / "sub/tiny.clf").string());
  const auto rows = list_datasets(*known, dirs);
  EXPECT_TRUE(rows.back().is_own && rows.back().is_found);
  EXPECT_EQ(rows.back().catalog_file, own.folder / "catalog.toml");
  EXPECT_FALSE(rows.front().is_own);
  EXPECT_EQ(verify_dataset(*known, "mine", dirs)->front().status, FileStatus::kMatches);
}

TEST(OwnCatalog, MayNotUseANameThatIsKnownAndNamesBothPlaces) {
  const OwnData own("malaga");
  const auto known = known_datasets({{own.folder.path()}});
  ASSERT_FALSE(known.has_value());
  const std::string line = known.error().to_line();
  EXPECT_NE(line.find((own.folder / "catalog.toml").string() + ":1: data set malaga is in "),
            std::string::npos)
      << line;
  EXPECT_NE(line.find("datasets/catalog.toml:"), std::string::npos) << line;
  const OwnData one("mine");
  const OwnData two("mine");
  EXPECT_FALSE(known_datasets({{one.folder.path(), two.folder.path()}}).has_value());
}

TEST(OwnCatalog, ThatIsBrokenIsOneLineThatNamesIt) {
  const ScratchFolder folder;
  for (const char* text : {"[[dataset]\n", "[[dataset]]\nname = 1\n", "x = 1\n", ""}) {
    const auto path = folder.write("catalog.toml", text);
    const auto known = known_datasets({{folder.path()}});
    ASSERT_FALSE(known.has_value()) << text;
    EXPECT_EQ(known.error().to_line().find(path.string()), 0U) << known.error().to_line();
  }
}

}  // namespace
}  // namespace corridor::catalog
