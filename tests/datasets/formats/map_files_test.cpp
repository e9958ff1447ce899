#include <gtest/gtest.h>
#include <png.h>

#include "datasets/formats/maps/map_png.hpp"
#include "datasets/formats/maps/ros_map.hpp"
#include "tests/datasets/formats/formats_support.hpp"

namespace corridor::formats {
namespace {

using test::read_text;
using test::ScratchFolder;
using test::write_text;

// 3 columns x 2 rows: the lower left cell occupied, the upper right one free, the rest unknown.
GridMap small_map() {
  GridMap map(0.05, {-1.25, 0.5}, 3, 2);
  map.at(0, 0) = {4.0F, 7, true};
  map.at(2, 1) = {-4.0F, 0, true};
  map.at(1, 1) = {0.1F, 1, true};  // seen, but undecided
  return map;
}

TEST(RosMap, ImageRunsFromTheTopAndTheOriginIsLowerLeft) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_ros_map(small_map(), folder / "map"));
  const std::string pgm = read_text(folder / "map.pgm");
  const std::string expected =
      std::string("P5\n3 2\n255\n") + "\xCD\xCD\xFE" + std::string(1, '\0') + "\xCD\xCD";
  EXPECT_EQ(pgm, expected);
  const std::string yaml = read_text(folder / "map.yaml");
  EXPECT_NE(yaml.find("image: map.pgm\n"), std::string::npos);
  EXPECT_NE(yaml.find("resolution: 0.05\n"), std::string::npos);
  EXPECT_NE(yaml.find("origin: [-1.25, 0.5, 0.0]\n"), std::string::npos);
}

TEST(RosMap, ReadUndoesWriteUpToClasses) {
  const ScratchFolder folder;
  const GridMap map = small_map();
  ASSERT_TRUE(write_ros_map(map, folder / "map"));
  const auto read = read_ros_map(folder / "map.yaml");
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  EXPECT_EQ(read->resolution_m(), map.resolution_m());
  EXPECT_EQ(read->origin_m(), map.origin_m());
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 3; ++column) {
      EXPECT_EQ(classify(read->at(column, row)), classify(map.at(column, row)));
    }
  }
  EXPECT_EQ(read->at(0, 0).hits, 1);  // the count of 7 is lost
}

TEST(RosMap, AnEmptyMapIsAnErrorAndLeavesNothing) {
  const ScratchFolder folder;
  EXPECT_FALSE(write_ros_map(GridMap(), folder / "map").has_value());
  EXPECT_FALSE(write_map_png(GridMap(), folder / "map.png").has_value());
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(RosMap, BadDescriptionsAndImagesAreErrors) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_ros_map(small_map(), folder / "map"));
  const std::string good = read_text(folder / "map.yaml");
  const std::vector<std::string> bad_yaml = {
      "",
      "image: [",
      "image: map.pgm\n",
      "image: none.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n",
      "image: map.pgm\nresolution: -1\norigin: [0, 0, 0]\n",
      "image: map.pgm\nresolution: nan\norigin: [0, 0, 0]\n",
      "image: map.pgm\nresolution: 0.05\norigin: [0, 0]\n",
      "image: map.pgm\nresolution: 0.05\norigin: [0, 0, 0.3]\n"};
  for (const std::string& yaml : bad_yaml) {
    write_text(folder / "map.yaml", yaml);
    EXPECT_FALSE(read_ros_map(folder / "map.yaml").has_value()) << yaml;
  }
  write_text(folder / "map.yaml", good);
  const std::vector<std::string> bad_pgm = {"",
                                            "P2\n3 2\n255\n",
                                            "P5\n3 2\n255\n12345",
                                            "P5\n3 2\n255\n1234567",
                                            "P5\n3 -2\n255\n",
                                            "P5\n4000000000 4000000000\n255\nx",
                                            "P5\n3 2\n65535\n123456123456"};
  for (const std::string& pgm : bad_pgm) {
    write_text(folder / "map.pgm", pgm);
    EXPECT_FALSE(read_ros_map(folder / "map.yaml").has_value()) << pgm;
  }
}

TEST(RosMap, NamesTheLineOfAValueThatIsNone) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_ros_map(small_map(), folder / "map"));
  const std::vector<std::pair<std::string, std::string>> defects = {
      {"negate: true", "map.yaml:4: negate: not a number from 0 to 1"},
      {"negate: 0.5", "map.yaml:4: negate: neither 0 nor 1"},
      {"negate:", "negate: not a number"},
      {"occupied_thresh: zzz", "map.yaml:4: occupied_thresh: not a number from 0 to 1"},
      {"occupied_thresh: 65", "map.yaml:4: occupied_thresh: not a number from 0 to 1"},
      {"free_thresh: 0,196", "map.yaml:4: free_thresh: not a number from 0 to 1"},
      {"free_thresh: 0.9", "map.yaml:4: free_thresh: above occupied_thresh"},
      {"mode: scale", "map.yaml:4: mode: only trinary"},
      {"mode: [trinary]", "map.yaml:4: mode: only trinary"},
  };
  for (const auto& [line, message] : defects) {
    write_text(folder / "map.yaml",
               "image: map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n" + line + "\n");
    const auto read = read_ros_map(folder / "map.yaml");
    ASSERT_FALSE(read.has_value()) << line;
    EXPECT_NE(read.error().to_line().find(message), std::string::npos) << read.error().to_line();
  }
}

TEST(RosMap, ReadsCommentsInTheImageAndNegatedMaps) {
  const ScratchFolder folder;
  write_text(folder / "map.pgm",
             "P5 # made by hand\n2 1\n# two pixels\n255\n" + std::string(1, '\0') + "\xFE");
  write_text(folder / "map.yaml",
             "image: map.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 1\n"
             "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
  const auto map = read_ros_map(folder / "map.yaml");
  ASSERT_TRUE(map.has_value()) << map.error().to_line();
  EXPECT_EQ(classify(map->at(0, 0)), CellClass::kFree);
  EXPECT_EQ(classify(map->at(1, 0)), CellClass::kOccupied);
}

TEST(MapPng, HasOnePixelACellWithTheTopRowFirst) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_map_png(small_map(), folder / "map.png"));
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_file(&image, (folder / "map.png").c_str()), 0);
  ASSERT_EQ(image.width, 3U);
  ASSERT_EQ(image.height, 2U);
  image.format = PNG_FORMAT_GRAY;
  std::vector<png_byte> pixels(PNG_IMAGE_SIZE(image));
  ASSERT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0);
  // log-odds 4, -4, 0.1 are probabilities 0.982, 0.018, 0.525.
  EXPECT_EQ(pixels, (std::vector<png_byte>{205, 121, 250, 5, 205, 205}));
}

}  // namespace
}  // namespace corridor::formats
